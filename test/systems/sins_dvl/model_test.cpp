// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/sins_dvl/model.hpp"

#include <optional>

#include "sas_motion/navigation/attitude.hpp"
#include "sas_motion/navigation/earth.hpp"
#include "sas_motion/systems/ins_gps_dvl/model.hpp"
#include "sas_motion/systems/ins_gps_dvl/simulator.hpp"
#include "support.hpp"

namespace sas_motion::sins {
namespace {

/// (B.9)
ins::Track towedTrack() {
  ins::Track track;
  track.start = {60, 120, 0};
  track.speed = 3;
  track.heading = kPi / 4;
  track.line_length = 1e5;
  track.pitch = {6 * kRadPerDeg, 12, kPi / 4};
  track.roll = {4 * kRadPerDeg, 6, kPi / 4};
  track.yaw = {3 * kRadPerDeg, 10, kPi / 4};
  track.heave.amplitude = track.sway.amplitude = 0;
  track.along_bow = true;
  return track;
}

/// An INS that starts wrong and reads a unit that errs, and the error that the model makes of the start's.
struct WrongStart {
  explicit WrongStart(double duration, const Vector<3>& phi)
      : trajectory(towedTrack(), duration), errors(Vector<kStates>::Zero()) {
    const NavigationState truth = trajectory.at(0).state;
    NavigationState wrong = truth;
    displace(wrong, {10, -20, 3});
    wrong.velocity_nav += Vector<3>(0.05, -0.04, 0.02);
    wrong.q_nav_body = quaternionOf(-phi) * truth.q_nav_body;
    errors(kPosition) = wrong.latitude - truth.latitude;
    errors(kPosition + 1) = wrong.longitude - truth.longitude;
    errors(kPosition + 2) = wrong.height - truth.height;
    errors.segment<3>(kVelocity) = wrong.velocity_nav - truth.velocity_nav;
    errors.segment<4>(kQuaternion) = coefficients(wrong.q_nav_body) - coefficients(truth.q_nav_body);
    errors.segment<3>(kGyro) << 0.1 * kDegPerHour, -0.2 * kDegPerHour, 0.1 * kDegPerHour;
    errors.segment<3>(kAccelerometer) << 500 * kMicroG, -500 * kMicroG, 300 * kMicroG;
    ins.emplace(wrong, 0, Mechanisation::Options{});
    last = wrong;
    for (auto reading : ins::perfectImu(trajectory, 100, duration)) {
      reading.rate_body += errors.segment<3>(kGyro);
      reading.force_body += errors.segment<3>(kAccelerometer);
      if (reading.stamp > 0) follow(reading);
    }
  }

  void follow(const ImuReading& reading) {
    preintegrated.add(reading.rate_body, reading.force_body, 0.01);
    ins->step(reading);
    if (preintegrated.duration() < 1 - 1e-6) return;
    errors = Motion<kStates>({}, last, preintegrated)(errors);
    last = ins->state();
    preintegrated = {};
  }

  ins::Trajectory trajectory;
  Vector<kStates> errors;
  std::optional<Mechanisation> ins;
  Preintegration preintegrated;
  NavigationState last;
};

TEST(SinsDvlTrack, IsThePapers) {
  const ins::Trajectory trajectory(towedTrack(), 60);
  for (const double time : {0.0, 3.3, 27.0, 59.9}) {
    const auto truth = trajectory.at(time).state;
    const Attitude lies = attitudeOf(truth.q_nav_body.toRotationMatrix());
    EXPECT_NEAR(lies.pitch, 6 * kRadPerDeg * std::sin(2 * kPi / 12 * time + kPi / 4), 1e-12);
    EXPECT_NEAR(lies.heading, kPi / 4 + 3 * kRadPerDeg * std::sin(2 * kPi / 10 * time + kPi / 4), 1e-12);
    const Vector<3> expected = 3 * Vector<3>(std::cos(lies.pitch) * std::sin(lies.heading),
                                             std::cos(lies.pitch) * std::cos(lies.heading), std::sin(lies.pitch));
    EXPECT_LT((truth.velocity_nav - expected).norm(), 1e-3) << "flat against curved Earth";
    const Vector<3> body = truth.q_nav_body.conjugate() * truth.velocity_nav;
    EXPECT_LT(body.cross(Vector<3>(0, 1, 0)).norm(), 1e-3) << "along the bow";
    const double h = 1e-4;
    const Vector<3> way = displacement(trajectory.at(time).state, trajectory.at(time + h).state) / h,
                    second = (trajectory.at(time + h).state.velocity_nav - truth.velocity_nav) / h;
    EXPECT_LT((way - truth.velocity_nav - 0.5 * h * trajectory.at(time).acceleration_nav).norm(), 1e-4);
    EXPECT_LT((second - trajectory.at(time).acceleration_nav).norm(), 1e-3);
  }
}

TEST(SinsDvlModel, PropagatesLargeErrorsForFiveMinutesAsTheInsItself) {
  for (const double heading_deg : {5.0, 30.0}) {
    // GIVEN a heading error of 5 or 30 degrees, a tilt of half a degree, drifts and biases
    const WrongStart run(300, Vector<3>(0.5, -0.5, heading_deg) * kRadPerDeg);
    // THEN after five minutes the errors are those of the INS against the truth
    const NavigationState truth = run.trajectory.at(300).state, &ins = run.ins->state(),
                          corrected = View<kStates>(ins).corrected(run.errors);
    const Vector<3> expected = displacement(truth, ins);
    EXPECT_GT(expected.norm(), 2500);
    std::cout << heading_deg << " deg: the INS is " << expected.norm() << " m off; the model is off by "
              << displacement(truth, corrected).norm() << " m, " << (corrected.velocity_nav - truth.velocity_nav).norm()
              << " m/s, " << attitudeError(corrected.q_nav_body, truth.q_nav_body).norm() << " rad\n";
    EXPECT_LT(displacement(truth, corrected).norm(), 0.4);
    EXPECT_LT((corrected.velocity_nav - truth.velocity_nav).norm(), 0.01);
    EXPECT_LT(
        (coefficients(ins.q_nav_body) - run.errors.segment<4>(kQuaternion) - coefficients(truth.q_nav_body)).norm(),
        1e-5);
  }
}

Matrix<4> leftProduct(const Vector<4>& q) {
  Matrix<4> L;
  L << q(0), -q.tail<3>().transpose(), q.tail<3>(), q(0) * Matrix<3>::Identity() + skew(q.tail<3>());
  return L;
}
Matrix<4> rightProduct(const Vector<4>& q) {
  Matrix<4> R;
  R << q(0), -q.tail<3>().transpose(), q.tail<3>(), q(0) * Matrix<3>::Identity() - skew(q.tail<3>());
  return R;
}
Vector<4> pure(const Vector<3>& w) { return {0, w.x(), w.y(), w.z()}; }

TEST(SinsDvlModel, HasThePapersDifferentialEquations) {
  // GIVEN an instant with errors of every kind, as of (B.1) and (B.2), exactly
  const ins::Trajectory trajectory(towedTrack(), 10);
  const auto sample = trajectory.at(4.2);
  Vector<kStates> x = Vector<kStates>::Zero();
  x.head<6>() << 1e-5, -2e-5, 4, 0.3, -0.2, 0.1;
  x.segment<3>(kGyro) << 1e-6, -2e-6, 3e-6;
  x.segment<3>(kAccelerometer) << 5e-3, -4e-3, 3e-3;
  NavigationState ins = sample.state;
  ins.q_nav_body = quaternionOf(Vector<3>(0.05, -0.03, 0.4)) * ins.q_nav_body;
  x.segment<4>(kQuaternion) = coefficients(ins.q_nav_body) - coefficients(sample.state.q_nav_body);
  ins.latitude += x(0), ins.longitude += x(1), ins.height += x(2), ins.velocity_nav += x.segment<3>(kVelocity);
  const Vector<3> eps = x.segment<3>(kGyro), nabla = x.segment<3>(kAccelerometer);
  const Vector<3> rate = sample.rateBody() + eps, force = sample.forceBody() + nabla;
  const auto turnOf = [](const NavigationState& s) -> Vector<3> {
    return earth::rotationRate(s.latitude) + earth::transportRate(s.latitude, s.height, s.velocity_nav);
  };
  const auto pull = [&](const NavigationState& s) -> Vector<3> {
    return Vector<3>(0, 0, -earth::gravity(s.latitude, s.height)) -
           (earth::rotationRate(s.latitude) + turnOf(s)).cross(s.velocity_nav);
  };
  const auto& truth = sample.state;
  const Vector<4> dq = x.segment<4>(kQuaternion);
  const Vector<4> dq_rate = 0.5 * (rightProduct(pure(rate)) - leftProduct(pure(turnOf(ins)))) * dq +
                            0.5 * rightTurn(truth.q_nav_body) * eps -
                            0.5 * leftTurn(truth.q_nav_body) * (turnOf(ins) - turnOf(truth));  // (B.1)
  const Vector<3> dv_rate =
      ins.q_nav_body * force - truth.q_nav_body * Vector<3>(force - nabla) + pull(ins) - pull(truth);  // (B.2)
  // WHEN the model moves them over a short time
  const double T = 1e-3;
  Preintegration preintegrated;
  preintegrated.add(rate, force, T);
  const Vector<kStates> change = (Motion<kStates>({}, ins, preintegrated)(x) - x) / T;
  // THEN they change at these rates, up to the second derivative
  EXPECT_LT((change.segment<4>(kQuaternion) - dq_rate).norm(), 1e-4 * std::max(1.0, dq_rate.norm()));
  EXPECT_LT((change.segment<3>(kVelocity) - dv_rate).norm(), 2e-3 * dv_rate.norm());
  const auto [M, N] = earth::radii(truth.latitude, truth.height);
  const auto [M_ins, N_ins] = earth::radii(ins.latitude, ins.height);
  const Vector<3> dp_rate(
      ins.velocity_nav.y() / M_ins - truth.velocity_nav.y() / M,
      ins.velocity_nav.x() / (N_ins * std::cos(ins.latitude)) - truth.velocity_nav.x() / (N * std::cos(truth.latitude)),
      x(kVelocity + 2));  // (B.3)
  EXPECT_LT((change.head<2>() - dp_rate.head<2>()).norm() * M, 0.005);
  EXPECT_NEAR(change(2), dp_rate(2), 0.002);
  EXPECT_NEAR(change(kDvlOffset), 0, 1e-9);
}

TEST(SinsDvlModel, SmallErrorsFollowTheLinearModelOfIns) {
  // GIVEN small attitude errors phi, THEN the quaternion form and C' = (I - [phi x]) C move alike: the latter is
  // checked against the mechanisation
  const Vector<3> phi(2e-4, -3e-4, 5e-4);
  const WrongStart run(60, phi);
  const NavigationState truth = run.trajectory.at(60).state,
                        corrected = View<kStates>(run.ins->state()).corrected(run.errors);
  const Vector<3> expected = attitudeError(run.ins->state().q_nav_body, truth.q_nav_body);
  const Matrix<9, kStates> T = View<kStates>(run.ins->state()).solutionByError(run.errors);
  EXPECT_LT((T * run.errors).tail<3>().norm() / expected.norm(), 1.001);
  EXPECT_LT(((T * run.errors).tail<3>() - expected).norm(), 1e-3 * expected.norm());
  const Vector<3> metres = displacement(truth, run.ins->state());
  EXPECT_LT(((T * run.errors).segment<3>(3) - metres).norm(), 1e-4 * metres.norm());
  EXPECT_LT(displacement(truth, corrected).norm(), 1e-3);
}

TEST(SinsDvlModel, ReadsTheDvlByScaleDriftAngleAndOffset) {
  const ins::Trajectory trajectory(towedTrack(), 10);
  const NavigationState ins = trajectory.at(3).state;
  const View<kStates> view(ins);
  Vector<kStates> x = Vector<kStates>::Zero();
  const Vector<3> forward = view.dvl(x, Vector<3>::Zero());
  EXPECT_NEAR(forward.y(), 3, 1e-3);
  x(kDvlScale) = 0.01, x(kDvlOffset) = 0.02, x(kDvlAngle) = 0.1;
  const Vector<3> read = view.dvl(x, Vector<3>::Zero());
  EXPECT_NEAR(read.x(), 1.01 * forward.y() * std::sin(0.1), 1e-3);
  EXPECT_NEAR(read.y(), 1.01 * forward.y() * std::cos(0.1) + 0.02, 1e-3);
  EXPECT_NEAR(view.dvl(Vector<kStates>::Zero(), {0.1, 0.2, 0.3}).z(), forward.z() + 0.3, 1e-12);
  // the length of the quaternion means nothing
  Vector<kStates> longer = Vector<kStates>::Zero();
  longer.segment<4>(kQuaternion) = -0.2 * coefficients(ins.q_nav_body);
  EXPECT_LT((view.dvl(longer, Vector<3>::Zero()) - forward).norm(), 1e-12);
  EXPECT_LT(view.constrained(longer).segment<4>(kQuaternion).norm(), 1e-12);
}

TEST(SinsDvlModel, StartsAndDrivesErrorsWithFullRank) {
  const ins::Trajectory trajectory(towedTrack(), 10);
  const NavigationState ins = trajectory.at(0).state;
  const Parameters parameters;
  const auto start = startBelief<kStates>(parameters, ins);
  ASSERT_TRUE(choleskyLower<kStates>(start.covariance));
  const Matrix<9, kStates> T = View<kStates>(ins).solutionByError(start.mean);
  const Vector<9> sigma = (T * start.covariance * T.transpose()).diagonal().cwiseSqrt();
  Vector<9> expected;
  expected << 0.05, 0.05, 0.05, 0.06, 0.06, 1, Vector<3>(0.05, 0.05, 0.3) * kRadPerDeg;
  EXPECT_LT((sigma - expected).cwiseQuotient(expected).cwiseAbs().maxCoeff(), 1e-4);
  Preintegration preintegrated;
  preintegrated.add(Vector<3>::Zero(), Vector<3>(0, 0, 9.8), 1);
  EXPECT_GT((Motion<kStates>(parameters, ins, preintegrated).noiseRoot().diagonal().minCoeff()), 0);
  EXPECT_GT((Motion<kPaperStates>(parameters, ins, preintegrated).noiseRoot().diagonal().minCoeff()), 0);
}

TEST(InSmallAngles, ReadTheSameDvl) {
  // GIVEN an offset forward, a drift angle and a body that moves in all directions
  NavigationState state;
  state.latitude = 1;
  state.velocity_nav << 2, 2.5, 0.3;
  state.q_nav_body = quaternionOf({0.05, -0.1, 0.7});
  Vector<kPaperStates> x = Vector<kPaperStates>::Zero();
  x(kDvlOffset) = -0.02;
  x(kDvlAngle) = 0.005;
  const Vector<3> reading = View<kPaperStates>(state).dvl(x, Vector<3>::Zero());
  // WHEN the fusion by small angles knows them, THEN nothing is left but the square of the angle
  const ins::ErrorModel model(inSmallAngles(Parameters()), state);
  ins::Errors mean = ins::Errors::Zero();
  mean.segment<3>(ins::kDvlVelocity) << x(kDvlAngle), x(kDvlOffset), 0;
  EXPECT_GT(model.dvl(state, Vector<3>::Zero(), reading, ins::Errors::Zero()).innovation.norm(), 0.02);
  EXPECT_LT(model.dvl(state, Vector<3>::Zero(), reading, mean).innovation.norm(),
            0.5 * 0.005 * 0.005 * state.velocity_nav.norm() * 1.01);
}

TEST(SinsDvlModel, TheNoiseOfATurnIsThatOfQuaternionsThatAreTurned) {
  Random random = testing::announced(11);
  NavigationState ins;
  ins.q_nav_body = Eigen::Quaterniond(0.3, -0.5, 0.2, 0.7).normalized();
  const Vector<3> sigma(0.01, 0.02, 0.03);
  constexpr int kDraws = 20000;
  Matrix<4> drawn = Matrix<4>::Zero();
  for (int i = 0; i < kDraws; ++i) {
    const Vector<3> turn = sigma.cwiseProduct(testing::randomMatrix<3>(random));
    const Vector<4> change = coefficients(quaternionOf(turn) * ins.q_nav_body) - coefficients(ins.q_nav_body);
    drawn += change * change.transpose() / kDraws;
  }
  const Matrix<kStates> root = turnRoot<kStates>(ins, sigma.cwiseAbs2()), Q = root * root.transpose();
  EXPECT_LT(testing::relativeDifference(Matrix<4>(Q.block<4, 4>(kQuaternion, kQuaternion)), drawn), 0.03);
  EXPECT_DOUBLE_EQ(Q.trace(), (Q.block<4, 4>(kQuaternion, kQuaternion).trace())) << "nothing else is noisy";
}

}  // namespace
}  // namespace sas_motion::sins

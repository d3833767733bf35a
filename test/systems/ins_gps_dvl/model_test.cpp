// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/ins_gps_dvl/model.hpp"

#include <gtest/gtest.h>

#include "sas_motion/navigation/attitude.hpp"
#include "sas_motion/navigation/earth.hpp"
#include "support.hpp"

namespace sas_motion::ins {
namespace {

constexpr double kStep = 0.1;  // [s]

NavigationState someState() {
  NavigationState state;
  state.latitude = 54 * kRadPerDeg;
  state.longitude = 10 * kRadPerDeg;
  state.height = -30;
  state.velocity_nav << 12, -7, 0.5;
  state.q_nav_body = Eigen::Quaterniond(rotationOf({0.1, -0.2, 0.7}));
  return state;
}

const ImuReading kReading{stampFromSeconds(kStep), {0.02, -0.01, 0.05}, {0.4, -0.3, 9.9}};

/// What the mechanisation makes of a state in one step with a reading.
NavigationState mechanised(const NavigationState& state, const Vector<3>& drift = Vector<3>::Zero(),
                           const Vector<3>& bias = Vector<3>::Zero()) {
  Mechanisation ins(state, 0, {kStep, 1, 20, 200});
  ins.advance({kReading.stamp, kReading.rate_body + drift, kReading.force_body + bias}, kReading.stamp);
  return ins.state();
}

/// The error of a state in SI units, (C.1).
Vector<9> errorOf(const NavigationState& state, const NavigationState& truth) {
  Vector<9> e;
  e << state.velocity_nav - truth.velocity_nav, state.longitude - truth.longitude, state.latitude - truth.latitude,
      state.height - truth.height, attitudeError(state.q_nav_body, truth.q_nav_body);
  return e;
}

NavigationState withError(const NavigationState& truth, const Errors& e, const Errors& unit) {
  return corrected(truth, -e, unit);
}

ErrorModel::Motion motionOf(const NavigationState& from) {
  const NavigationState to = mechanised(from);
  const Vector<3> turn = kReading.rate_body * kStep / 2;
  const Matrix<3> C =
      (from.q_nav_body * Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized()))).toRotationMatrix();
  NavigationState middle = from;
  middle.velocity_nav = 0.5 * (from.velocity_nav + to.velocity_nav);
  return {middle, C * kReading.force_body, C};
}

/// Central differences of the mechanisation by each error, over a step, against Phi. Perturbations are of the size that
/// linear errors have.
TEST(InsErrorModel, TransitionIsTheDerivativeOfTheMechanisation) {
  const NavigationState state = someState();
  const ErrorModel model({}, state);
  const ErrorMatrix Phi = model.transition(motionOf(state), kStep, Errors::Zero()).F;
  const NavigationState truth = mechanised(state);
  for (int column = 0; column < 9; ++column) {
    // GIVEN an error of 1 m/s, 1 km or 1 mrad at the start of the step
    const double size = column >= kPosition && column < kAttitude ? 1e3 : 1;
    const Errors e = size * Errors::Unit(column);
    const Vector<9> forward = errorOf(mechanised(withError(state, e, model.unit())), truth),
                    backward = errorOf(mechanised(withError(state, -e, model.unit())), truth);
    const Vector<9> derivative = (forward - backward).cwiseQuotient(model.unit().head<9>()) / (2 * size);
    for (int row = 0; row < 9; ++row) {
      // What is left out of F: e^2-sized derivatives of the radii, which move the position, and terms of third order in
      // the step.
      const double slack = row >= kAttitude ? 1e-11 : row >= kPosition ? 2e-9 : 1e-9;
      const double F = Phi(row, column) - (row == column), found = derivative(row) - (row == column);
      EXPECT_NEAR(found, F, 0.01 * std::abs(F) + slack) << "row " << row << ", column " << column;
    }
  }
}

TEST(InsErrorModel, DriftsAndBiasesActOnBodyAxes) {
  const NavigationState state = someState();
  const ErrorModel model({}, state);
  const ErrorMatrix Phi = model.transition(motionOf(state), kStep, Errors::Zero()).F;
  const NavigationState truth = mechanised(state);
  for (int axis = 0; axis < 3; ++axis) {
    const Vector<3> e = 1e-3 * Vector<3>::Unit(axis);
    const Vector<9> by_drift = (errorOf(mechanised(state, e), truth) - errorOf(mechanised(state, -e), truth)) / 2e-3;
    const Vector<9> by_bias = (errorOf(mechanised(state, Vector<3>::Zero(), e), truth) -
                               errorOf(mechanised(state, Vector<3>::Zero(), -e), truth)) /
                              2e-3;
    const Vector<9> unit = model.unit().head<9>();
    const Vector<9> drift = Phi.col(kGyroConstant + axis).head<9>().cwiseProduct(unit) / model.unit()(kGyroConstant);
    const Vector<9> bias = Phi.col(kAccelerometer + axis).head<9>().cwiseProduct(unit) / model.unit()(kAccelerometer);
    EXPECT_LT((by_drift - drift).segment<3>(kAttitude).norm(), 1e-3 * drift.segment<3>(kAttitude).norm());
    EXPECT_LT((by_drift - drift).segment<3>(kVelocity).norm(), 0.02 * drift.segment<3>(kVelocity).norm())
        << "by tilt, second order in the step";
    EXPECT_LT((by_bias - bias).segment<3>(kVelocity).norm(), 1e-3 * bias.segment<3>(kVelocity).norm());
    EXPECT_EQ(
        Phi.col(kGyroMarkov + axis).segment<3>(kVelocity).dot(Phi.col(kGyroConstant + axis).segment<3>(kVelocity)) > 0,
        true);
  }
}

/// Readings without noise of a truth, taken by an INS that is wrong.
class InsMeasurements : public ::testing::Test {
 protected:
  InsMeasurements() {
    parameters_.gps_lever_body << 0.4, -1.2, 3.5;
    parameters_.dvl_lever_body << 0.3, 2, -0.5;
    parameters_.depth_lever_body << 0.1, 1, -0.2;
    parameters_.dpc_lever_body << 0.5, -1, -0.4;
  }

  template <class Measure>
  void expectJacobian(const Measure& measure, const Errors& size) const {
    const ErrorModel model(parameters_, truth_);
    EXPECT_NEAR(measure(model, truth_, Errors::Zero()).innovation.norm(), 0, 1e-8) << "no error, no innovation";
    const auto H = measure(model, truth_, Errors::Zero()).H;
    for (int column = 0; column < 9; ++column) {
      const Errors e = size(column) * Errors::Unit(column);
      const auto difference = (measure(model, withError(truth_, e, model.unit()), Errors::Zero()).innovation -
                               measure(model, withError(truth_, -e, model.unit()), Errors::Zero()).innovation)
                                  .eval();
      EXPECT_NEAR((difference / (2 * size(column)) - H.col(column)).norm(), 0, 1e-5) << "column " << column;
      // WHEN the errors are known THEN nothing is left to learn.
      EXPECT_NEAR(measure(model, withError(truth_, e, model.unit()), e).innovation.norm(), 0, 1e-4)
          << "column " << column;
    }
  }

  Parameters parameters_;
  NavigationState truth_ = someState();
  Errors size_ = Errors::Ones();
};

TEST_F(InsMeasurements, GpsSeesPositionAndTheLeversAttitude) {
  NavigationState antenna = truth_;
  displace(antenna, truth_.q_nav_body * parameters_.gps_lever_body);
  expectJacobian([&](const ErrorModel& model, const NavigationState& ins,
                     const Errors& mean) { return model.gps(ins, antenna, mean); },
                 size_);
}

TEST_F(InsMeasurements, DvlSeesVelocityAndAttitudeOnItsAxes) {
  const Vector<3> rate(0.02, -0.01, 0.05);
  const Vector<3> over_ground = rate - truth_.q_nav_body.conjugate() * earth::rotationRate(truth_.latitude);
  const Vector<3> reading =
      truth_.q_nav_body.conjugate() * truth_.velocity_nav + over_ground.cross(parameters_.dvl_lever_body);
  size_.head<3>().setConstant(0.01);
  expectJacobian([&](const ErrorModel& model, const NavigationState& ins,
                     const Errors& mean) { return model.dvl(ins, rate, reading, mean); },
                 size_);
}

TEST_F(InsMeasurements, DpcSeesVelocityAndAttitudeForwardAndAlongItsSight) {
  const Vector<3> rate(0.02, -0.01, 0.05);
  const Vector<3> over_ground = rate - truth_.q_nav_body.conjugate() * earth::rotationRate(truth_.latitude);
  const Vector<3> array_body =
      truth_.q_nav_body.conjugate() * truth_.velocity_nav + over_ground.cross(parameters_.dpc_lever_body);
  ArrayVelocity reading;
  reading.sight_body << 0.9, 0, -std::sqrt(1 - 0.81);
  reading.velocity << array_body.y(), array_body.dot(reading.sight_body);
  reading.variance << 4e-6, 1e-8;
  size_.head<3>().setConstant(0.01);
  expectJacobian([&](const ErrorModel& model, const NavigationState& ins,
                     const Errors& mean) { return model.dpc(ins, rate, reading, mean); },
                 size_);
  const auto z = ErrorModel(parameters_, truth_).dpc(truth_, rate, reading, Errors::Zero());
  EXPECT_TRUE(z.R.diagonal().isApprox(reading.variance));
  EXPECT_TRUE(z.H.rightCols<18>().isZero(0)) << "it has no errors of its own";
}

TEST_F(InsMeasurements, DepthSeesHeight) {
  const double height = truth_.height + (truth_.q_nav_body * parameters_.depth_lever_body).z();
  expectJacobian([&](const ErrorModel& model, const NavigationState& ins,
                     const Errors& mean) { return model.depth(ins, height, mean); },
                 size_);
}

TEST(InsErrorModel, IsWellScaled) {
  // (C.4): with metres and milliradians the covariance stays far from the limit of doubles
  const ErrorModel model({}, someState());
  auto belief = model.start();
  for (int i = 0; i < 100; ++i) {
    const auto step = model.transition(motionOf(someState()), kStep, belief.mean);
    belief.covariance = (step.F * belief.covariance * step.F.transpose() + step.Q).eval();
  }
  const Eigen::SelfAdjointEigenSolver<ErrorMatrix> eigen(belief.covariance, Eigen::EigenvaluesOnly);
  EXPECT_GT(eigen.eigenvalues().minCoeff(), 0);
  EXPECT_LT(eigen.eigenvalues().maxCoeff() / eigen.eigenvalues().minCoeff(), 1e9);
}

}  // namespace
}  // namespace sas_motion::ins

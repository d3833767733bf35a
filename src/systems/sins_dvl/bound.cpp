// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <limits>

#include "sas_motion/evaluation/bounds.hpp"
#include "sas_motion/evaluation/information.hpp"
#include "sas_motion/navigation/earth.hpp"
#include "systems/sins_dvl/campaign.hpp"

namespace sas_motion::sins {
namespace {

using Errors = Vector<kStates>;
using ErrorMatrix = Matrix<kStates>;

constexpr double kStep = 1;      // longest step of the recursion [s]
constexpr double kSmall = 1e-2;  // of a unit, for differences

/// Units that make the states alike in size: metres, mm/s, mrad, urad/s, mm/s, 0.1 %, mrad, mm/s^2.
Errors unitsAt(const NavigationState& state) {
  const auto [M, N] = earth::radii(state.latitude, state.height);
  Errors unit;
  unit << 1 / M, 1 / (N * std::cos(state.latitude)), 1, Errors::Constant(1e-3).head<7>(), Vector<3>::Constant(1e-6),
      Vector<6>::Constant(1e-3);
  return unit;
}

template <int M, class Function>
Matrix<M, kStates> derivative(const Function& f, const Errors& unit) {
  Matrix<M, kStates> J;
  for (int col = 0; col < kStates; ++col) {
    const Errors step = kSmall * unit(col) * Errors::Unit(col);
    J.col(col) = (f(step) - f(Errors(-step))) / (2 * kSmall);
  }
  return J;
}

/// Means of squared errors of velocity, position and attitude, see View::solutionByError().
class MeanSquares {
 public:
  void add(const Vector<9>& squares) {
    sum_ += squares;
    ++count_;
  }
  double rms(int first, int size) const { return std::sqrt(sum_.segment(first, size).sum() / count_); }

 private:
  Vector<9> sum_ = Vector<9>::Zero();
  int count_ = 0;
};

/// The recursion along the true trajectory, at the errors of an INS that is right. Heading and tilt enter by the start
/// alone, so that large ones have the same bound.
class SinsBound {
 public:
  explicit SinsBound(const Scenario& scenario)
      : scenario_(scenario),
        trajectory_(scenario.track, scenario.duration),
        imu_(ins::perfectImu(trajectory_, scenario.imu_rate, scenario.duration)),
        unit_(unitsAt(trajectory_.at(0).state)),
        dvl_(scenario.dvl.noise),
        depth_(scenario.depth.noise) {}

  void follow(const ins::Recording& recording, double skip, MeanSquares& scored, MeanSquares& end) const {
    const ErrorMatrix P = unit_.cwiseInverse().asDiagonal() *
                          startBelief<kStates>(scenario_.parameters, trajectory_.at(0).state).covariance *
                          unit_.cwiseInverse().asDiagonal();
    PosteriorBound<kStates> bound(P.llt().solve(ErrorMatrix::Identity()));
    std::size_t next = 1;
    double now = 0;
    for (const auto& labelled : recording.aiding) {
      const double time = secondsBetween(0, labelled.reading.stamp);
      while (now < time - 1e-9) now = move(bound, now, std::min(time, now + kStep), next);
      update(bound, labelled, time);
      if (labelled.reading.sensor == ins::Sensor::Dvl && time >= skip) scored.add(errorsOfSolution(bound, time));
    }
    while (now < scenario_.duration - 1e-9) now = move(bound, now, std::min(scenario_.duration, now + kStep), next);
    end.add(errorsOfSolution(bound, now));
  }

 private:
  Vector<9> errorsOfSolution(const PosteriorBound<kStates>& bound, double time) const {
    const Matrix<9, kStates> T =
        View<kStates>(trajectory_.at(time).state).solutionByError(Errors::Zero()) * unit_.asDiagonal();
    const auto covariance = bound.covariance();
    return covariance ? Vector<9>((T * *covariance * T.transpose()).diagonal())
                      : Vector<9>(Vector<9>::Constant(std::numeric_limits<double>::quiet_NaN()));
  }

  /// Readings of the IMU that end after `to` are left for the next step.
  double move(PosteriorBound<kStates>& bound, double from, double to, std::size_t& next) const {
    Preintegration preintegrated;
    for (; next < imu_.size() && secondsBetween(0, imu_[next].stamp) <= to + 1e-9; ++next)
      preintegrated.add(imu_[next].rate_body, imu_[next].force_body,
                        secondsBetween(imu_[next - 1].stamp, imu_[next].stamp));
    if (!(preintegrated.duration() > 0)) return to;
    const Motion<kStates> motion(scenario_.parameters, trajectory_.at(from).state, preintegrated);
    Transition<kStates> step;
    step.F = unit_.cwiseInverse().asDiagonal() * derivative<kStates>(motion, unit_);
    const ErrorMatrix root = unit_.cwiseInverse().asDiagonal() * motion.noiseRoot();
    step.Q = root * root.transpose();
    step.mean.setZero();
    bound.step({step});
    return to;
  }

  void update(PosteriorBound<kStates>& bound, const ins::LabelledAiding& labelled, double time) const {
    const ins::TruthSample truth = trajectory_.at(time);
    const View<kStates> view(truth.state);
    const Parameters& p = scenario_.parameters;
    if (labelled.reading.sensor == ins::Sensor::Dvl) {
      const Vector<3> turning_body = ins::rateOverGround(truth.state, truth.rateBody()).cross(p.dvl_lever_body);
      LinearMeasurement<kStates, 3> z;
      z.innovation.setZero();
      z.H = derivative<3>([&](const Errors& x) { return view.dvl(x, turning_body); }, unit_);
      z.R = p.dvl_white.cwiseAbs2().asDiagonal();
      Vector<3> factor;
      for (int row = 0; row < 3; ++row) factor(row) = dvl_.of(labelled.variance(row), time);
      bound.measurement<3>({z}, {factor});
    } else {
      LinearMeasurement<kStates, 1> z;
      z.innovation.setZero();
      z.H = derivative<1>([&](const Errors& x) { return Vector<1>(view.height(x, p.depth_lever_body)); }, unit_);
      z.R = Matrix<1>(p.depth_white * p.depth_white);
      bound.measurement<1>({z}, {Vector<1>(depth_.of(labelled.variance(0), time))});
    }
  }

  const Scenario& scenario_;
  ins::Trajectory trajectory_;
  std::vector<ImuReading> imu_;
  Errors unit_;
  MeasurementInformation dvl_, depth_;
};

}  // namespace

Named<double> sinsBound(const Scenario& scenario, double skip, const std::vector<std::uint64_t>& seeds) {
  const SinsBound bound(scenario);
  const ins::Trajectory trajectory(scenario.track, scenario.duration);
  MeanSquares scored, end;
  const bool genie = MeasurementInformation(scenario.dvl.noise).genie();
  for (const auto seed : seeds) {
    bound.follow(sins::simulate(scenario, trajectory, seed), skip, scored, end);
    if (!genie) break;
  }
  return {{"position", scored.rms(3, 2)},
          {"height", scored.rms(5, 1)},
          {"velocity", scored.rms(0, 3)},
          {"tilt", scored.rms(6, 2)},
          {"heading", scored.rms(8, 1)},
          {"drift_percent", 100 * end.rms(3, 2) / (scenario.track.speed * scenario.duration)}};
}

}  // namespace sas_motion::sins

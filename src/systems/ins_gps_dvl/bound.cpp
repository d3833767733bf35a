// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <cmath>

#include "sas_motion/evaluation/bounds.hpp"
#include "sas_motion/evaluation/information.hpp"
#include "sas_motion/systems/ins_gps_dvl/simulator.hpp"
#include "systems/ins_gps_dvl/campaign.hpp"

namespace sas_motion::ins {
namespace {

constexpr double kStep = 0.2;  // longest step of the recursion [s]
constexpr int kParts = 8;      // of a step, to average the motion over

ErrorModel::Motion meanMotion(const Trajectory& trajectory, double begin, double end) {
  ErrorModel::Motion motion{trajectory.at(0.5 * (begin + end)).state, Vector<3>::Zero(), Matrix<3>::Zero()};
  motion.state.velocity_nav.setZero();
  for (int i = 0; i < kParts; ++i) {
    const TruthSample truth = trajectory.at(begin + (end - begin) * (i + 0.5) / kParts);
    const Matrix<3> C = truth.state.q_nav_body.toRotationMatrix();
    motion.C_nav_body += C / kParts;
    motion.force_nav += C * truth.forceBody() / kParts;
    motion.state.velocity_nav += truth.state.velocity_nav / kParts;
  }
  return motion;
}

/// The recursion along the true trajectory, for the side information of one recording.
class InsBound {
 public:
  InsBound(const Scenario& scenario, const Trajectory& trajectory)
      : scenario_(scenario),
        trajectory_(trajectory),
        model_(scenario.parameters, trajectory.at(0).state),
        information_{
            MeasurementInformation(scenario.sensors[0].noise), MeasurementInformation(scenario.sensors[1].noise),
            MeasurementInformation(scenario.sensors[2].noise), MeasurementInformation(scenario.sensors[3].noise)} {}

  void follow(const Recording& recording, double skip, MeanBound<kStates>& scored, MeanBound<kStates>& outage) const {
    PosteriorBound<kStates> bound(model_.start().covariance.llt().solve(ErrorMatrix::Identity()));
    double now = 0;
    for (const auto& labelled : recording.aiding) {
      const double time = secondsBetween(0, labelled.reading.stamp);
      for (double next; now < time - 1e-9; now = next) {
        next = std::min(time, now + kStep);
        bound.step({model_.transition(meanMotion(trajectory_, now, next), next - now, Errors::Zero())});
      }
      update(bound, labelled, time);
      if (labelled.reading.sensor != Sensor::Dvl) continue;
      if (time >= skip) scored.add(bound);
      for (const auto& out : scenario_.sensor(Sensor::Gps).outages)
        if (std::abs(time - out.end) < 1e-6) outage.add(bound);
    }
  }

 private:
  void update(PosteriorBound<kStates>& bound, const LabelledAiding& labelled, double time) const {
    const TruthSample truth = trajectory_.at(time);
    const auto sensor = labelled.reading.sensor;
    Vector<3> factor;
    for (int row = 0; row < 3; ++row)
      factor(row) = information_[static_cast<std::size_t>(sensor)].of(labelled.variance(row), time);
    switch (sensor) {
      case Sensor::Gps: bound.measurement<3>({model_.gps(truth.state, truth.state, Errors::Zero())}, {factor}); break;
      case Sensor::Dvl:
        bound.measurement<3>({model_.dvl(truth.state, truth.rateBody(), Vector<3>::Zero(), Errors::Zero())}, {factor});
        break;
      case Sensor::Depth:
        bound.measurement<1>({model_.depth(truth.state, 0, Errors::Zero())}, {factor.head<1>()});
        break;
      case Sensor::Dpc:
        bound.measurement<2>({model_.dpc(truth.state, truth.rateBody(), labelled.reading.array, Errors::Zero())},
                             {factor.head<2>()});
        break;
    }
  }

  const Scenario& scenario_;
  const Trajectory& trajectory_;
  ErrorModel model_;
  std::array<MeasurementInformation, kSensors> information_;
};

/// Whether the side information of the bound differs from run to run.
bool differsByRun(const Scenario& scenario) {
  for (const auto& sensor : scenario.sensors) {
    if (MeasurementInformation(sensor.noise).genie()) return true;
    for (const auto& law : sensor.noise.laws)
      if (law.kind == NoiseLaw::Kind::Dropout) return true;
  }
  return false;
}

}  // namespace

Named<double> insBound(const Scenario& scenario, double skip, const std::vector<std::uint64_t>& seeds) {
  if (scenario.parameters.dvl_scale > 0 || scenario.parameters.dvl_misalignment > 0)
    return {};  // not among the 27 states
  const Trajectory trajectory(scenario.track, scenario.duration);
  const InsBound bound(scenario, trajectory);
  MeanBound<kStates> scored, outage;
  for (const auto seed : seeds) {
    bound.follow(simulate(scenario, trajectory, seed), skip, scored, outage);
    if (!differsByRun(scenario)) break;
  }
  const Errors unit = ErrorModel(scenario.parameters, trajectory.at(0).state).unit();
  Named<double> bounds = scored.rmses({{"position", {kPosition, kPosition + 1}},
                                       {"height", {kPosition + 2}},
                                       {"velocity", {kVelocity, kVelocity + 1, kVelocity + 2}},
                                       {"tilt", {kAttitude, kAttitude + 1}},
                                       {"heading", {kAttitude + 2}}});
  for (auto& [group, rmse] : bounds)
    if (group == "tilt" || group == "heading") rmse *= unit(kAttitude);
  if (const auto drift = outage.rmse({kPosition, kPosition + 1})) bounds.emplace_back("outage", *drift);
  return bounds;
}

}  // namespace sas_motion::ins

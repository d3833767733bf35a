// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "sas_motion/evaluation/bounds.hpp"
#include "sas_motion/evaluation/information.hpp"
#include "systems.hpp"

namespace sas_motion {
namespace {

using namespace towfish;

constexpr double kLockOutEpoch = 1;  // [s]

/// The largest position error of an axis over its standard deviation.
double errorRatio(const Estimate& estimate, const StateVector& truth) {
  const StateVector error = Model::difference(estimate.belief.mean, truth);
  return (error.head<2>().array().abs() / estimate.belief.covariance.diagonal().head<2>().array().sqrt()).maxCoeff();
}

std::optional<double> total(const std::array<Detection, kSensors>& detection, std::optional<double> (Detection::*share)() const) {
  Detection all;
  for (const auto& d : detection) {
    all.labelled += d.labelled;
    all.flagged += d.flagged;
    all.hits += d.hits;
  }
  return (all.*share)();
}

/// Measurement `index` of every run, at truth `k`.
void addMeasurement(PosteriorBound<kStates>& bound, const Model& model, const std::vector<SimulatedRun>& runs, std::size_t k, std::size_t index,
                    const std::array<MeasurementInformation, kSensors>& information) {
  const Measurement& z = runs.front().measurements()[index].z;
  if (rowsOf(z.sensor) == 0) return;
  model.linearize(z, runs.front().truth()[k], [&](const auto& first) {
    constexpr int kRows = std::decay_t<decltype(first)>::kRows;
    std::vector<LinearMeasurement<kStates, kRows>> linear;
    std::vector<Vector<kRows>> factors;
    for (const auto& run : runs) {
      const auto& labelled = run.measurements()[index];
      model.linearize(labelled.z, run.truth()[k], [&](const auto& one) {
        if constexpr (std::decay_t<decltype(one)>::kRows == kRows) linear.push_back(one);
      });
      Vector<kRows> factor;
      for (int row = 0; row < kRows; ++row)
        factor(row) = information[static_cast<std::size_t>(z.sensor)].of(labelled.variance[static_cast<std::size_t>(row)],
                                                                         secondsBetween(Simulator::kStart, labelled.z.stamp));
      factors.push_back(factor);
    }
    bound.measurement<kRows>(linear, factors);
  });
}

class TowfishSystem final : public System {
 public:
  TowfishSystem(YamlSection& section, const std::string& folder, EstimatorFactory make) : campaign_(Campaign::read(section, folder)), make_(std::move(make)) {
    dimension = kStates;
    duration = campaign_.scenario.duration;
    skip = campaign_.skip;
    estimators = campaign_.estimators;
    for (const auto& estimator : estimators)
      if (estimator != kOracle && estimator != kBayesReference && !make_(estimator, campaign_.config))
        section.fail("estimators", fmt::format("names '{}', which is no estimator", estimator));
    for (const auto& law : campaign_.laws) laws.push_back(infoOf(law));
  }

  std::vector<EstimatorReport> run(std::size_t law, std::uint64_t seed) const override {
    const Scenario scenario = campaign_.scenarioUnder(campaign_.laws[law]);
    const SimulatedRun run(scenario, seed);
    std::vector<EstimatorReport> reports;
    for (const auto& name : estimators) {
      double seconds = 0;
      const Output output = estimate(campaign_, scenario, run, name, make_, seconds);
      reports.push_back(reportOf(name, run, output));
      reports.back().microseconds = 1e6 * seconds / static_cast<double>(std::max<std::size_t>(1, run.measurements().size()));
    }
    return reports;
  }

  Named<Trace> trace(std::size_t law, std::uint64_t seed) const override {
    const Scenario scenario = campaign_.scenarioUnder(campaign_.laws[law]);
    const SimulatedRun run(scenario, seed);
    Named<Trace> traces;
    double seconds = 0;
    for (const auto& name : estimators) traces.emplace_back(name, traceOf(run, estimate(campaign_, scenario, run, name, make_, seconds)));
    return traces;
  }

  Named<double> bound(std::size_t law, const std::vector<std::uint64_t>& seeds) const override;

 private:
  LawInfo infoOf(const CampaignLaw& law) const {
    const Scenario scenario = campaign_.scenarioUnder(law);
    LawInfo info = lawInfo(law.name, scenario.sensor(Sensor::Position).noise, scenario.process);
    if (!law.sensors.empty()) info.epsilon = info.K = std::nullopt;  // no point of a sweep
    return info;
  }

  EstimatorReport reportOf(const std::string& name, const SimulatedRun& run, const Output& output) const {
    const Scores scores = score(campaign_, run, output);
    EstimatorReport report;
    report.estimator = name;
    report.diverged = scores.diverged;
    report.samples = scores.samples;
    for (int i = 0; i < kGroups; ++i) {
      const auto group = static_cast<Group>(i);
      if (scores.error[group]) report.errors.emplace_back(groupName(group), *scores.error[group]);
      if (scores.nees[group]) report.nees.emplace_back(groupName(group), scores.nees[group]->mean / scores.nees[group]->degrees);
    }
    if (scores.nees_full) report.nees.emplace_back("full", scores.nees_full->mean / kStates);
    for (std::size_t i = 0; i < kSensors; ++i)
      if (scores.nis[i]) report.nis.emplace_back(sensorName(static_cast<Sensor>(i)), scores.nis[i]->mean / scores.nis[i]->degrees);
    report.aperture_across = scores.aperture.across;
    report.precision = total(scores.detection, &Detection::precision);
    report.recall = total(scores.detection, &Detection::recall);
    LockOut lock_out(kLockOutEpoch);
    for (const auto& estimate : output.estimates)
      if (scored(estimate.stamp)) lock_out.add(secondsBetween(Simulator::kStart, estimate.stamp), errorRatio(estimate, run.at(estimate.stamp).state));
    report.locked_out = lock_out.lockedOut();
    return report;
  }

  Trace traceOf(const SimulatedRun& run, const Output& output) const {
    Trace trace;
    trace.nees_degrees = kStates;
    trace.nis_degrees = rowsOf(Sensor::Position);
    for (const auto& estimate : output.estimates) {
      if (!scored(estimate.stamp)) continue;
      const StateVector error = Model::difference(estimate.belief.mean, run.at(estimate.stamp).state);
      trace.time.push_back(secondsBetween(Simulator::kStart, estimate.stamp));
      trace.error.push_back(error.head<2>().norm());
      trace.sigma3.push_back(3 * std::sqrt(estimate.belief.covariance.diagonal().head<2>().sum()));
      trace.nees.push_back(normalisedSquare(estimate, run.at(estimate.stamp)));
    }
    for (const auto& audit : output.audits) {
      if (audit.sensor != Sensor::Position || !scored(audit.stamp)) continue;
      trace.weight_time.push_back(secondsBetween(Simulator::kStart, audit.stamp));
      trace.weight.push_back(audit.weights.minCoeff());
      trace.outlier.push_back(run.outlier(audit));
      trace.nis.push_back(audit.S(0, 0) > 0 ? audit.nis : NAN);
    }
    return trace;
  }

  bool scored(Stamp stamp) const { return secondsBetween(Simulator::kStart, stamp) >= skip; }

  Campaign campaign_;
  EstimatorFactory make_;
};

/// The recursion over the measurements of all truths at once; nothing for a survey, whose truth is not drawn from the model, and nothing
/// where sensors drop out, as truths then have no measurements in common.
Named<double> TowfishSystem::bound(std::size_t law, const std::vector<std::uint64_t>& seeds) const {
  const Scenario scenario = campaign_.scenarioUnder(campaign_.laws[law]);
  const auto process = processInformation(scenario.process, kStates, scenario.step);
  if (scenario.kind != Scenario::Kind::RandomWalk || process.genie) return {};
  std::vector<SimulatedRun> runs;
  for (const auto seed : seeds) runs.emplace_back(scenario, seed);
  const auto alike = [](const LabelledMeasurement& a, const LabelledMeasurement& b) { return a.z.stamp == b.z.stamp && a.z.sensor == b.z.sensor; };
  const auto& front = runs.front().measurements();
  for (const auto& run : runs)
    if (!std::equal(run.measurements().begin(), run.measurements().end(), front.begin(), front.end(), alike)) return {};
  std::array<MeasurementInformation, kSensors> information{MeasurementInformation(scenario.sensors[0].noise), MeasurementInformation(scenario.sensors[1].noise),
                                                           MeasurementInformation(scenario.sensors[2].noise),
                                                           MeasurementInformation(scenario.sensors[3].noise)};
  const Model model(scenario.motion);
  const StateVector prior = (StateVector() << 1, 1, 1 / scenario.motion.current_sigma, 1 / scenario.motion.current_sigma, 1, 1).finished();
  PosteriorBound<kStates> bound(prior.cwiseAbs2().asDiagonal());
  std::array<double, kGroups> squares{};
  std::size_t count = 0, next = 0;
  const auto& stamps = front;
  for (std::size_t k = 0; k < runs.front().truth().size(); ++k) {
    const Stamp stamp = Simulator::kStart + static_cast<Stamp>(k) * stampFromSeconds(scenario.step);
    if (k > 0) {
      std::vector<Transition<kStates>> steps;
      for (const auto& run : runs) steps.push_back(model.transition(run.truth()[k - 1], Input{}, scenario.step));
      bound.step(steps, process.factor);
    }
    for (; next < stamps.size() && stamps[next].z.stamp == stamp; ++next) addMeasurement(bound, model, runs, k, next, information);
    if (!scored(stamp)) continue;
    const auto P = bound.covariance();
    if (!P) return {};
    const StateVector variance = P->diagonal();
    squares[kPositionGroup] += variance(kNorth) + variance(kEast);
    squares[kHeadingGroup] += variance(kHeading);
    squares[kSpeedGroup] += variance(kSpeed);
    squares[kCurrentGroup] += variance(kCurrentNorth) + variance(kCurrentEast);
    ++count;
  }
  Named<double> result;
  for (int i = 0; i < kGroups; ++i)
    result.emplace_back(groupName(static_cast<Group>(i)), std::sqrt(squares[static_cast<std::size_t>(i)] / static_cast<double>(count)));
  return result;
}

}  // namespace

std::unique_ptr<System> makeTowfishSystem(YamlSection& campaign, const std::string& folder, const EstimatorFactory& make) {
  return std::make_unique<TowfishSystem>(campaign, folder, make);
}

LawInfo lawInfo(const std::string& name, const NoiseMix& measurement, const NoiseMix& process) {
  LawInfo info{name, measurement.name(), {}, {}};
  if (!process.laws.empty()) info.description += ", process " + process.name();
  if (info.name.empty()) info.name = info.description;
  const auto gaussian = [](const NoiseMix& mix) {
    return std::all_of(mix.laws.begin(), mix.laws.end(), [](const NoiseLaw& law) { return law.kind == NoiseLaw::Kind::Gaussian; });
  };
  if (gaussian(measurement) && gaussian(process)) info.epsilon = 0, info.K = 1;
  if (gaussian(process) && measurement.laws.size() == 1 && measurement.laws[0].kind == NoiseLaw::Kind::Contaminated) {
    info.epsilon = measurement.laws[0].epsilon;
    info.K = measurement.laws[0].K;
  }
  return info;
}

}  // namespace sas_motion

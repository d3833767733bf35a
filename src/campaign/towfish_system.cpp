// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

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

class TowfishSystem final : public System {
 public:
  TowfishSystem(YamlSection& section, const std::string& folder, EstimatorFactory make) : campaign_(Campaign::read(section, folder)), make_(std::move(make)) {
    dimension = kStates;
    duration = campaign_.scenario.duration;
    skip = campaign_.skip;
    estimators = campaign_.estimators;
    for (const auto& estimator : estimators)
      if (estimator != kOracle && !make_(estimator, campaign_.config))
        section.fail("estimators", fmt::format("names '{}', which is no estimator", estimator));
    for (const auto& law : campaign_.laws)
      laws.push_back(lawInfo(law.name, law.noise.value_or(campaign_.scenario.sensor(Sensor::Position).noise), law.process.value_or(campaign_.scenario.process)));
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

  Named<double> bound(std::size_t, const std::vector<std::uint64_t>&) const override { return {}; }

 private:
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
      trace.nees.push_back(error.dot(estimate.belief.covariance.llt().solve(error)));
    }
    for (const auto& audit : output.audits) {
      if (audit.sensor != Sensor::Position || !scored(audit.stamp)) continue;
      trace.weight_time.push_back(secondsBetween(Simulator::kStart, audit.stamp));
      trace.weight.push_back(audit.weights.minCoeff());
      trace.outlier.push_back(run.outlier(audit));
      if (audit.S(0, 0) > 0) trace.nis.push_back(audit.nis);
    }
    return trace;
  }

  bool scored(Stamp stamp) const { return secondsBetween(Simulator::kStart, stamp) >= skip; }

  Campaign campaign_;
  EstimatorFactory make_;
};

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

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "campaign/systems.hpp"

namespace sas_motion {
namespace {

using namespace towfish;

constexpr double kLockOutEpoch = 1;  // [s]

/// The largest position error of an axis over its standard deviation.
double errorRatio(const Estimate& estimate, const StateVector& truth) {
  const StateVector error = Model::difference(estimate.belief.mean, truth);
  return (error.head<2>().array().abs() / estimate.belief.covariance.diagonal().head<2>().array().sqrt()).maxCoeff();
}

std::optional<double> total(const std::array<Detection, kSensors>& detection,
                            std::optional<double> (Detection::*share)() const) {
  Detection all;
  for (const auto& d : detection) {
    all.labelled += d.labelled;
    all.flagged += d.flagged;
    all.hits += d.hits;
  }
  return (all.*share)();
}

/// Scores one estimator over a run, without the start, as its output comes.
class RunScore {
 public:
  RunScore(const SimulatedRun& run, Stamp from) : run_(run), from_(from) {}

  void take(const Output& output) {
    for (const auto& estimate : output.solutions) {
      if (estimate.stamp < from_) continue;
      const Reference truth = run_.at(estimate.stamp);
      scorer_.add(estimate, truth);
      lock_out_.add(secondsBetween(Simulator::kStart, estimate.stamp), errorRatio(estimate, truth.state));
    }
    for (const auto& audit : output.audits)
      if (audit.stamp >= from_) scorer_.add(audit, run_.outlier(audit));
  }

  EstimatorReport report(const std::string& name) const {
    const Scores scores = scorer_.scores();
    EstimatorReport report;
    report.estimator = name;
    report.diverged = scores.diverged;
    report.locked_out = lock_out_.lockedOut();
    report.samples = scores.samples;
    for (int i = 0; i < kGroups; ++i) {
      const auto group = static_cast<Group>(i);
      if (scores.error[group]) report.errors.emplace_back(groupName(group), *scores.error[group]);
      if (scores.nees[group])
        report.nees.emplace_back(groupName(group), scores.nees[group]->mean / scores.nees[group]->degrees);
    }
    if (scores.nees_full) report.nees.emplace_back("full", scores.nees_full->mean / kStates);
    for (std::size_t i = 0; i < kSensors; ++i)
      if (scores.nis[i])
        report.nis.emplace_back(sensorName(static_cast<Sensor>(i)), scores.nis[i]->mean / scores.nis[i]->degrees);
    report.aperture_across = scores.aperture.across;
    if (scores.aperture.windows > 0) report.aperture_wavelengths = scores.aperture.across / scores.aperture.wavelength;
    report.precision = total(scores.detection, &Detection::precision);
    report.recall = total(scores.detection, &Detection::recall);
    return report;
  }

 private:
  const SimulatedRun& run_;
  Stamp from_;
  Scorer scorer_;
  LockOut lock_out_{kLockOutEpoch};
};

/// Takes what is to be plotted of one part of a run, without the start.
void record(const SimulatedRun& run, Stamp from, const Output& output, Trace& trace) {
  for (const auto& estimate : output.solutions) {
    if (estimate.stamp < from) continue;
    const Reference truth = run.at(estimate.stamp);
    trace.time.push_back(secondsBetween(Simulator::kStart, estimate.stamp));
    const StateVector error = Model::difference(estimate.belief.mean, truth.state),
                      variance = estimate.belief.covariance.diagonal();
    trace.error.push_back(error.head<2>().norm());
    trace.sigma3.push_back(3 * std::sqrt(variance.head<2>().sum()));
    trace.add(groupName(kHeadingGroup), error(kHeading), variance(kHeading));
    trace.add(groupName(kSpeedGroup), error(kSpeed), variance(kSpeed));
    trace.add(groupName(kCurrentGroup), error.segment<2>(kCurrentNorth).norm(),
              variance.segment<2>(kCurrentNorth).sum());
    trace.nees.push_back(normalisedSquare(estimate, truth));
  }
  for (const auto& audit : output.audits) {
    if (audit.sensor != sensorName(Sensor::Position) || audit.stamp < from) continue;
    trace.weight_time.push_back(secondsBetween(Simulator::kStart, audit.stamp));
    trace.weight.push_back(audit.weights.minCoeff());
    trace.outlier.push_back(run.outlier(audit));
    trace.nis.push_back(audit.S(0, 0) > 0 ? audit.nis : NAN);
  }
}

class TowfishSystem final : public System {
 public:
  TowfishSystem(YamlSection& section, const std::string& folder, EstimatorFactory make)
      : campaign_(Campaign::read(section, folder)), make_(std::move(make)) {
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
      RunScore score(run, firstScored());
      const double seconds =
          estimate(campaign_, scenario, run, name, make_, [&](const Output& output) { score.take(output); });
      reports.push_back(score.report(name));
      reports.back().microseconds =
          1e6 * seconds / static_cast<double>(std::max<std::size_t>(1, run.measurements().size()));
    }
    return reports;
  }

  Named<Trace> trace(std::size_t law, std::uint64_t seed) const override {
    const Scenario scenario = campaign_.scenarioUnder(campaign_.laws[law]);
    const SimulatedRun run(scenario, seed);
    Named<Trace> traces;
    for (const auto& name : estimators) {
      Trace& trace = traces.emplace_back(name, Trace{}).second;
      trace.nees_degrees = kStates;
      trace.nis_degrees = rowsOf(Sensor::Position);
      estimate(campaign_, scenario, run, name, make_,
               [&](const Output& output) { record(run, firstScored(), output, trace); });
    }
    return traces;
  }

  Named<double> bound(std::size_t law, const std::vector<std::uint64_t>& seeds) const override {
    return towfishBound(campaign_.scenarioUnder(campaign_.laws[law]), skip, seeds);
  }

 private:
  LawInfo infoOf(const CampaignLaw& law) const {
    const Scenario scenario = campaign_.scenarioUnder(law);
    LawInfo info = lawInfo(law.name, scenario.sensor(Sensor::Position).noise, scenario.process);
    if (!law.sensors.empty()) info.epsilon = info.K = std::nullopt;  // no point of a sweep
    return info;
  }

  Stamp firstScored() const { return Simulator::kStart + stampFromSeconds(skip); }

  Campaign campaign_;
  EstimatorFactory make_;
};

}  // namespace

std::unique_ptr<System> makeTowfishSystem(YamlSection& campaign, const std::string& folder,
                                          const EstimatorFactory& make) {
  return std::make_unique<TowfishSystem>(campaign, folder, make);
}

LawInfo lawInfo(const std::string& name, const NoiseMix& measurement, const NoiseMix& process) {
  LawInfo info{name, measurement.name(), {}, {}};
  if (!process.laws.empty()) info.description += ", process " + process.name();
  if (info.name.empty()) info.name = info.description;
  const auto gaussian = [](const NoiseMix& mix) {
    return std::all_of(mix.laws.begin(), mix.laws.end(),
                       [](const NoiseLaw& law) { return law.kind == NoiseLaw::Kind::Gaussian; });
  };
  if (gaussian(measurement) && gaussian(process)) info.epsilon = 0, info.K = 1;
  if (gaussian(process) && measurement.laws.size() == 1 && measurement.laws[0].kind == NoiseLaw::Kind::Contaminated) {
    info.epsilon = measurement.laws[0].epsilon;
    info.K = measurement.laws[0].K;
  }
  return info;
}

}  // namespace sas_motion

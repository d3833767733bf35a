// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/towfish/campaign.hpp"

#include <cmath>

namespace sas_motion::towfish {
namespace {

/// The state groups that are scored on their own; -1 where there is no second state.
struct Group {
  const char* name;
  int first, second;
};
constexpr std::array<Group, 4> kGroups{{{"position", kNorth, kEast},
                                        {"heading", kHeading, -1},
                                        {"speed", kSpeed, -1},
                                        {"current", kCurrentNorth, kCurrentEast}}};

void score(const Group& group, const StateVector& error, const StateMatrix& P, EstimatorScorer& scorer) {
  const auto [name, a, b] = group;
  scorer.addError(name, b < 0 ? std::abs(error(a)) : std::hypot(error(a), error(b)));
  if (!(P(a, a) > 0)) return;  // zero is unknown
  if (b < 0) return scorer.addNees(name, error(a) * error(a) / P(a, a), 1);
  Matrix<2> block;
  block << P(a, a), P(a, b), P(b, a), P(b, b);
  scorer.addNees(name, normalisedSquare<2>({error(a), error(b)}, block), 2);
}

/// `noise` is of position, heading and speed, but for those under `sensors`; `process` is of a random walk.
LawInfo readLaw(YamlSection& yaml, const std::string& name, Scenario& scenario) {
  auto sensors = yaml.section("sensors");
  bool differ = false;
  for (const auto sensor : noisySensors()) {
    auto& noise = scenario.sensor(sensor).noise;
    if (yaml.has("noise")) noise = NoiseMix::read(yaml, "noise");
    if (!sensors.has(sensorName(sensor))) continue;
    noise = NoiseMix::read(sensors, sensorName(sensor));
    differ = true;
  }
  sensors.finish();
  if (yaml.has("process")) scenario.process = NoiseMix::read(yaml, "process", NoiseUse::Process);
  LawInfo info = lawInfo(name, scenario.sensor(Sensor::Position).noise, scenario.process);
  if (differ) info.epsilon = info.K = std::nullopt;  // no point of a sweep
  return info;
}

/// Monte Carlo of one scenario.
class TowfishCampaign final : public Campaign {
 public:
  TowfishCampaign(YamlSection& yaml, const std::string& folder, EstimatorFactory make) : make_(std::move(make)) {
    dimension = kStates;
    const auto scenario = readScenario<Scenario>(yaml, folder);
    if (yaml.has("config")) {
      auto section = YamlSection::fromFile(fileOf(yaml, "config", folder));
      readConfig(section, config_);
      for (const char* key : {"topics", "frames", "datum"}) section.ignore(key);  // of the nodelets
      section.finish();
    } else {
      config_.model = scenario.motion;  // the estimators know the model that truth is drawn from
    }
    auto settings = yaml.section("settings");
    readConfig(settings, config_);
    settings.finish();
    readScoring(yaml, 20, [&](const std::string& name) {
      return name == kOracle || name == kBayesReference || make_(name, config_);
    });
    scenarios_ = readLaws(yaml, scenario, &readLaw, "as in the scenario");
  }

  Named<double> bound(std::size_t law, const std::vector<std::uint64_t>& seeds) const override {
    return towfishBound(scenarios_[law], skip, seeds);
  }

 private:
  std::vector<EstimatorScorer> score(std::size_t law, std::uint64_t seed) const override {
    const SimulatedRun run(scenarios_[law], seed);
    ScorerOptions options;
    options.traced = sensorName(Sensor::Position);
    std::vector<EstimatorScorer> scorers;
    for (const auto& name : estimators) {
      auto& scorer = scorers.emplace_back(name, options);
      scorer.trace().nees_degrees = kStates;
      scorer.trace().nis_degrees = rowsOf(Sensor::Position);
      const double seconds = estimate(config_, scenarios_[law], run, name, make_,
                                      [&](const Output& output) { take(output, run, scorer); });
      scorer.setCost(seconds, run.measurements().size());
    }
    return scorers;
  }

  void take(const Output& output, const SimulatedRun& run, EstimatorScorer& scorer) const {
    const Stamp from = Simulator::kStart + stampFromSeconds(skip);
    for (const auto& estimate : output.solutions)
      if (estimate.stamp >= from) towfish::score(estimate, run.at(estimate.stamp), scorer);
    for (const auto& audit : output.audits)
      if (audit.stamp >= from)
        scorer.addAudit(secondsBetween(Simulator::kStart, audit.stamp), audit, run.outlier(audit));
  }

  EstimatorFactory make_;
  Config config_;
  std::vector<Scenario> scenarios_;  // by law
};

}  // namespace

void score(const Estimate& estimate, const StateVector& truth, EstimatorScorer& scorer) {
  const StateMatrix& P = estimate.belief.covariance;
  const StateVector error = Model::difference(estimate.belief.mean, truth), variance = P.diagonal();
  const double time = secondsBetween(Simulator::kStart, estimate.stamp), square = normalisedSquare<kStates>(error, P);
  scorer.addRatio(time, (error.head<2>().array().abs() / variance.head<2>().array().sqrt()).maxCoeff());
  Trace& trace = scorer.trace();
  trace.add(time, error.head<2>().norm(), variance.head<2>().sum());
  trace.add("heading", error(kHeading), variance(kHeading));
  trace.add("speed", error(kSpeed), variance(kSpeed));
  trace.add("current", error.segment<2>(kCurrentNorth).norm(), variance.segment<2>(kCurrentNorth).sum());
  trace.nees.push_back(square);
  const bool finite = estimate.belief.mean.allFinite() && P.allFinite();
  scorer.addSample(finite);
  if (!finite) return;
  for (const auto& group : kGroups) score(group, error, P, scorer);
  scorer.addNees("full", square, kStates);
  const double c = std::cos(truth(kHeading)), s = std::sin(truth(kHeading));
  scorer.addOffset(secondsBetween(0, estimate.stamp), c * error(kNorth) + s * error(kEast),
                   c * error(kEast) - s * error(kNorth), truth(kSpeed));
}

std::unique_ptr<Campaign> readCampaign(YamlSection& yaml, const std::string& folder, const EstimatorFactory& make) {
  return std::make_unique<TowfishCampaign>(yaml, folder, make);
}

}  // namespace sas_motion::towfish

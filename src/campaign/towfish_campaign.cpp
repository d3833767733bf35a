// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/campaign/towfish_campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "sas_motion/evaluation/law_aware.hpp"
#include "sas_motion/io/cpu_time.hpp"
#include "sas_motion/pipeline/filter_timeline.hpp"

namespace sas_motion::towfish {
namespace {

constexpr std::array<Sensor, 3> kNoisy{Sensor::Position, Sensor::Heading, Sensor::Speed};

Measurement toldTheTruth(LabelledMeasurement labelled) {
  for (int row = 0; row < 2; ++row) labelled.z.variance(row) *= labelled.variance[static_cast<std::size_t>(row)];
  return labelled.z;
}

CampaignLaw readLaw(YamlSection& yaml) {
  CampaignLaw law;
  yaml.text("name", law.name);
  if (yaml.has("noise")) law.noise = NoiseMix::read(yaml, "noise");
  if (yaml.has("process")) law.process = NoiseMix::read(yaml, "process", NoiseUse::Process);
  auto sensors = yaml.section("sensors");
  for (const auto sensor : kNoisy)
    if (sensors.has(sensorName(sensor))) law.sensors[sensor] = NoiseMix::read(sensors, sensorName(sensor));
  sensors.finish();
  yaml.finish();
  return law;
}

/// Updates a second of the fastest sensor.
double fastestRate(const Scenario& scenario) {
  double rate = 1 / scenario.duration;
  for (const auto sensor : kNoisy) rate = std::max(rate, scenario.sensor(sensor).rate);
  return rate;
}

/// The law-aware reference: told the position's law for all sensors, and which rows have its spells.
std::unique_ptr<Estimator> makeBayesReference(const Campaign& campaign, const Scenario& scenario) {
  const auto& law = scenario.sensor(Sensor::Position).noise;
  auto options = lawAware(law, scenario.process, 1 / fastestRate(scenario));
  options.mode.common = true;
  options.mode.rows = 0;
  for (const auto sensor : kNoisy)
    if (scenario.sensor(sensor).noise.name() == law.name())
      for (int row = 0; row < rowsOf(sensor); ++row) options.mode.rows |= 1U << (4 * static_cast<unsigned>(sensor) + static_cast<unsigned>(row));
  using Filter = GaussianSumFilter<kStates>;
  return std::make_unique<FilterTimeline<Filter>>([options](const Config&) { return Filter(options); }, campaign.config);
}

}  // namespace

Campaign Campaign::read(YamlSection& yaml, const std::string& folder) {
  Campaign campaign;
  std::string scenario, config;
  yaml.text("scenario", scenario);
  if (scenario.empty()) yaml.fail("scenario", "is missing; name a scenario file");
  campaign.scenario = Scenario::fromFile(std::filesystem::path(folder) / scenario);
  yaml.text("config", config);
  if (config.empty()) {
    campaign.config.model = campaign.scenario.motion;  // the estimators know the model that truth is drawn from
  } else {
    auto section = YamlSection::fromFile(std::filesystem::path(folder) / config);
    readConfig(section, campaign.config);
    for (const char* key : {"topics", "frames", "datum"}) section.ignore(key);  // of the nodelets
    section.finish();
  }
  auto overrides = yaml.section("settings");
  readConfig(overrides, campaign.config);
  overrides.finish();
  yaml.texts("estimators", campaign.estimators);
  if (campaign.estimators.empty()) yaml.fail("estimators", "is missing; list at least one");
  yaml.number("skip", campaign.skip, {0, 1e6});
  if (campaign.skip >= campaign.scenario.duration)
    yaml.fail("skip", fmt::format("is {} but must be less than a run, which lasts {} s", campaign.skip, campaign.scenario.duration));
  for (auto& item : yaml.list("laws")) campaign.laws.push_back(readLaw(item));
  if (campaign.laws.empty()) campaign.laws.push_back({"as in the scenario", {}, {}, {}});
  return campaign;
}

Scenario Campaign::scenarioUnder(const CampaignLaw& law) const {
  Scenario changed = scenario;
  for (const auto sensor : kNoisy) {
    const auto own = law.sensors.find(sensor);
    if (own != law.sensors.end())
      changed.sensor(sensor).noise = own->second;
    else if (law.noise)
      changed.sensor(sensor).noise = *law.noise;
  }
  if (law.process) changed.process = *law.process;
  return changed;
}

Output estimate(const Campaign& campaign, const Scenario& scenario, const SimulatedRun& run, const std::string& name, const EstimatorFactory& make,
                double& seconds) {
  const bool oracle = name == kOracle;
  const auto estimator = name == kBayesReference ? makeBayesReference(campaign, scenario) : make(oracle ? "kf" : name, campaign.config);
  Output output;
  const double begin = cpuSeconds();
  for (const auto& labelled : run.measurements()) estimator->process(oracle ? toldTheTruth(labelled) : labelled.z, output);
  estimator->finish(output);
  seconds = cpuSeconds() - begin;
  return output;
}

Scores score(const Campaign& campaign, const SimulatedRun& run, const Output& output) {
  const Stamp from = Simulator::kStart + stampFromSeconds(campaign.skip);
  Scorer scorer;
  for (const auto& estimate : output.estimates)
    if (estimate.stamp >= from) scorer.add(estimate, run.at(estimate.stamp));
  for (const auto& audit : output.audits)
    if (audit.stamp >= from) scorer.add(audit, run.outlier(audit));
  return scorer.scores();
}

}  // namespace sas_motion::towfish

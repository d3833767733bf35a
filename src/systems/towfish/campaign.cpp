// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/towfish/campaign.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "sas_motion/io/cpu_time.hpp"
#include "systems/towfish/reference_estimators.hpp"

namespace sas_motion::towfish {
namespace {

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

std::unique_ptr<Estimator> makeNamed(const std::string& name, const Campaign& campaign, const Scenario& scenario,
                                     const SimulatedRun& run, const EstimatorFactory& make) {
  if (name == kOracle) return makeOracle(campaign, run);
  if (name == kBayesReference) return makeBayesReference(campaign, scenario);
  return make(name, campaign.config);
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
    yaml.fail("skip", fmt::format("is {} but must be less than a run, which lasts {} s", campaign.skip,
                                  campaign.scenario.duration));
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

double estimate(const Campaign& campaign, const Scenario& scenario, const SimulatedRun& run, const std::string& name,
                const EstimatorFactory& make, const Listener& listen) {
  constexpr std::size_t kPart = 256;  // measurements
  const bool oracle = name == kOracle;
  const auto estimator = makeNamed(name, campaign, scenario, run, make);
  Output output;
  double seconds = 0, begin = cpuSeconds();
  const auto handOver = [&] {
    seconds += cpuSeconds() - begin;
    listen(output);
    output.clear();
    begin = cpuSeconds();
  };
  std::size_t taken = 0;
  for (const auto& labelled : run.measurements()) {
    estimator->process(oracle ? toldTheTruth(labelled) : labelled.z, output);
    if (++taken % kPart == 0) handOver();
  }
  estimator->finish(output);
  handOver();
  return seconds;
}

}  // namespace sas_motion::towfish

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/ins_gps_dvl/campaign.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "campaign/systems.hpp"

namespace sas_motion {

using namespace ins;

namespace {

/// `noise` is of GPS, DVL and DPC; `gps_outages` are added to the scenario's, `dpc` goes over its section.
LawInfo readLaw(YamlSection& item, Scenario& scenario) {
  std::string name;
  item.text("name", name);
  scenario.readDpc(item.section("dpc"));
  if (item.has("noise"))
    scenario.sensor(Sensor::Gps).noise = scenario.sensor(Sensor::Dvl).noise = scenario.sensor(Sensor::Dpc).noise =
        Scenario::readNoise(item, "noise");
  for (const auto& outage : Scenario::readOutages(item, "gps_outages"))
    scenario.sensor(Sensor::Gps).outages.push_back(outage);
  item.finish();
  LawInfo law = lawInfo(name, scenario.sensor(Sensor::Gps).noise, {});
  if (const auto& outages = scenario.sensor(Sensor::Gps).outages; !outages.empty()) {
    for (const auto& outage : outages)
      law.description += fmt::format(", no GPS from {} to {} s", outage.begin, outage.end);
    law.epsilon = law.K = std::nullopt;
  }
  return law;
}

}  // namespace

std::vector<Scenario> readInsCampaign(YamlSection& campaign, const std::string& folder, System& system) {
  std::string file;
  campaign.text("scenario", file);
  if (file.empty()) campaign.fail("scenario", "is missing; name a scenario file");
  Scenario scenario = Scenario::fromFile(std::filesystem::path(folder) / file);
  campaign.number("duration", scenario.duration, {1, 1e6});
  system.duration = scenario.duration;
  system.skip = 120;
  campaign.number("skip", system.skip, {0, 1e6});
  if (system.skip >= system.duration)
    campaign.fail("skip",
                  fmt::format("is {} but must be less than a run, which lasts {} s", system.skip, system.duration));
  campaign.texts("estimators", system.estimators);
  if (system.estimators.empty()) campaign.fail("estimators", "is missing; list at least one");
  std::vector<Scenario> scenarios;
  for (auto& item : campaign.list("laws")) {
    scenarios.push_back(scenario);
    system.laws.push_back(readLaw(item, scenarios.back()));
  }
  if (system.laws.empty()) campaign.fail("laws", "is missing; list at least one");
  return scenarios;
}

Config configOf(const Scenario& scenario) {
  Config config;
  config.parameters = scenario.parameters;
  config.imu.period = 1 / scenario.imu_rate;
  return config;
}

void replay(Estimator& estimator, const Recording& recording, Output& output, const std::function<void()>& after) {
  estimator.start(recording.start, 0);
  auto next = recording.aiding.begin();
  for (const auto& reading : recording.imu) {
    for (; next != recording.aiding.end() && next->reading.stamp <= reading.stamp; ++next)
      estimator.process(next->reading, output);
    estimator.process(reading, output);
    after();
  }
  estimator.finish(output);
  after();
}

}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/ins_gps_dvl/campaign.hpp"

#include <fmt/format.h>

#include "sas_motion/io/cpu_time.hpp"
#include "sas_motion/systems/ins_gps_dvl/solutions.hpp"
#include "systems/ins_gps_dvl/run_scorer.hpp"

namespace sas_motion::ins {
namespace {

/// Scores solutions of one filter beside each other: it runs once.
template <class Filter>
void follow(const Filter& filter, const NavigatorOptions& options, const Scenario& scenario, const Recording& recording,
            const std::vector<std::pair<Source, RunScorer*>>& runs) {
  Navigator<Filter> navigator(filter, scenario.parameters, recording.start, 0, options);
  auto next = recording.aiding.begin();
  double scoring = 0;
  const double begin = cpuSeconds();
  for (const auto& reading : recording.imu) {
    auto labelled = next;  // what the navigator audits, in order
    for (; next != recording.aiding.end() && next->reading.stamp <= reading.stamp; ++next) navigator.add(next->reading);
    navigator.add(reading);
    const double since = cpuSeconds();
    for (const auto& audit : navigator.audits()) {
      for (const auto& [source, run] : runs) run->add(audit, *labelled);
      ++labelled;
    }
    if (RunScorer::counts(secondsBetween(0, navigator.stamp())))
      for (const auto& [source, run] : runs)
        if (const auto solution = solutionOf(navigator, source)) run->add(*solution);
    scoring += cpuSeconds() - since;
  }
  const double seconds = cpuSeconds() - begin - scoring;
  for (const auto& [source, run] : runs) run->scorer().setCost(seconds, recording.aiding.size());
}

class InsCampaign final : public Campaign {
 public:
  InsCampaign(YamlSection& yaml, const std::string& folder, EstimatorFactory make) : make_(std::move(make)) {
    dimension = kStates;
    const auto scenario = readScenario<Scenario>(yaml, folder);
    readScoring(
        yaml, 120, [&](const std::string& name) { return findSolution(name) || make_(name, {}); }, currentName);
    scenarios_ = readLaws(yaml, scenario, &readLaw);
  }

  Named<double> bound(std::size_t law, const std::vector<std::uint64_t>& seeds) const override {
    return insBound(scenarios_[law], skip, seeds);
  }

 private:
  std::vector<EstimatorScorer> score(std::size_t law, std::uint64_t seed) const override {
    const Scenario& scenario = scenarios_[law];
    const Trajectory trajectory(scenario.track, scenario.duration);
    const Recording recording = simulate(scenario, trajectory, seed);
    const Config config = configOf(scenario);
    std::vector<RunScorer> runs;
    for (const auto& name : estimators) runs.emplace_back(name, scenario, trajectory, skip);
    for (const auto& filter_kind : filterKinds()) {
      std::vector<std::pair<Source, RunScorer*>> mine;
      for (std::size_t i = 0; i < runs.size(); ++i)
        if (const auto* solution = findSolution(estimators[i]); solution && solution->filter == filter_kind)
          mine.emplace_back(solution->source, &runs[i]);
      if (!mine.empty())
        withFilter(filter_kind, config, [&](const auto& filter, const NavigatorOptions& options) {
          follow(filter, options, scenario, recording, mine);
        });
    }
    std::vector<EstimatorScorer> scorers;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (!findSolution(estimators[i])) runs[i].follow(*make_(estimators[i], config), recording);
      scorers.push_back(std::move(runs[i].scorer()));
    }
    return scorers;
  }

  EstimatorFactory make_;
  std::vector<Scenario> scenarios_;  // by law
};

}  // namespace

std::unique_ptr<Campaign> readCampaign(YamlSection& yaml, const std::string& folder, const EstimatorFactory& make) {
  return std::make_unique<InsCampaign>(yaml, folder, make);
}

/// `noise` is of GPS, DVL and DPC; `gps_outages` are added to the scenario's, `dpc` goes over its section.
LawInfo readLaw(YamlSection& yaml, const std::string& name, Scenario& scenario) {
  auto& gps = scenario.sensor(Sensor::Gps);
  scenario.readDpc(yaml.section("dpc"));
  if (yaml.has("noise"))
    gps.noise = scenario.sensor(Sensor::Dvl).noise = scenario.sensor(Sensor::Dpc).noise =
        Scenario::readNoise(yaml, "noise");
  for (const auto& outage : Scenario::readOutages(yaml, "gps_outages")) gps.outages.push_back(outage);
  LawInfo law = lawInfo(name, gps.noise, {});
  for (const auto& outage : gps.outages)
    law.description += fmt::format(", no GPS from {} to {} s", outage.begin, outage.end);
  if (!gps.outages.empty()) law.epsilon = law.K = std::nullopt;
  return law;
}

Config configOf(const Scenario& scenario) {
  Config config;
  config.parameters = scenario.parameters;
  config.imu.period = 1 / scenario.imu_rate;
  return config;
}

}  // namespace sas_motion::ins

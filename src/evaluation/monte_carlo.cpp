// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/evaluation/monte_carlo.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <filesystem>
#include <mutex>
#include <thread>

#include "sas_motion/io/cpu_time.hpp"

namespace sas_motion::towfish {
namespace {

/// One simulated run in memory: truth at every step, and the labelled measurements.
struct SimulatedRun {
  std::vector<StateVector> truth;
  std::vector<LabelledMeasurement> measurements;

  SimulatedRun(const Scenario& scenario, std::uint64_t seed) : step(stampFromSeconds(scenario.step)) {
    Simulator simulator(scenario, seed);
    while (simulator.next()) {
      truth.push_back(simulator.truth().state);
      measurements.insert(measurements.end(), simulator.measurements().begin(), simulator.measurements().end());
    }
  }
  Reference at(Stamp stamp) const { return {truth[static_cast<std::size_t>((stamp - Simulator::kStart) / step)]}; }
  bool outlier(const Audit& audit) const {
    const auto found = std::lower_bound(measurements.begin(), measurements.end(), audit, [](const LabelledMeasurement& m, const Audit& a) {
      return m.z.stamp != a.stamp ? m.z.stamp < a.stamp : m.z.sensor < a.sensor;
    });
    return found->outlier[0] || found->outlier[1];
  }
  Stamp step;
};

Measurement toldTheTruth(LabelledMeasurement labelled, double K) {
  for (int row = 0; row < 2; ++row)
    if (labelled.outlier[static_cast<std::size_t>(row)]) labelled.z.variance(row) *= K * K;
  return labelled.z;
}

RunResult runEstimator(const Campaign& campaign, const SimulatedRun& run, double K, const std::string& name, const EstimatorFactory& make) {
  const bool oracle = name == kOracle;
  const auto estimator = make(oracle ? "kf" : name, campaign.config);
  const Stamp from = Simulator::kStart + stampFromSeconds(campaign.skip);
  Scorer scorer;
  Output output;
  RunResult result;
  result.estimator = name;
  result.measurements = run.measurements.size();
  const double begin = cpuSeconds();
  for (const auto& labelled : run.measurements) estimator->process(oracle ? toldTheTruth(labelled, K) : labelled.z, output);
  estimator->finish(output);
  result.seconds = cpuSeconds() - begin;
  result.nees.assign(static_cast<std::size_t>(campaign.scenario.duration - campaign.skip), NAN);
  for (const auto& estimate : output.estimates) {
    if (estimate.stamp < from) continue;
    scorer.add(estimate, run.at(estimate.stamp));
    const auto second = static_cast<std::size_t>((estimate.stamp - from) / kNanosecondsPerSecond);
    if (second < result.nees.size() && std::isnan(result.nees[second])) result.nees[second] = normalisedSquare(estimate, run.at(estimate.stamp));
  }
  for (const auto& audit : output.audits)
    if (audit.stamp >= from) scorer.add(audit, run.outlier(audit));
  result.scores = scorer.scores();
  return result;
}

}  // namespace

Campaign Campaign::fromFile(const std::string& file) {
  auto yaml = YamlSection::fromFile(file);
  const auto folder = std::filesystem::path(file).parent_path();
  Campaign campaign;
  campaign.name = std::filesystem::path(file).stem();
  yaml.text("name", campaign.name);
  std::string scenario, config;
  yaml.text("scenario", scenario);
  if (scenario.empty()) yaml.fail("scenario", "is missing; name a scenario file");
  campaign.scenario = Scenario::fromFile(folder / scenario);
  yaml.text("config", config);
  if (config.empty()) {
    campaign.config.model = campaign.scenario.motion;  // the estimators know the model that truth is drawn from
  } else {
    auto section = YamlSection::fromFile(folder / config);
    readConfig(section, campaign.config);
    for (const char* key : {"topics", "frames", "datum"}) section.ignore(key);  // of the nodelets
    section.finish();
  }
  auto overrides = yaml.section("settings");
  readConfig(overrides, campaign.config);
  overrides.finish();
  yaml.texts("estimators", campaign.estimators);
  if (campaign.estimators.empty()) yaml.fail("estimators", "is missing; list at least one");
  yaml.integer("runs", campaign.runs, 1, 1'000'000);
  int seed = 1;
  yaml.integer("first_seed", seed, 0, 2'000'000'000);
  campaign.first_seed = static_cast<std::uint64_t>(seed);
  yaml.number("skip", campaign.skip, {0, 1e6});
  if (campaign.skip >= campaign.scenario.duration)
    yaml.fail("skip", fmt::format("is {} but must be less than a run, which lasts {} s", campaign.skip, campaign.scenario.duration));
  for (auto& item : yaml.list("laws")) {
    CampaignLaw law;
    item.text("name", law.name);
    if (item.has("noise")) law.noise = NoiseLaw::read(item.section("noise"));
    item.finish();
    if (law.name.empty()) law.name = law.noise ? law.noise->name() : "as in the scenario";
    campaign.laws.push_back(law);
  }
  if (campaign.laws.empty()) campaign.laws.push_back({"as in the scenario", std::nullopt});
  yaml.finish();
  return campaign;
}

std::vector<RunResult> runOnce(const Campaign& campaign, const CampaignLaw& law, std::uint64_t seed, const EstimatorFactory& make) {
  Scenario scenario = campaign.scenario;
  double K = 1;
  for (auto& sensor : scenario.sensors) {
    if (law.noise && &sensor != &scenario.sensor(Sensor::TurnRate)) sensor.noise = *law.noise;
    K = std::max(K, sensor.noise.K);
  }
  const SimulatedRun run(scenario, seed);
  std::vector<RunResult> results;
  for (const auto& name : campaign.estimators) {
    results.push_back(runEstimator(campaign, run, K, name, make));
    results.back().law = law.name;
    results.back().seed = seed;
  }
  return results;
}

std::vector<RunResult> runCampaign(const Campaign& campaign, int jobs, const EstimatorFactory& make, const std::function<void()>& done) {
  const auto runs = static_cast<std::size_t>(campaign.runs);
  std::vector<std::vector<RunResult>> results(campaign.laws.size() * runs);
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&] {
    try {
      for (std::size_t task = next++; task < results.size(); task = next++) {
        results[task] = runOnce(campaign, campaign.laws[task / runs], campaign.first_seed + task % runs, make);
        done();
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(failure_mutex);
      failure = std::current_exception();
    }
  };
  std::vector<std::thread> threads;
  threads.reserve(static_cast<std::size_t>(jobs));
  for (int i = 0; i < jobs; ++i) threads.emplace_back(work);
  for (auto& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
  std::vector<RunResult> all;
  for (auto& some : results) all.insert(all.end(), some.begin(), some.end());
  return all;
}

}  // namespace sas_motion::towfish

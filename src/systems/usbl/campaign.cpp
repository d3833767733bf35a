// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/usbl/campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "sas_motion/io/cpu_time.hpp"

namespace sas_motion::usbl {
namespace {

constexpr double kScored = 100;  // the paper's statistics are of the last seconds [ZhangTao]
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

Scenario readScenario(YamlSection& yaml, const std::string& folder) {
  if (yaml.isMapping("scenario")) return Scenario::read(yaml.section("scenario"));
  std::string file;
  yaml.text("scenario", file);
  if (file.empty()) yaml.fail("scenario", "is missing; name a scenario file or write one here");
  return Scenario::fromFile(std::filesystem::path(folder) / file);
}

void readSettings(YamlSection yaml, Config& config) {
  std::string mode = modeName(config.mode);
  yaml.text("mode", mode);
  try {
    config.mode = modeFromName(mode);
  } catch (const std::invalid_argument& error) {
    yaml.fail("mode", fmt::format("cannot be: {}", error.what()));
  }
  yaml.number("start_window", config.start_window, {0, 1e6});
  yaml.number("check_window", config.check_window, {0, 1e6});
  yaml.finish();
}

CampaignLaw readLaw(YamlSection& yaml, const Scenario& scenario) {
  CampaignLaw law{"", scenario.noise[0], scenario.stated_factor};
  yaml.text("name", law.name);
  if (yaml.has("noise")) law.noise = NoiseMix::read(yaml, "noise");
  yaml.number("stated_factor", law.stated_factor, {1e-6, 1e6});
  yaml.finish();
  return law;
}

double timeOf(const Ping& ping) { return secondsBetween(kScenarioStart, ping.stamp); }

/// The oracle needs no guard: it starts from the prior, and no outlier is news to it.
Config oracleConfig(const Config& config) {
  Config oracle = config;
  oracle.start_window = oracle.check_window = 0;
  return oracle;
}

Ping toldTheTruth(const LabelledPing& labelled, double stated_factor) {
  Ping ping = labelled.ping;
  ping.reading.variance = ping.reading.variance.cwiseProduct(labelled.variance) / stated_factor;
  return ping;
}

Output filtered(const Campaign& campaign, const std::vector<LabelledPing>& pings, const std::string& name) {
  const bool oracle = name == kOracle;
  Calibrator calibrator(oracle ? "ckf" : name, oracle ? oracleConfig(campaign.config) : campaign.config);
  Output output;
  for (const auto& labelled : pings) {
    const Ping ping = oracle ? toldTheTruth(labelled, campaign.scenario.stated_factor) : labelled.ping;
    const double begin = cpuSeconds();
    const auto report = calibrator.process(ping);
    output.seconds += cpuSeconds() - begin;
    const bool used = report.verdict != Verdict::Invalid;
    output.weights.push_back(used ? report.weights : Vector<kChannels>(Vector<kChannels>::Constant(kNone)));
    output.nis.push_back(used ? report.nis : kNone);
    if (calibrator.started()) output.estimates.push_back({timeOf(ping), calibrator.belief(), calibrator.noiseFactor()});
  }
  return output;
}

Output fitted(const Campaign& campaign, const std::vector<LabelledPing>& pings, const Fitter& fitter) {
  Problem problem{Model(campaign.config.mode), campaign.config.prior, {}, Vector<kChannels>::Ones()};
  for (const auto& labelled : pings) {
    problem.pings.push_back(labelled.ping);
    problem.pings.back().reading = problem.model.convert(labelled.ping.reading);
  }
  Output output;
  const double begin = cpuSeconds();
  const Fit fit = fitter(problem, campaign.config.fit);
  output.seconds = cpuSeconds() - begin;
  output.weights = fit.weights;
  output.weights.resize(pings.size(), Vector<kChannels>::Constant(kNone));
  output.nis.assign(pings.size(), kNone);
  if (fit.failure.empty() && !pings.empty())
    output.estimates.push_back({timeOf(pings.back().ping),
                                {fit.x.head<kStates>(), fit.covariance.topLeftCorner<kStates, kStates>()},
                                fit.scale.cwiseAbs2()});
  return output;
}

}  // namespace

Campaign Campaign::read(YamlSection& yaml, const std::string& folder) {
  Campaign campaign;
  campaign.scenario = readScenario(yaml, folder);
  readSettings(yaml.section("settings"), campaign.config);
  yaml.texts("estimators", campaign.estimators);
  if (campaign.estimators.empty()) yaml.fail("estimators", "is missing; list at least one");
  const double duration = campaign.scenario.duration;
  campaign.skip = std::max(0.0, duration - kScored);
  yaml.number("skip", campaign.skip, {0, 1e6});
  if (campaign.skip >= duration)
    yaml.fail("skip", fmt::format("is {} but must be less than a run, which lasts {} s", campaign.skip, duration));
  for (auto& item : yaml.list("laws")) campaign.laws.push_back(readLaw(item, campaign.scenario));
  if (campaign.laws.empty()) campaign.laws.push_back({"", campaign.scenario.noise[0], campaign.scenario.stated_factor});
  return campaign;
}

Scenario Campaign::scenarioUnder(const CampaignLaw& law) const {
  Scenario changed = scenario;
  changed.noise.fill(law.noise);
  changed.stated_factor = law.stated_factor;
  return changed;
}

bool isEstimator(const std::string& name, const FitterFactory& fitters) {
  const auto& filters = filterNames();
  return name == kOracle || std::find(filters.begin(), filters.end(), name) != filters.end() ||
         (fitters && fitters(name));
}

Output estimate(const Campaign& campaign, const std::vector<LabelledPing>& pings, const std::string& name,
                const FitterFactory& fitters) {
  const Fitter fitter = fitters ? fitters(name) : Fitter();
  return fitter ? fitted(campaign, pings, fitter) : filtered(campaign, pings, name);
}

}  // namespace sas_motion::usbl

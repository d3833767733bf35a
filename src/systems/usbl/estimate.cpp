// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/usbl/estimate.hpp"

#include <algorithm>
#include <limits>

#include "sas_motion/io/cpu_time.hpp"

namespace sas_motion::usbl {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double timeOf(const Ping& ping) { return secondsBetween(kScenarioStart, ping.stamp); }

/// The oracle needs no guard: it starts from the prior, and is given every outlier.
Config oracleConfig(const Config& config) {
  Config oracle = config;
  oracle.start_window = oracle.check_window = 0;
  return oracle;
}

Ping withTrueVariance(const LabelledPing& labelled, double stated_factor) {
  Ping ping = labelled.ping;
  ping.reading.variance = ping.reading.variance.cwiseProduct(labelled.variance) / stated_factor;
  return ping;
}

Output filtered(const Config& config, double stated_factor, const std::vector<LabelledPing>& pings,
                const std::string& name) {
  const bool oracle = name == kOracle;
  Calibrator calibrator(oracle ? "ckf" : name, oracle ? oracleConfig(config) : config);
  Output output;
  for (const auto& labelled : pings) {
    const Ping ping = oracle ? withTrueVariance(labelled, stated_factor) : labelled.ping;
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

Output fitted(const Config& config, const std::vector<LabelledPing>& pings, const Fitter& fitter) {
  Problem problem{Model(config.mode), config.prior, {}, Vector<kChannels>::Ones()};
  for (const auto& labelled : pings) {
    problem.pings.push_back(labelled.ping);
    problem.pings.back().reading = problem.model.convert(labelled.ping.reading);
  }
  Output output;
  const double begin = cpuSeconds();
  const Fit fit = fitter(problem, config.fit);
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

bool isEstimator(const std::string& name, const FitterFactory& fitters) {
  const auto& filters = filterNames();
  return name == kOracle || std::find(filters.begin(), filters.end(), name) != filters.end() ||
         (fitters && fitters(name));
}

Output estimate(const Config& config, const Scenario& scenario, const std::vector<LabelledPing>& pings,
                const std::string& name, const FitterFactory& fitters) {
  const Fitter fitter = fitters ? fitters(name) : Fitter();
  return fitter ? fitted(config, pings, fitter) : filtered(config, scenario.stated_factor, pings, name);
}

}  // namespace sas_motion::usbl

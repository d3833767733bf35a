// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/usbl/comparison.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "sas_motion/math/angles.hpp"
#include "sas_motion/math/statistics.hpp"

namespace sas_motion::usbl {
namespace {

constexpr double kAgree = 0.99;        // probability of the agreement limit
constexpr double kFarFromPrior = 4;    // in the prior's sigmas: gives a warning
constexpr double kNoiseMisStated = 7;  // noise over the stated sigma: gives a warning
constexpr double kNoiseAbsurd = 30;    // noise over the stated sigma: contradicts the answer
constexpr double kManyOutliers = 0.3;  // of a channel: gives a warning
constexpr double kMostOutliers = 0.5;  // of a channel: contradicts the answer

/// Runs a filter over the pings; its noise before the start is that at the start.
Estimated runFilter(const std::string& name, const std::vector<Ping>& pings, const Config& config) {
  Estimated result;
  result.name = name;
  Calibrator calibrator(name, config);
  for (std::size_t i = 0; i < pings.size(); ++i) {
    calibrator.process(pings[i]);
    if (!calibrator.started()) continue;
    const auto& belief = calibrator.belief();
    result.trace.push_back({pings[i].stamp, belief.mean, belief.covariance.diagonal().cwiseSqrt()});
    result.noise.resize(i + 1, calibrator.noiseFactor().cwiseSqrt());
  }
  result.lock_ins = calibrator.lockIns();
  if (!calibrator.started()) {
    result.failure = fmt::format("{} did not start: it needs {} s of pings, and there are {}", name,
                                 config.start_window, pings.size());
    return result;
  }
  result.x = Model::widened(calibrator.belief().mean);
  result.x.tail<kUnknowns - kStates>() = config.prior.mean.tail<kUnknowns - kStates>();
  result.covariance.topLeftCorner<kStates, kStates>() = calibrator.belief().covariance;
  return result;
}

Estimated runFitter(const std::string& name, const Fitter& fitter, const Problem& problem, const Config& config) {
  const Fit found = fitter(problem, config.fit);
  const std::vector<Vector<kChannels>> noise(problem.pings.size(), found.scale);
  return {name, found.x, found.covariance, noise, {}, 0, found.failure.empty() ? "" : name + ": " + found.failure};
}

bool beyondTheMounting(const Prior& prior) {
  return std::any_of(prior.estimated.begin() + kStates, prior.estimated.end(), [](bool b) { return b; });
}

/// The index of the answer; estimates.size() where there is none.
std::size_t answerOf(const std::vector<Estimated>& estimates, const Config& config) {
  const std::string preferred = beyondTheMounting(config.prior) ? "batch" : "hvbckf";
  for (const auto& name : {preferred, std::string("batch")})
    for (std::size_t i = 0; i < estimates.size(); ++i)
      if (estimates[i].name == name && estimates[i].failure.empty()) return i;
  return estimates.size();
}

double distanceBetween(const Estimated& a, const Estimated& b) {
  const State apart = (a.x - b.x).head<kStates>();
  const Matrix<kStates> covariance = (a.covariance + b.covariance).topLeftCorner<kStates, kStates>();
  return apart.dot(covariance.llt().solve(apart));
}

/// The median over time of a channel's noise.
double medianNoise(const Estimated& estimated, int channel) {
  std::vector<double> values;
  values.reserve(estimated.noise.size());
  for (const auto& noise : estimated.noise) values.push_back(noise(channel));
  return quantile(std::move(values), 0.5);
}

/// Swapped axes, wrong units and wrong clocks make most readings of a channel contradict any answer.
std::string implausibility(const Comparison& comparison) {
  const auto channels = channelNames(comparison.problem.model.mode());
  for (int i = 0; i < kChannels; ++i) {
    const ChannelStatistics statistics = channelStatistics(comparison, comparison.best(), i);
    const bool contradicted =
        static_cast<double>(statistics.outliers) > kMostOutliers * static_cast<double>(statistics.count);
    if (contradicted || statistics.noise > kNoiseAbsurd)
      return fmt::format(
          "the readings of {} contradict the answer ({} of {} are outliers, the noise is {:.2g} times the stated one): "
          "check axes, units and clocks",
          channels[i], statistics.outliers, statistics.count, statistics.noise);
  }
  return "";
}

std::vector<std::string> warningsOf(const Comparison& comparison) {
  const auto channels = channelNames(comparison.problem.model.mode());
  const Prior& prior = comparison.problem.prior;
  std::vector<std::string> warnings;
  for (int i = 0; i < kUnknowns; ++i) {
    const double away = std::abs(comparison.best().x(i) - prior.mean(i)) / prior.sigma(i);
    if (prior.estimated[i] && away > kFarFromPrior)
      warnings.push_back(
          fmt::format("{} lies {:.0f} standard deviations from what was expected: check the axes, or give a nominal "
                      "mounting or a wider prior",
                      unknownNames()[i], away));
  }
  for (int i = 0; i < kChannels; ++i) {
    const ChannelStatistics statistics = channelStatistics(comparison, comparison.best(), i);
    if (statistics.count == 0) continue;
    if (statistics.noise > kNoiseMisStated || statistics.noise < 1 / kNoiseMisStated)
      warnings.push_back(
          fmt::format("the noise of {} is {:.2g} times the stated one: check what the driver states, and the axes",
                      channels[i], statistics.noise));
    if (static_cast<double>(statistics.outliers) > kManyOutliers * static_cast<double>(statistics.count))
      warnings.push_back(
          fmt::format("{} of {} readings of {} are outliers", statistics.outliers, statistics.count, channels[i]));
  }
  return warnings;
}

}  // namespace

double agreementLimit() { return chiSquaredQuantile(kAgree, kStates); }

std::vector<std::string> estimatorNames() {
  std::vector<std::string> names = filterNames();
  names.insert(names.end(), {"batch", "gnc"});
  return names;
}

std::array<std::string, kChannels> channelNames(Mode mode) {
  const bool angles = mode == Mode::AzimuthElevation || mode == Mode::Azimuth;
  return angles ? std::array<std::string, kChannels>{"range", "azimuth", "elevation"}
                : std::array<std::string, kChannels>{"range", "to_starboard", "to_forward"};
}

Comparison compare(const std::vector<Ping>& pings, const Config& config, const std::vector<std::string>& names,
                   const FitterFactory& fitters, const std::function<void()>& progress) {
  Comparison result{
      {Model(config.mode), config.prior, pings, Vector<kChannels>::Ones()}, {}, 0, {}, 0, true, "", {}, ""};
  for (auto& ping : result.problem.pings) ping.reading = result.problem.model.convert(ping.reading);
  std::vector<std::string> all;
  for (const auto& name : names)
    if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
  if (std::find(all.begin(), all.end(), "batch") == all.end()) all.emplace_back("batch");
  for (const auto& name : all) {
    const Fitter fitter = fitters(name);
    result.estimates.push_back(fitter ? runFitter(name, fitter, result.problem, config)
                                      : runFilter(name, pings, config));
    progress();
  }
  result.answer = answerOf(result.estimates, config);
  if (result.answer == result.estimates.size()) {
    for (const auto& estimated : result.estimates)
      result.failure += (result.failure.empty() ? "" : "; ") + estimated.failure;
    return result;
  }
  for (int i = 0; i < kChannels; ++i) result.problem.scale(i) = medianNoise(result.best(), i);
  result.observability = observability(result.problem, result.best().x);
  for (const auto& estimated : result.estimates)
    if (estimated.name == "batch" && estimated.failure.empty())
      result.distance = distanceBetween(result.best(), estimated);
  result.agrees = result.distance < agreementLimit();
  result.implausible = implausibility(result);
  result.warnings = warningsOf(result);
  return result;
}

Vector<kChannels> whitenedResidual(const Comparison& comparison, const Estimated& estimated, std::size_t ping) {
  Problem at{comparison.problem.model, comparison.problem.prior, {}, estimated.noise[ping]};
  return normalisedResidual(at, comparison.problem.pings[ping], estimated.x);
}

ChannelStatistics channelStatistics(const Comparison& comparison, const Estimated& estimated, int channel) {
  ChannelStatistics result;
  if (estimated.noise.size() != comparison.problem.pings.size()) return result;
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < comparison.problem.pings.size(); ++i) {
    const Reading& reading = comparison.problem.pings[i].reading;
    if (!reading.has(channel)) continue;
    ++result.count;
    const double whitened = whitenedResidual(comparison, estimated, i)(channel);
    const double residual = whitened * estimated.noise[i](channel) * std::sqrt(reading.variance(channel));
    if (std::abs(whitened) > kOutlier) {
      ++result.outliers;
      continue;
    }
    sum += residual;
    squares += residual * residual;
  }
  const auto kept = static_cast<double>(result.count - result.outliers);
  if (kept > 0) {
    result.mean = sum / kept;
    result.rms = std::sqrt(squares / kept);
  }
  result.noise = medianNoise(estimated, channel);
  return result;
}

}  // namespace sas_motion::usbl

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/usbl/calibrator.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sas_motion/math/statistics.hpp"

namespace sas_motion::usbl {
namespace {

constexpr double kContradiction = 1 - 1e-6;  // probability that a good filter's distance from a fit is below the limit
constexpr std::size_t kFewestPings = 10;     // of a start

Gaussian<kStates> filterPart(const Unknowns& mean, const Matrix<kUnknowns>& covariance) {
  return {mean.head<kStates>(), covariance.topLeftCorner<kStates, kStates>()};
}

AdaptiveCubatureOptions optionsOf(const std::string& name, const Config& config) {
  if (const auto options = filterOptions(name, config)) return *options;
  throw std::invalid_argument(
      fmt::format("'{}' is no calibration filter; choose one of {}", name, fmt::join(filterNames(), ", ")));
}

}  // namespace

const std::vector<std::string>& filterNames() {
  static const std::vector<std::string> names{"ckf", "vbckf", "hckf", "hvbckf", "student_t_vbckf", "mc_vbckf"};
  return names;
}

std::optional<AdaptiveCubatureOptions> filterOptions(const std::string& name, const Config& config) {
  AdaptiveCubatureOptions options = config.cubature;
  options.adaptive = name != "ckf" && name != "hckf";
  options.calibrate = true;
  if (name == "ckf" || name == "vbckf") {
    options.loss.reset();
    options.calibrate = false;
  } else if (name == "hckf" || name == "hvbckf") {
    options.loss = config.huber;
  } else if (name == "student_t_vbckf") {
    options.loss = Loss(LossKind::Cauchy, std::sqrt(config.student_t_nu));
    options.peak = (config.student_t_nu + 1) / config.student_t_nu;
    options.increment = NoiseIncrement::Weighted;  // E[lambda] r^2, what the t density's own scale takes [Piche2012]
  } else if (name == "mc_vbckf") {
    options.loss = Loss(LossKind::Welsch, config.correntropy_bandwidth * std::sqrt(2.0));
  } else {
    return std::nullopt;
  }
  return options;
}

Calibrator::Calibrator(const std::string& filter, const Config& config)
    : config_(config), options_(optionsOf(filter, config)), model_(config.mode), filter_(options_) {
  const Matrix<kUnknowns> covariance = config.prior.sigma.cwiseAbs2().asDiagonal();
  belief_ = CubatureFilter::Belief(filterPart(config.prior.mean, covariance));
}

Vector<kChannels> Calibrator::noiseFactor() const {
  return options_.adaptive ? belief_.noise.factor(options_.trend) : Vector<kChannels>(Vector<kChannels>::Ones());
}

Calibrator::Report Calibrator::process(const Ping& raw) {
  Report report;
  report.belief = belief_;
  report.verdict = Verdict::Invalid;
  Ping ping = raw;
  ping.reading = model_.convert(raw.reading);
  Vector<kChannels> present, z, variance;
  for (int i = 0; i < kChannels; ++i) {
    present(i) = ping.reading.has(i);
    z(i) = ping.reading.has(i) ? ping.reading.value(i) : 0;
    variance(i) = ping.reading.has(i) ? ping.reading.variance(i) : 1;
  }
  if (present.isZero(0) || !ping.C_body_map.allFinite() || !ping.transponder_map.allFinite()) return report;
  if (recent_.empty()) first_ = checked_ = ping.stamp;
  recent_.push_back(ping);
  while (secondsBetween(recent_.front().stamp, ping.stamp) > std::max(config_.start_window, config_.check_window))
    recent_.pop_front();

  if (!started_ && config_.start_window > 0) {
    if (secondsBetween(first_, ping.stamp) < config_.start_window || recent_.size() < kFewestPings) return report;
    const Problem problem = window(config_.start_window);
    const Fit found = fit(problem, config_.fit);
    if (found.failure.empty()) startFrom(problem, found);
    report.belief = belief_;
    return report;
  }
  started_ = true;
  const Matrix<kStates> Q = config_.drift.cwiseAbs2().asDiagonal();
  const auto h = [&](const State& x) { return model_.predict(x, ping); };
  report =
      filter_.update(filter_.predict(belief_, Q), z, variance, present, h,
                     [&](const Vector<kChannels>& y, const Vector<kChannels>& x) { return model_.difference(y, x); });
  if (report.verdict == Verdict::Invalid) return report;
  belief_ = report.belief;
  if (config_.check_window > 0 && secondsBetween(checked_, ping.stamp) >= config_.check_window) {
    checked_ = ping.stamp;
    checkLockIn();
  }
  return report;
}

Problem Calibrator::window(double seconds) const {
  Problem problem{model_, config_.prior, {}, Vector<kChannels>::Ones()};
  for (int i = kStates; i < kUnknowns; ++i) problem.prior.estimated[i] = false;
  for (const auto& ping : recent_)
    if (secondsBetween(ping.stamp, recent_.back().stamp) <= seconds) problem.pings.push_back(ping);
  return problem;
}

void Calibrator::startFrom(const Problem& problem, const Fit& fit) {
  Problem scaled = problem;
  if (options_.adaptive) scaled.scale = fit.scale;
  const Matrix<kUnknowns> own = covarianceFrom(information(scaled, fit.x), problem.prior);
  belief_ = CubatureFilter::Belief(filterPart(fit.x, own));
  if (options_.calibrate) belief_.state.covariance = fit.covariance.topLeftCorner<kStates, kStates>();
  if (options_.adaptive) belief_.noise = VariationalNoise<kChannels>(fit.scale.cwiseAbs2());
  started_ = true;
}

/// After an accepted outlier a filter attributes later pings to noise, with a small covariance; a fit of those pings
/// alone shows the contradiction.
void Calibrator::checkLockIn() {
  const Problem problem = window(config_.check_window);
  const Fit found = fit(problem, config_.fit);
  if (!found.failure.empty()) return;
  const State apart = found.x.head<kStates>() - belief_.state.mean;
  const Matrix<kStates> covariance = belief_.state.covariance + found.covariance.topLeftCorner<kStates, kStates>();
  if (apart.dot(covariance.llt().solve(apart)) < chiSquaredQuantile(kContradiction, kStates)) return;
  ++lock_ins_;
  startFrom(problem, found);
}

}  // namespace sas_motion::usbl

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sas_motion/config/yaml_loss.hpp"
#include "sas_motion/math/angles.hpp"
#include "sas_motion/systems/usbl/calibrator.hpp"
#include "sas_motion/systems/usbl/ping_builder.hpp"

namespace sas_motion::usbl {
namespace {

/// Reads one of the names of an enumeration's values.
template <class Enum>
Enum choice(YamlSection& yaml, const std::string& key, const std::vector<std::string>& names, Enum now) {
  std::string name = names[static_cast<std::size_t>(now)];
  yaml.text(key, name);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) yaml.fail(key, fmt::format("is '{}' but must be one of {}", name, fmt::join(names, ", ")));
  return static_cast<Enum>(found - names.begin());
}

/// Reads three numbers in `unit`, each at least `lower`.
template <class Part>
void readThree(YamlSection& yaml, const std::string& key, Part&& part, double unit, double lower) {
  std::vector<double> numbers{part(0) / unit, part(1) / unit, part(2) / unit};
  yaml.numbers(key, numbers, 3);
  if (*std::min_element(numbers.begin(), numbers.end()) < lower)
    yaml.fail(key,
              fmt::format("must be numbers {}", lower == kTiny ? "above 0" : fmt::format("of at least {}", lower)));
  for (int i = 0; i < 3; ++i) part(i) = numbers[i] * unit;
}

constexpr double kAny = -1e9;

void readPrior(YamlSection yaml, Prior& prior) {
  readThree(yaml, "mounting_deg", prior.mean.segment<3>(kMountingX), kRadPerDeg, kAny);
  readThree(yaml, "mounting_sigma_deg", prior.sigma.segment<3>(kMountingX), kRadPerDeg, kTiny);
  readThree(yaml, "lever_arm", prior.mean.segment<3>(kLeverX), 1, kAny);
  readThree(yaml, "lever_arm_sigma", prior.sigma.segment<3>(kLeverX), 1, kTiny);
  readThree(yaml, "transponder_sigma", prior.sigma.segment<3>(kTransponderX), 1, kTiny);
  yaml.number("range_scale_sigma", prior.sigma(kRangeScale), {kTiny, 0.1});
  yaml.finish();
}

void readEstimate(YamlSection yaml, Prior& prior) {
  bool transponder = prior.estimated[kTransponderX], scale = prior.estimated[kRangeScale];
  yaml.boolean("transponder", transponder);
  yaml.boolean("range_scale", scale);
  yaml.finish();
  for (const auto i : {kTransponderX, kTransponderY, kTransponderZ}) prior.estimated[i] = transponder;
  prior.estimated[kRangeScale] = scale;
}

void readFit(YamlSection yaml, FitOptions& fit) {
  readLoss(yaml, fit.loss);
  yaml.boolean("estimate_scale", fit.estimate_scale);
  yaml.integer("max_iterations", fit.max_iterations, 1, 100000);
  yaml.number("tolerance", fit.tolerance, {kTiny, 1});
  yaml.finish();
}

void readFilters(YamlSection yaml, Config& config) {
  AdaptiveCubatureOptions& cubature = config.cubature;
  yaml.number("start_window", config.start_window, {0, 1e6});
  yaml.number("check_window", config.check_window, {0, 1e6});
  double tuning = config.huber.tuning();
  yaml.number("huber_tuning", tuning, {kTiny, 1e9});
  config.huber = Loss(LossKind::Huber, tuning);
  yaml.number("student_t_nu", config.student_t_nu, {0.1, 1e6});
  yaml.number("correntropy_bandwidth", config.correntropy_bandwidth, {kTiny, 1e9});
  cubature.reweighting = choice(yaml, "reweighting", {"covariance", "observation"}, cubature.reweighting);
  cubature.increment =
      choice(yaml, "increment", {"raw", "weighted", "pseudo", "consistent", "mixture"}, cubature.increment);
  yaml.integer("iterations", cubature.iterations, 1, 1000);
  yaml.number("tolerance", cubature.tolerance, {kTiny, 1});
  yaml.number("rho", cubature.rho, {0.5, 1});
  yaml.number("trend", cubature.trend, {0, 1});
  yaml.number("clamp", cubature.clamp, {1, 1e9});
  readThree(yaml, "drift_deg", config.drift.segment<3>(kMountingX), kRadPerDeg, 0);
  readThree(yaml, "drift_lever_arm", config.drift.segment<3>(kLeverX), 1, 0);
  yaml.finish();
}

}  // namespace

void readConfig(YamlSection& yaml, Config& config) {
  config.mode = choice(yaml, "mode", modeNames(), config.mode);
  readPrior(yaml.section("prior"), config.prior);
  readEstimate(yaml.section("estimate"), config.prior);
  readFit(yaml.section("fit"), config.fit);
  readFilters(yaml.section("filters"), config);
}

void readConfig(YamlSection yaml, PingBuilderOptions& options) {
  yaml.number("attitude_gap", options.attitude_gap, {kTiny, 60});
  yaml.number("position_gap", options.position_gap, {kTiny, 60});
  yaml.number("wait", options.wait, {0, 3600});
  yaml.finish();
}

}  // namespace sas_motion::usbl

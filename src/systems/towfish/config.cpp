// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sas_motion::towfish {
namespace {

void readLoss(YamlSection& yaml, Loss& loss) {
  std::string name = lossName(loss.kind());
  yaml.text("loss", name);
  LossKind kind{};
  try {
    kind = lossFromName(name);
  } catch (const std::invalid_argument& error) {
    yaml.fail("loss", std::string("names no loss: ") + error.what());
  }
  double tuning = kind == loss.kind() ? loss.tuning() : Loss::defaultTuning(kind);
  yaml.number("tuning", tuning, {kTiny, 1e9});
  loss = Loss(kind, tuning);
}

/// How much a measurement weighs. A turn rate is an input of the motion and has no weight.
void readWeight(YamlSection& yaml, Sensor sensor, SensorOptions& options) {
  if (sensor == Sensor::TurnRate) {
    for (const char* key : {"sigma_deg", "floor_deg", "override_message"})
      if (yaml.has(key))
        yaml.fail(key, "would have no effect; set model.heading_noise_deg, which holds the error of the turn rate");
    return;
  }
  if (sensor == Sensor::Heading) {
    yaml.angle("sigma_deg", options.sigma, {kTiny, 180});
    yaml.angle("floor_deg", options.floor, {0, 180});
  } else {
    yaml.number("sigma", options.sigma, {kTiny, 1e4});
    yaml.number("floor", options.floor, {0, 1e4});
  }
  yaml.boolean("override_message", options.override_message);
}

void readSensor(YamlSection yaml, Sensor sensor, SensorOptions& options) {
  readWeight(yaml, sensor, options);
  yaml.number("time_offset", options.time_offset, {-3600, 3600});
  yaml.boolean("enabled", options.enabled);
  yaml.finish();
}

void readRobust(YamlSection yaml, RobustKalmanFilter<kStates>::Options& options) {
  readLoss(yaml, options.loss);
  yaml.integer("max_iterations", options.max_iterations, 1, 1000);
  yaml.number("tolerance", options.tolerance, {kTiny, 1});
  yaml.boolean("robustify_process", options.robustify_process);
  yaml.boolean("calibrate", options.calibrate);
  yaml.finish();
}

/// Maximum correntropy is the robust filter with a Gaussian kernel exp(-r^2 / 2 sigma^2) on both parts: Welsch's loss
/// with c = sigma sqrt(2).
void readCorrentropy(YamlSection yaml, RobustKalmanFilter<kStates>::Options& options) {
  double bandwidth = options.loss.tuning() / std::sqrt(2.0);
  yaml.number("bandwidth", bandwidth, {kTiny, 1e9});
  yaml.integer("max_iterations", options.max_iterations, 1, 1000);
  yaml.number("tolerance", options.tolerance, {kTiny, 1});
  yaml.finish();
  options.loss = Loss(LossKind::Welsch, bandwidth * std::sqrt(2.0));
}

void readFour(YamlSection& yaml, const std::string& key, std::array<double, 4>& values, double lower) {
  std::vector<double> numbers(values.begin(), values.end());
  yaml.numbers(key, numbers, values.size());
  if (*std::min_element(numbers.begin(), numbers.end()) < lower)
    yaml.fail(key, fmt::format("must be numbers of at least {}", lower));
  std::copy(numbers.begin(), numbers.end(), values.begin());
}

void readMixture(YamlSection yaml, MixtureKalmanFilter<kStates>::Options& options) {
  readFour(yaml, "scales", options.scales, kTiny);
  readFour(yaml, "probabilities", options.probabilities, 0);
  if (*std::max_element(options.probabilities.begin(), options.probabilities.end()) == 0)
    yaml.fail("probabilities", "must not all be 0");
  yaml.finish();
}

void readBank(YamlSection yaml, BankKalmanFilter<kStates>::Options& options) {
  yaml.number("epoch", options.epoch, {1e-3, 3600});
  yaml.number("jump_probability", options.jump_probability, {1e-6, 0.199});
  yaml.number("jump_scale", options.jump_scale, {1, 1e6});
  readFour(yaml, "scales", options.scales, kTiny);
  readFour(yaml, "probabilities", options.probabilities, kTiny);
  yaml.number("sticky", options.sticky, {0, 0.99});
  yaml.number("repeat", options.repeat, {0, 1});
  yaml.number("burst", options.burst, {0, 1e6});
  yaml.number("patience", options.patience, {kTiny, 1e6});
  yaml.finish();
}

void readSmoother(YamlSection yaml, SmootherOptions& options) {
  readLoss(yaml, options.loss);
  yaml.integer("max_iterations", options.max_iterations, 1, 10000);
  yaml.number("tolerance", options.tolerance, {0, 1});
  yaml.finish();
}

void readEstimators(YamlSection yaml, Config& config) {
  yaml.section("kf").finish();
  readRobust(yaml.section("robust_kf"), config.robust_kf);
  readCorrentropy(yaml.section("mckf"), config.mckf);
  auto student = yaml.section("student_t_kf");
  student.number("degrees_of_freedom", config.student_t_kf.degrees_of_freedom, {kTiny, 1e9});
  student.integer("max_iterations", config.student_t_kf.max_iterations, 1, 1000);
  student.number("tolerance", config.student_t_kf.tolerance, {kTiny, 1});
  student.boolean("calibrate", config.student_t_kf.calibrate);
  student.finish();
  auto gated = yaml.section("gated_kf");
  gated.number("probability", config.gated_kf.probability, {0.5, 0.999999});
  gated.finish();
  readMixture(yaml.section("mixture_kf"), config.mixture_kf);
  readBank(yaml.section("bank_kf"), config.bank_kf);
  readSmoother(yaml.section("rts"), config.rts);
  readSmoother(yaml.section("batch"), config.batch);
  auto gnc = yaml.section("gnc");
  gnc.number("probability", config.gnc_probability, {0.5, 0.999999});
  gnc.finish();
  auto fixed_lag = yaml.section("fixed_lag");
  readLoss(fixed_lag, config.fixed_lag.loss);
  fixed_lag.number("lag", config.fixed_lag.lag, {0.1, 3600});
  fixed_lag.number("solve_interval", config.fixed_lag.solve_interval, {0, 60});
  fixed_lag.number("reorder", config.fixed_lag.reorder, {0, 60});
  fixed_lag.finish();
  yaml.finish();
}

}  // namespace

Config::Config() {
  sensor(Sensor::Position) = {1.0, 0.01, false, 0, true};
  sensor(Sensor::Heading) = {0.5 * kRadPerDeg, 0.01 * kRadPerDeg, false, 0, true};
  sensor(Sensor::Speed) = {0.05, 0.001, false, 0, true};
  sensor(Sensor::TurnRate) = {0.1 * kRadPerDeg, 0, false, 0, true};
  robust_kf.loss = Loss(LossKind::Huber);
  mckf.loss = Loss(LossKind::Welsch, 5 * std::sqrt(2.0));
  mckf.robustify_process = true;
}

void readMotionParameters(YamlSection yaml, MotionParameters& p) {
  yaml.number("current_sigma", p.current_sigma, {kTiny, 100});
  yaml.number("current_time_constant", p.current_time_constant, {kTiny, 1e7});
  yaml.angle("heading_noise_deg", p.heading_noise, {kTiny, 180});
  yaml.number("speed_noise", p.speed_noise, {kTiny, 100});
  yaml.number("position_noise", p.position_noise, {kTiny, 100});
  yaml.finish();
}

void readConfig(YamlSection& yaml, Config& config) {
  readMotionParameters(yaml.section("model"), config.model);
  auto sensors = yaml.section("sensors");
  for (int i = 0; i < kSensors; ++i) {
    const auto sensor = static_cast<Sensor>(i);
    readSensor(sensors.section(sensorName(sensor)), sensor, config.sensor(sensor));
  }
  sensors.finish();
  auto start = yaml.section("start");
  start.number("window", config.start.window, {0, 3600});
  start.number("position_sigma", config.start.position_sigma, {kTiny, 1e6});
  start.angle("heading_sigma_deg", config.start.heading_sigma, {kTiny, 180});
  start.number("speed_sigma", config.start.speed_sigma, {kTiny, 100});
  start.finish();
  yaml.number("lag", config.lag, {0, 3600});
  yaml.number("reset_after", config.reset_after, {kTiny, 1e6});
  yaml.number("max_gap", config.max_gap, {kTiny, 1e6});
  yaml.number("input_hold", config.input_hold, {0, 3600});
  yaml.angle("turn_rate_limit_deg", config.turn_rate_limit, {kTiny, 3600});
  if (config.start.window > config.lag)
    yaml.fail("start.window",
              fmt::format("is {} but must be at most lag, which is {}", config.start.window, config.lag));
  readEstimators(yaml.section("estimators"), config);
}

}  // namespace sas_motion::towfish

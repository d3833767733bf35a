// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/towfish/reference_estimators.hpp"

#include <algorithm>

#include "sas_motion/evaluation/law_aware.hpp"
#include "sas_motion/io/cpu_time.hpp"
#include "sas_motion/systems/towfish/filter_estimator.hpp"

namespace sas_motion::towfish {
namespace {

/// The model's motion, simulated step by simulated step where the noise of one was not the good one.
Motion trueMotion(const Model& model, const SimulatedRun& run) {
  return [model, &run](const StateVector& mean, const Input& input, Stamp from, Stamp to) {
    const auto good = [&](std::size_t k) {
      return run.processVariance().empty() || run.processVariance()[k] == StateVector::Ones();
    };
    bool all_good = true;
    for (std::size_t k = run.index(from) + 1; k <= run.index(to); ++k) all_good &= good(k);
    if (all_good) return model.transition(mean, input, secondsBetween(from, to));
    Transition<kStates> whole{mean, StateMatrix::Identity(), StateMatrix::Zero()};
    for (std::size_t k = run.index(from) + 1; k <= run.index(to); ++k) {
      const auto step = model.transition(whole.mean, input, secondsBetween(0, run.step()));
      whole.mean = step.mean;
      whole.F = (step.F * whole.F).eval();
      whole.Q =
          (step.F * whole.Q * step.F.transpose() + covarianceWith<kStates>(step.Q, run.processVariance()[k])).eval();
    }
    return whole;
  };
}

/// Updates a second of the fastest sensor.
double fastestRate(const Scenario& scenario) {
  double rate = 1 / scenario.duration;
  for (const auto sensor : noisySensors()) rate = std::max(rate, scenario.sensor(sensor).rate);
  return rate;
}

std::unique_ptr<Estimator> makeOracle(const Config& config, const SimulatedRun& run) {
  using Filter = KalmanFilter<kStates>;
  return std::make_unique<FilterEstimator<Filter>>([](const Config&) { return Filter(); }, config,
                                                   trueMotion(Model(config.model), run));
}

/// The reading with the variance that it was drawn with.
Measurement withTrueVariance(const LabelledMeasurement& labelled) {
  Measurement z = labelled.z;
  for (int row = 0; row < 2; ++row) z.variance(row) *= labelled.variance[static_cast<std::size_t>(row)];
  return z;
}

/// The position's law stands for all sensors; only rows that have it have its spells.
std::unique_ptr<Estimator> makeBayesReference(const Config& config, const Scenario& scenario) {
  const auto& law = scenario.sensor(Sensor::Position).noise;
  auto options = lawAware(law, scenario.process, 1 / fastestRate(scenario));
  options.mode.common = true;
  options.mode.rows = 0;
  for (const auto sensor : noisySensors())
    if (scenario.sensor(sensor).noise.name() == law.name())
      for (int row = 0; row < rowsOf(sensor); ++row)
        options.mode.rows |= std::uint64_t{1} << (4 * static_cast<unsigned>(sensor) + static_cast<unsigned>(row));
  using Filter = GaussianSumFilter<kStates>;
  return std::make_unique<FilterEstimator<Filter>>([options](const Config&) { return Filter(options); }, config);
}

}  // namespace

double estimate(const Config& config, const Scenario& scenario, const SimulatedRun& run, const std::string& name,
                const EstimatorFactory& make, const Listener& listen) {
  constexpr std::size_t kPart = 256;  // measurements
  const bool oracle = name == kOracle;
  auto estimator = oracle                    ? makeOracle(config, run)
                   : name == kBayesReference ? makeBayesReference(config, scenario)
                                             : make(name, config);
  Timeline<Estimator> timeline(std::move(estimator), config, config.max_gap, false);
  Output output;
  double seconds = 0, begin = cpuSeconds();
  const auto hand_over = [&] {
    seconds += cpuSeconds() - begin;
    listen(output);
    output.clear();
    begin = cpuSeconds();
  };
  std::size_t taken = 0;
  for (const auto& labelled : run.measurements()) {
    timeline.process(oracle ? withTrueVariance(labelled) : labelled.z, output);
    if (++taken % kPart == 0) hand_over();
  }
  timeline.finish(output);
  hand_over();
  return seconds;
}

}  // namespace sas_motion::towfish

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/towfish/reference_estimators.hpp"

#include <algorithm>

#include "sas_motion/evaluation/law_aware.hpp"
#include "sas_motion/systems/towfish/filter_timeline.hpp"

namespace sas_motion::towfish {
namespace {

/// The model's motion, simulated step by simulated step where the noise of one was not the good one.
Motion toldMotion(const Model& model, const SimulatedRun& run) {
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
          (step.F * whole.Q * step.F.transpose() + toldCovariance<kStates>(step.Q, run.processVariance()[k])).eval();
    }
    return whole;
  };
}

/// Updates a second of the fastest sensor.
double fastestRate(const Scenario& scenario) {
  double rate = 1 / scenario.duration;
  for (const auto sensor : kNoisy) rate = std::max(rate, scenario.sensor(sensor).rate);
  return rate;
}

}  // namespace

std::unique_ptr<Estimator> makeOracle(const Campaign& campaign, const SimulatedRun& run) {
  using Filter = KalmanFilter<kStates>;
  return std::make_unique<FilterTimeline<Filter>>([](const Config&) { return Filter(); }, campaign.config,
                                                  toldMotion(Model(campaign.config.model), run));
}

Measurement toldTheTruth(const LabelledMeasurement& labelled) {
  Measurement z = labelled.z;
  for (int row = 0; row < 2; ++row) z.variance(row) *= labelled.variance[static_cast<std::size_t>(row)];
  return z;
}

std::unique_ptr<Estimator> makeBayesReference(const Campaign& campaign, const Scenario& scenario) {
  const auto& law = scenario.sensor(Sensor::Position).noise;
  auto options = lawAware(law, scenario.process, 1 / fastestRate(scenario));
  options.mode.common = true;
  options.mode.rows = 0;
  for (const auto sensor : kNoisy)
    if (scenario.sensor(sensor).noise.name() == law.name())
      for (int row = 0; row < rowsOf(sensor); ++row)
        options.mode.rows |= 1U << (4 * static_cast<unsigned>(sensor) + static_cast<unsigned>(row));
  using Filter = GaussianSumFilter<kStates>;
  return std::make_unique<FilterTimeline<Filter>>([options](const Config&) { return Filter(options); },
                                                  campaign.config);
}

}  // namespace sas_motion::towfish

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/evaluation/information.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "evaluation/noise_density.hpp"
#include "sas_motion/noise/noise_source.hpp"

namespace sas_motion {
namespace {

using Kind = NoiseLaw::Kind;

bool hasSpells(const NoiseLaw& law) {
  return law.kind == Kind::Burst || law.kind == Kind::Step || law.kind == Kind::Ramp || law.kind == Kind::Frozen;
}

}  // namespace

MeasurementInformation::MeasurementInformation(const NoiseMix& mix) {
  spells_ = std::any_of(mix.laws.begin(), mix.laws.end(), hasSpells);
  genie_ = spells_;
  NoiseDensity density;
  double quantum = 0;
  for (const auto& law : mix.laws) {
    if (law.kind == Kind::Contaminated) density.contaminate(law.epsilon, law.K);
    if (law.kind == Kind::StudentT) density.studentise(law.nu);
    if (law.kind == Kind::Multipath && !spells_ &&
        !density.delay(law.probability, law.mean))  // beside spells, the genie knows it too
      throw std::invalid_argument("MeasurementInformation: a list of laws can have one multipath");
    if (law.kind == Kind::Correlated) density.scale(std::sqrt(1 - law.share));
    if (law.kind == Kind::Varying) varying_.push_back(law);
    if (law.kind == Kind::Quantised) quantum = law.quantum;
    genie_ |= law.kind == Kind::Correlated || law.kind == Kind::Varying;
  }
  factor_ = density.information(quantum);
}

double MeasurementInformation::of(double true_variance, double time) const {
  if (spells_ && true_variance >= kNoInformation) return 0;
  double factor = factor_;
  for (const auto& law : varying_) factor /= varyingSigma(law, time) * varyingSigma(law, time);
  return factor;
}

ProcessInformation processInformation(const NoiseMix& mix, int states, double step) {
  ProcessInformation result;
  NoiseDensity common, own;
  for (const auto& law : mix.laws) {
    const bool lasts = law.kind == Kind::Manoeuvre || law.kind == Kind::Burst || law.epoch > 1.000001 * step;
    if (lasts) result.genie = true;
    if (lasts) continue;
    if (law.kind == Kind::Contaminated) (law.epoch > 0 ? common : own).contaminate(law.epsilon, law.K);
    if (law.kind == Kind::StudentT) own.studentise(law.nu);
  }
  result.factor = common.radialInformation(states) * own.information();
  return result;
}

}  // namespace sas_motion

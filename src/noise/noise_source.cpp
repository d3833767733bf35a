// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/noise/noise_source.hpp"

#include <algorithm>
#include <cmath>

#include "sas_motion/math/angles.hpp"

namespace sas_motion {
namespace {

constexpr double kWide = 9;  // variance of a Student's t draw from which it is labelled an outlier

void scale(NoiseSample& sample, double sigma) {
  sample.value *= sigma;
  sample.variance *= sigma * sigma;
}

void shift(NoiseSample& sample, double bias) {
  sample.value += bias;
  sample.variance = std::max(sample.variance, kSaysNothing);
  sample.outlier = true;
}

}  // namespace

bool Spells::on(const NoiseLaw& law, double time, double elapsed, double dice) {
  const bool was_on = on_;
  if (!was_on && dice < -std::expm1(-law.rate * elapsed)) until_ = time + law.length;
  return on_ = time < until_;
}

double varyingSigma(const NoiseLaw& law, double time) {
  return 1 + (law.factor - 1) * 0.5 * (1 - std::cos(2 * kPi * time / law.period));
}

NoiseSource::NoiseSource(const NoiseMix& mix, std::uint64_t seed, std::uint64_t stream,
                         std::optional<std::uint64_t> spell_stream)
    : random_(seed, stream) {
  for (const auto& law : mix.laws) {
    const std::uint64_t spell = spell_stream.value_or(stream + 500'000) + parts_.size();
    Part part{law, Random(seed, stream + 1000 * (parts_.size() + 1)), Random(seed, spell), {}, 0};
    part.gauss_markov = part.random.gaussian();
    parts_.push_back(part);
  }
}

NoiseSample NoiseSource::draw(double time) {
  NoiseSample sample;
  sample.value = random_.gaussian();
  const double dice = random_.uniform();  // the first law's; it stays in this stream, so that one law alone gives the
                                          // numbers it always gave
  const double elapsed = time - last_time_;
  last_time_ = time;
  for (auto& part : parts_) part.apply(sample, time, elapsed, &part == &parts_.front() ? dice : part.random.uniform());
  return sample;
}

void NoiseSource::Part::apply(NoiseSample& sample, double time, double elapsed, double dice) {
  switch (law.kind) {
    case NoiseLaw::Kind::Gaussian:
    case NoiseLaw::Kind::Manoeuvre: return;  // acts on all states together
    case NoiseLaw::Kind::Contaminated:
      if (dice >= law.epsilon) return;
      scale(sample, law.K);
      sample.outlier = true;
      return;
    case NoiseLaw::Kind::StudentT: {
      const double wide = 0.5 * law.nu / random.gamma(0.5 * law.nu);  // 1 / lambda, lambda ~ chi^2_nu / nu
      scale(sample, std::sqrt(wide));
      sample.outlier |= wide > kWide;
      return;
    }
    case NoiseLaw::Kind::Burst:
      if (spells.on(law, time, elapsed, spell_random.uniform())) shift(sample, law.K);
      return;
    case NoiseLaw::Kind::Step:
      if (time >= law.t0 && time < law.t1) shift(sample, law.bias);
      return;
    case NoiseLaw::Kind::Ramp:
      if (time >= law.t0 && time < law.t1) shift(sample, law.slope * (time - law.t0));
      return;
    case NoiseLaw::Kind::Frozen:
      sample.frozen |= spells.on(law, time, elapsed, spell_random.uniform());
      if (sample.frozen) shift(sample, 0);
      return;
    case NoiseLaw::Kind::Dropout:
      sample.missing |= spells.on(law, time, elapsed, spell_random.uniform()) || random.bernoulli(law.probability);
      return;
    case NoiseLaw::Kind::Multipath:
      if (dice < law.probability) shift(sample, law.mean * random.exponential());
      return;
    case NoiseLaw::Kind::Correlated: {
      const double decay = std::exp(-elapsed / law.time_constant);
      gauss_markov = decay * gauss_markov + std::sqrt(1 - decay * decay) * random.gaussian();
      sample.value = std::sqrt(1 - law.share) * sample.value + std::sqrt(law.share) * gauss_markov;
      sample.variance = (1 - law.share) * sample.variance + law.share;
      return;
    }
    case NoiseLaw::Kind::Varying: scale(sample, varyingSigma(law, time)); return;
    case NoiseLaw::Kind::Quantised:
      sample.quantum = law.quantum;
      sample.variance += law.quantum * law.quantum / 12;
      return;
  }
}

}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/noise/noise_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

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
  sample.variance = std::max(sample.variance, kNoInformation);
  sample.outlier = true;
}

}  // namespace

bool Spells::on(const NoiseLaw& law, double time, double elapsed, double dice) {
  if (!on_ && dice < -std::expm1(-law.rate * elapsed)) until_ = time + law.length;
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
  const double dice = random_.uniform();  // of the first law: a law alone must keep its numbers
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

ProcessNoise::ProcessNoise(const NoiseMix& mix, int states, std::uint64_t seed, std::uint64_t stream) {
  if (states > kMostStates)
    throw std::invalid_argument(fmt::format("ProcessNoise: states is {} but must be at most {}", states, kMostStates));
  NoiseMix own;
  for (const auto& law : mix.laws)
    if (law.kind == NoiseLaw::Kind::Manoeuvre || law.epoch > 0)
      common_.push_back({law, Random(seed, stream + 50 + common_.size()), {}, -1, false});
    else
      own.laws.push_back(law);
  for (int i = 0; i < states; ++i) states_.emplace_back(own, seed, stream + static_cast<std::uint64_t>(i));
}

bool ProcessNoise::Common::on(double time, double elapsed) {
  if (law.kind == NoiseLaw::Kind::Manoeuvre) return spells.on(law, time, elapsed, random.uniform());
  const long now = std::lround(std::ceil(time / law.epoch - 1e-9)) - 1;  // epoch k is the time (k, k + 1] `epoch`
  for (; epoch < now; ++epoch) large = random.bernoulli(law.epsilon);
  return large;
}

ProcessNoise::Draw ProcessNoise::draw(double time) {
  double sigma = 1;
  for (auto& common : common_)
    if (common.on(time, time - last_time_)) sigma *= common.law.K;
  last_time_ = time;
  const auto states = static_cast<Eigen::Index>(states_.size());
  Draw draw{Values(states), Values(states)};
  for (Eigen::Index i = 0; i < states; ++i) {
    const NoiseSample sample = states_[static_cast<std::size_t>(i)].draw(time);
    draw.value(i) = sigma * sample.value;
    draw.variance(i) = sigma * sigma * sample.variance;
  }
  return draw;
}

}  // namespace sas_motion

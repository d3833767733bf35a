// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/noise/process_noise.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace sas_motion {

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
  const long now = std::lround(std::ceil(time / law.epoch - 1e-9)) -
                   1;  // epoch k is the time above k `epoch`, up to and with its end
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

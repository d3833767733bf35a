// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace sas_motion {

/// Names a sequence of random numbers. Each stream, step and item has its own, which depends neither on other draws nor
/// on their order or thread.
struct DrawPlace {
  std::uint32_t stream = 0, step = 0, item = 0;
};

using PhiloxCounter = std::array<std::uint32_t, 4>;
using PhiloxKey = std::array<std::uint32_t, 2>;

/// Encrypts a counter by the ten rounds of Philox4x32-10. [Salmon2011]
inline PhiloxCounter philox(PhiloxCounter counter, PhiloxKey key) {
  constexpr int kRounds = 10;
  for (int round = 0; round < kRounds; ++round) {
    const std::uint64_t even = std::uint64_t{0xD2511F53} * counter[0], odd = std::uint64_t{0xCD9E8D57} * counter[2];
    const auto high = [](std::uint64_t product) { return static_cast<std::uint32_t>(product >> 32); };
    const auto low = [](std::uint64_t product) { return static_cast<std::uint32_t>(product); };
    counter = {high(odd) ^ counter[1] ^ key[0], low(odd), high(even) ^ counter[3] ^ key[1], low(even)};
    key[0] += 0x9E3779B9;  // the golden ratio
    key[1] += 0xBB67AE85;  // sqrt(3) - 1
  }
  return counter;
}

/// Random numbers as a function of seed and place. The generator is a counter without any other state. [Salmon2011]
class CounterRandom {
 public:
  using result_type = std::uint64_t;

  CounterRandom(std::uint64_t seed, const DrawPlace& place)
      : counter_{{0, place.stream, place.item, place.step}},
        key_{{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}} {}

  double gaussian() { return boost::random::normal_distribution<double>()(*this); }
  double uniform() { return boost::random::uniform_01<double>()(*this); }

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }
  result_type operator()() {
    second_ = !second_;
    if (!second_) return half(2);
    block_ = philox(counter_, key_);
    ++counter_[0];
    return half(0);
  }

 private:
  result_type half(std::size_t first) const {
    return block_[first] | static_cast<result_type>(block_[first + 1]) << 32;
  }

  PhiloxCounter counter_, block_{};
  PhiloxKey key_;
  bool second_ = false;  // the first half of the block has been returned
};

}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Random123/philox.h>

#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <cstdint>
#include <limits>

namespace sas_motion {

/// Names a sequence of random numbers. Each stream, step and item has its own, which depends neither on other draws nor
/// on their order or thread.
struct DrawPlace {
  std::uint32_t stream = 0, step = 0, item = 0;
};

/// Random numbers as a function of seed and place. The generator is a counter without any other state. [Salmon2011,
/// Philox4x32-10]
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
    block_ = philox4x32(counter_, key_);
    ++counter_.v[0];
    return half(0);
  }

 private:
  result_type half(int first) const { return block_.v[first] | static_cast<result_type>(block_.v[first + 1]) << 32; }

  philox4x32_ctr_t counter_, block_{};
  philox4x32_key_t key_;
  bool second_ = false;  // the first half of the block has been returned
};

}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "sas_motion/math/random.hpp"
#include "sas_motion/noise/noise_law.hpp"

namespace sas_motion {

/// One draw of noise in units of the good standard deviation.
struct NoiseSample {
  double value = 0;
  double variance = 1;   ///< what an oracle is told of this draw, over the good variance [-]
  bool outlier = false;  ///< the label: bad, or a Student's t more than three times too wide
  bool missing = false;  ///< there is no measurement
  bool frozen = false;   ///< the measurement is the last one again
  double quantum = 0;    ///< the measurement is rounded to multiples of this; 0 for no rounding
};

constexpr double kSaysNothing =
    1e6;  ///< what an oracle is told of a reading without information: its variance over the good one

/// Spells that begin now and then, `rate` a second, and last `length` seconds; they do not touch.
class Spells {
 public:
  /// Whether one is on. `dice` is uniform and `elapsed` the time since the last call [s].
  bool on(const NoiseLaw& law, double time, double elapsed, double dice);

 private:
  double until_ = -1;
  bool on_ = false;
};

/// Draws one sensor channel's noise over time; calls must have rising times.
class NoiseSource {
 public:
  /// Rows of one sensor that share a `spell_stream` have their bursts, freezes and drop-outs together.
  NoiseSource(const NoiseMix& mix, std::uint64_t seed, std::uint64_t stream,
              std::optional<std::uint64_t> spell_stream = {});
  NoiseSample draw(double time);

 private:
  /// One law with what it remembers, and random numbers of its own.
  struct Part {
    NoiseLaw law;
    Random random, spell_random;
    Spells spells;
    double gauss_markov;

    void apply(NoiseSample& sample, double time, double elapsed, double dice);
  };

  Random random_;
  std::vector<Part> parts_;
  double last_time_ = 0;
};

/// The standard deviation of a varying law at a time, over the good one.
double varyingSigma(const NoiseLaw& law, double time);

}  // namespace sas_motion

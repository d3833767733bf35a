// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "sas_motion/config/yaml_section.hpp"
#include "sas_motion/math/random.hpp"

namespace sas_motion {

/// One draw of noise in units of the good standard deviation.
struct NoiseSample {
  double value = 0;
  bool outlier = false;
};

/// How a sensor's noise is distributed, by name:
///   gaussian       N(0, 1)
///   contaminated   (1 - epsilon) N(0, 1) + epsilon N(0, K^2), the paper's mixed normal [Zhu2007]
///   burst          N(0, 1), and now and then (rate a second) for `length` seconds a bias of K
struct NoiseLaw {
  enum class Kind { Gaussian, Contaminated, Burst };
  Kind kind = Kind::Gaussian;
  double epsilon = 0;  ///< share of outliers [-]
  double K = 1;        ///< their size in standard deviations
  double rate = 0;     ///< bursts a second [1/s]
  double length = 0;   ///< of a burst [s]

  static NoiseLaw read(YamlSection yaml);
  /// gaussian, or e.g. contaminated(0.1,10): a name for tables.
  std::string name() const;
};

/// Draws one sensor channel's noise over time; calls must have rising times.
class NoiseSource {
 public:
  NoiseSource(const NoiseLaw& law, std::uint64_t seed, std::uint64_t stream) : law_(law), random_(seed, stream) {}
  NoiseSample draw(double time);

 private:
  NoiseLaw law_;
  Random random_;
  double burst_until_ = -1;
  double last_time_ = 0;
};

}  // namespace sas_motion

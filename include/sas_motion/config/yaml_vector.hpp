// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "sas_motion/config/yaml_section.hpp"
#include "sas_motion/math/types.hpp"
#include "sas_motion/navigation/local_frame.hpp"

namespace sas_motion {

/// A key that holds a list of N numbers, each at least `lower`. Throws ConfigError.
template <int N>
void readVector(YamlSection& yaml, const std::string& key, Vector<N>& value,
                double lower = -std::numeric_limits<double>::infinity()) {
  std::vector<double> numbers(value.data(), value.data() + N);
  yaml.numbers(key, numbers, N);
  for (const double number : numbers)
    if (number < lower) yaml.fail(key, fmt::format("has {} but it must be at least {}", number, lower));
  std::copy(numbers.begin(), numbers.end(), value.data());
}

/// The same for an array. Throws ConfigError.
template <std::size_t N>
void readArray(YamlSection& yaml, const std::string& key, std::array<double, N>& value, double lower) {
  Vector<int{N}> vector(value.data());
  readVector<int{N}>(yaml, key, vector, lower);
  std::copy_n(vector.data(), N, value.begin());
}

/// A number that the file has in another unit: value = number * unit. The range is the number's. Throws ConfigError.
inline void readScaled(YamlSection& yaml, const std::string& key, double& value, double unit, Range range) {
  double number = value / unit;
  yaml.number(key, number, range);
  value = number * unit;
}

/// A key that holds latitude, longitude [deg] and altitude [m], the latitude within `bound` of the equator. Throws
/// ConfigError.
inline void readGeodetic(YamlSection& yaml, const std::string& key, Geodetic& value, int bound = 90) {
  Vector<3> numbers(value.latitude_deg, value.longitude_deg, value.altitude);
  readVector<3>(yaml, key, numbers);
  if (std::abs(numbers(0)) > bound)
    yaml.fail(key, fmt::format("has latitude {} but it must lie between -{} and {}", numbers(0), bound, bound));
  value = {numbers(0), numbers(1), numbers(2)};
}

/// The key system, which says what a file is for and may be left out. Throws ConfigError.
inline void readSystem(YamlSection& yaml, const std::string& expected) {
  std::string system = expected;
  yaml.text("system", system);
  if (system != expected) yaml.fail("system", fmt::format("is '{}' but must be {}", system, expected));
}

}  // namespace sas_motion

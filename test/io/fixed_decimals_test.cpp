// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/io/fixed_decimals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace sas_motion {
namespace {

std::string fixed(double value, int decimals) {
  fmt::memory_buffer out;
  appendFixed(value, decimals, out);
  return fmt::to_string(out);
}

TEST(FixedDecimals, AreThoseOfFmt) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-60, 60), mantissa(-1, 1);
  for (int run = 0; run < 200'000; ++run) {
    const double value = std::ldexp(mantissa(random), static_cast<int>(exponent(random)));
    for (const int decimals : {1, 9, 12, 15})
      ASSERT_EQ(fixed(value, decimals), fmt::format("{:.{}f}", value, decimals)) << value;
  }
}

TEST(FixedDecimals, HalfwayGoesToEven) {
  for (int i = -5000; i < 5000; ++i) {
    const double halfway = (2 * i + 1) * std::ldexp(1.0, -10);  // ends in 5 at the 10th decimal
    ASSERT_EQ(fixed(halfway, 9), fmt::format("{:.9f}", halfway)) << halfway;
  }
}

TEST(FixedDecimals, TakesEveryNumber) {
  using Limits = std::numeric_limits<double>;
  for (const double value : {0.0, -0.0, 1.0, -1e-300, 9.2e9, 9.3e9, 1e300, Limits::denorm_min(), Limits::min(),
                             Limits::max(), Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN(), 0.9999999999,
                             -0.99999999999999, 8999999999.9999999, std::nextafter(0.0, 1.0)})
    for (const int decimals : {0, 1, 9, 12, 20})
      EXPECT_EQ(fixed(value, decimals), fmt::format("{:.{}f}", value, decimals)) << value;
}

}  // namespace
}  // namespace sas_motion

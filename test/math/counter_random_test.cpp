// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/math/counter_random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sas_motion {
namespace {

TEST(CounterRandom, CountsByTheCipherOfItsPaper) {
  // The published known answers (kat_vectors of Random123): all zeros, all ones, and digits of pi.
  constexpr std::uint32_t kOnes = 0xffffffff;
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (PhiloxCounter{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
            (PhiloxCounter{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (PhiloxCounter{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
  CounterRandom random(0, {});
  EXPECT_EQ(random(), 0xe169c58d6627e8d5u);
  EXPECT_EQ(random(), 0x9b00dbd8bc57ac4cu);
}

TEST(CounterRandom, RepeatsItsDrawsOfManyPlaces) {
  // The sum was computed with Random123 1.14, by the same code.
  std::uint64_t sum = 0;
  for (std::uint32_t i = 0; i < 100000; ++i) {
    CounterRandom random(0x9e3779b97f4a7c15u * i, {i, 3 * i, i * i});
    for (int draw = 0; draw < 5; ++draw) sum = 31 * sum + random();
  }
  EXPECT_EQ(sum, 0xd24f260e5112a6d1u);
}

TEST(CounterRandom, DrawsDependOnTheirPlaceAlone) {
  CounterRandom first(7, {1, 2, 3}), again(7, {1, 2, 3});
  for (int i = 0; i < 10; ++i) EXPECT_EQ(first.gaussian(), again.gaussian());
  const double draw = CounterRandom(7, {1, 2, 3}).gaussian();
  EXPECT_NE(draw, CounterRandom(8, {1, 2, 3}).gaussian());
  EXPECT_NE(draw, CounterRandom(7, {0, 2, 3}).gaussian());
  EXPECT_NE(draw, CounterRandom(7, {1, 3, 3}).gaussian());
  EXPECT_NE(draw, CounterRandom(7, {1, 2, 4}).gaussian());
}

TEST(CounterRandom, NeighboursAreStandardNormalAndIndependent) {
  constexpr int kCount = 200000;
  double sum = 0, square = 0, fourth = 0, product = 0, last = 0;
  for (std::uint32_t item = 0; item < kCount; ++item) {
    const double x = CounterRandom(11, {0, 5, item}).gaussian();
    sum += x;
    square += x * x;
    fourth += x * x * x * x;
    product += x * last;
    last = x;
  }
  const double four_sigma = 4 / std::sqrt(kCount);
  EXPECT_NEAR(sum / kCount, 0, four_sigma);
  EXPECT_NEAR(square / kCount, 1, std::sqrt(2.0) * four_sigma);
  EXPECT_NEAR(fourth / kCount, 3, std::sqrt(96.0) * four_sigma);
  EXPECT_NEAR(product / kCount, 0, four_sigma);
}

}  // namespace
}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/evaluation/law_aware.hpp"

#include <cmath>

#include "noise/laws.hpp"
#include "support.hpp"

namespace sas_motion {
namespace {

using testing::law;
using Kind = NoiseLaw::Kind;

/// Sum of probabilities, mean and variance of a row's terms.
Vector<3> moments(const std::vector<NoiseTerm>& terms) {
  Vector<3> sum = Vector<3>::Zero();
  for (const auto& [variance, probability, mean] : terms)
    sum += probability * Vector<3>(1, mean, variance + mean * mean);
  return {sum(0), sum(1), sum(2) - sum(1) * sum(1)};
}

TEST(LawAware, GaussianNoiseIsOneTerm) {
  const auto options = lawAware({}, {}, 0.1);
  ASSERT_EQ(options.measurement.size(), 1u);
  ASSERT_EQ(options.process.size(), 1u);
  EXPECT_EQ(options.measurement[0].variance, 1);
  EXPECT_EQ(options.mode.rate, 0);
}

TEST(LawAware, ContaminationIsTwoTermsOfEach) {
  NoiseLaw process = testing::contaminated(0.05, 10);
  process.epoch = 0.5;
  const auto options = lawAware(testing::contaminated(0.1, 50), process, 0.1);
  ASSERT_EQ(options.measurement.size(), 2u);
  EXPECT_EQ(options.measurement[1].variance, 2500);
  EXPECT_EQ(options.measurement[1].probability, 0.1);
  ASSERT_EQ(options.process.size(), 2u);
  EXPECT_EQ(options.process[1].variance, 100);
  EXPECT_EQ(options.epoch, 0.5);
  EXPECT_EQ(options.persistence, 0);
}

TEST(LawAware, StudentsTermsHaveThePrecisionOfTheLaw) {
  for (const double nu : {1.5, 3.0, 5.0, 30.0}) {
    const auto terms = studentTerms(nu);
    double precision = 0;
    for (const auto& term : terms) precision += term.probability / term.variance;
    EXPECT_NEAR(precision, 1, 1e-12) << nu;  // E[lambda]
    EXPECT_NEAR(moments(terms)(0), 1, 1e-12);
    EXPECT_LT(moments(terms)(2), nu > 2 ? nu / (nu - 2) : INFINITY);
  }
}

TEST(LawAware, MultipathKeepsMeanAndVariance) {
  const auto terms =
      lawAware(law(Kind::Multipath, {{&NoiseLaw::probability, 0.2}, {&NoiseLaw::mean, 5}}), {}, 0.1).measurement;
  const auto sum = moments(terms);
  EXPECT_NEAR(sum(0), 1, 1e-12);
  EXPECT_NEAR(sum(1), 1, 1e-12);                     // 0.2 of 5
  EXPECT_NEAR(sum(2), 1 + 0.2 * 2 * 25 - 1, 1e-10);  // E[x^2] = 2 mean^2
}

TEST(LawAware, VaryingAndRoundedNoiseKeepTheirVariance) {
  const auto varying = lawAware(law(Kind::Varying, {{&NoiseLaw::factor, 3}}), {}, 0.1).measurement;
  EXPECT_NEAR(moments(varying)(2), 4 + 0.5, 1e-9);  // sigma swings about 2 with an amplitude of 1
  const auto rounded = lawAware(law(Kind::Quantised, {{&NoiseLaw::quantum, 2}}), {}, 0.1).measurement;
  EXPECT_NEAR(moments(rounded)(2), 1 + 4.0 / 12, 1e-12);
}

TEST(LawAware, SpellsBecomeAModeAndManoeuvresAScaleThatLasts) {
  const auto burst = law(Kind::Burst, {{&NoiseLaw::rate, 0.01}, {&NoiseLaw::length, 5}, {&NoiseLaw::K, 20}});
  EXPECT_FALSE(lawAware(burst, {}, 0.1).mode.bias);
  const auto known = lawAware(burst, {}, 0.1, BurstSize::Known);
  EXPECT_EQ(*known.mode.bias, 20);
  EXPECT_EQ(known.mode.rate, 0.01);
  const auto frozen = law(Kind::Frozen, {{&NoiseLaw::rate, 0.02}, {&NoiseLaw::length, 10}});
  const auto both = lawAware(NoiseMix({burst, frozen}), {}, 0.1, BurstSize::Known).mode;
  EXPECT_FALSE(both.bias);
  EXPECT_DOUBLE_EQ(both.rate, 0.03);
  EXPECT_EQ(both.length, 10);
  const auto manoeuvre =
      lawAware({}, law(Kind::Manoeuvre, {{&NoiseLaw::rate, 0.02}, {&NoiseLaw::length, 5}, {&NoiseLaw::K, 10}}), 0.1);
  const double share = 0.1 / 1.1;
  EXPECT_NEAR((1 - manoeuvre.persistence) * (1 - share), 0.1 / 5, 1e-12);  // one epoch in fifty is a manoeuvre's last
  EXPECT_NEAR((1 - manoeuvre.persistence) * share, 0.1 * 0.02, 1e-12);     // and they begin at their rate
  EXPECT_EQ(manoeuvre.epoch, 0.1);
}

}  // namespace
}  // namespace sas_motion

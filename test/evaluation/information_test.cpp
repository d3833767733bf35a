// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/evaluation/information.hpp"

#include <cmath>

#include "evaluation/noise_density.hpp"
#include "noise/laws.hpp"
#include "sas_motion/noise/noise_source.hpp"
#include "support.hpp"

namespace sas_motion {
namespace {

using testing::law;
using Kind = NoiseLaw::Kind;

NoiseLaw studentT(double nu) { return law(Kind::StudentT, {{&NoiseLaw::nu, nu}}); }
double factor(const NoiseMix& mix) { return MeasurementInformation(mix).factor(); }

double phi(double x, double sigma) { return std::exp(-0.5 * x * x / (sigma * sigma)) / (sigma * std::sqrt(2 * kPi)); }

/// Simpson's rule on a uniform grid for the integral of f'^2 / f, with a derivative by differences: shares nothing with
/// what it tests.
template <class Density>
double byDifferences(Density&& f, double from, double to, int intervals) {
  const double h = (to - from) / intervals;
  double sum = 0;
  for (int i = 0; i <= intervals; ++i) {
    const double x = from + i * h, slope = (f(x + 1e-4) - f(x - 1e-4)) / 2e-4, value = f(x);
    sum += (i == 0 || i == intervals ? 1 : i % 2 ? 4 : 2) * (value > 1e-100 ? slope * slope / value : 0) * h / 3;
  }
  return sum;
}

TEST(MeasurementInformation, IsOneForGaussianNoiseAndForContaminationThatIsNone) {
  EXPECT_NEAR(factor({}), 1, 1e-10);
  EXPECT_NEAR(factor(testing::contaminated(0, 10)), 1, 1e-10);
  EXPECT_NEAR(factor(testing::contaminated(0.3, 1)), 1, 1e-10);
  EXPECT_NEAR(factor(testing::contaminated(1, 10)), 0.01, 1e-12);
}

TEST(MeasurementInformation, OfStudentsTIsThePublishedOne) {
  for (const double nu : {1.0, 2.0, 3.0, 4.0, 10.0, 100.0, 1e5})
    EXPECT_NEAR(factor(studentT(nu)), (nu + 1) / (nu + 3), 1e-8) << nu;
}

TEST(MeasurementInformation, OfContaminationIsThatOfAnIndependentQuadrature) {
  const auto f = [](double x) { return 0.9 * phi(x, 1) + 0.1 * phi(x, 10); };
  EXPECT_NEAR(factor(testing::contaminated(0.1, 10)), byDifferences(f, -120, 120, 400000), 1e-7);
  std::cout << "contaminated(0.1,10): " << factor(testing::contaminated(0.1, 10)) << "\n";
}

TEST(MeasurementInformation, FallsWithTheShareAndTheSizeOfOutliersButNotBelowTheGoodShare) {
  double before = 1;
  for (const double epsilon : {0.05, 0.1, 0.2, 0.4}) {
    const double now = factor(testing::contaminated(epsilon, 10));
    EXPECT_LT(now, before);
    before = now;
  }
  before = 1;
  for (const double K : {1.5, 2.0, 3.0}) {
    const double now = factor(testing::contaminated(0.1, K));
    EXPECT_LT(now, before);
    before = now;
  }
  EXPECT_NEAR(factor(testing::contaminated(0.1, 1e5)), 0.9, 1e-3);  // outliers that far out are known for what they are
}

TEST(MeasurementInformation, OfMultipathIsThatOfAConvolutionByHand) {
  const auto noise = law(Kind::Multipath, {{&NoiseLaw::probability, 0.2}, {&NoiseLaw::mean, 5}});
  const auto f = [](double x) {
    double sum = 0;
    for (int i = 0; i < 400; ++i)
      sum += phi(x - 0.1 * (i + 0.5), 1) * std::exp(-0.02 * (i + 0.5)) * 0.2 * 0.1;  // midpoints to 40
    return 0.8 * phi(x, 1) + 0.2 * sum;
  };
  EXPECT_NEAR(factor(noise), byDifferences(f, -12, 39, 4000), 1e-3);
  EXPECT_FALSE(MeasurementInformation(noise).genie());
  EXPECT_NEAR(factor(law(Kind::Multipath, {{&NoiseLaw::probability, 0.2}, {&NoiseLaw::mean, 1e-3}})), 1, 1e-4);
  EXPECT_THROW(MeasurementInformation(std::vector<NoiseLaw>{noise, noise}), std::invalid_argument);
}

TEST(MeasurementInformation, RoundingCostsATwelfthOfTheSquareWhereItIsFine) {
  const auto rounded = [](double quantum) { return factor(law(Kind::Quantised, {{&NoiseLaw::quantum, quantum}})); };
  EXPECT_NEAR(rounded(0.1), 1 / (1 + 0.01 / 12), 1e-5);
  EXPECT_NEAR(rounded(0.5), 1 / (1 + 0.25 / 12), 1e-3);
  EXPECT_LT(rounded(4), rounded(2));
  EXPECT_GT(rounded(4), 0);
}

TEST(MeasurementInformation, LawsInAListAddUp) {
  const NoiseMix both(std::vector<NoiseLaw>{studentT(3), testing::contaminated(0.1, 10)});
  EXPECT_LT(factor(both), factor(studentT(3)));
  EXPECT_GT(factor(both), 0.9 * factor(studentT(3)) * 0.9);
}

TEST(MeasurementInformation, AGenieCallsSpellsBadAndSaysSo) {
  const auto burst = law(Kind::Burst, {{&NoiseLaw::rate, 0.01}, {&NoiseLaw::length, 5}, {&NoiseLaw::K, 20}});
  const MeasurementInformation information(std::vector<NoiseLaw>{testing::contaminated(0.1, 10), burst});
  EXPECT_TRUE(information.genie());
  EXPECT_EQ(information.of(kNoInformation, 3), 0);
  EXPECT_EQ(information.of(100, 3), factor(testing::contaminated(0.1, 10)));  // an outlier is not told
  const MeasurementInformation varying(law(Kind::Varying, {{&NoiseLaw::period, 10}, {&NoiseLaw::factor, 3}}));
  EXPECT_TRUE(varying.genie());
  EXPECT_NEAR(varying.of(9, 5), 1.0 / 9, 1e-10);
  EXPECT_NEAR(factor(law(Kind::Correlated, {{&NoiseLaw::share, 0.75}})), 4, 1e-9);
  EXPECT_FALSE(MeasurementInformation(law(Kind::Dropout, {{&NoiseLaw::probability, 0.5}})).genie());
}

TEST(ProcessInformation, OfACommonScaleIsARadialIntegral) {
  NoiseLaw noise = testing::contaminated(0.05, 10);
  EXPECT_NEAR(processInformation(noise, 6, 0.5).factor, factor(noise), 1e-12);  // each state on its own
  noise.epoch = 0.5;
  const auto six = processInformation(noise, 6, 0.5);
  EXPECT_FALSE(six.genie);
  EXPECT_NEAR(processInformation(noise, 1, 0.5).factor, factor(noise), 1e-9);  // in one dimension they are the same
  EXPECT_GT(six.factor, factor(noise));                                        // six states betray the scale
  EXPECT_LT(six.factor, 0.95 + 0.05 / 100);                                    // but not better than being told it
  EXPECT_GT(processInformation(noise, 40, 0.5).factor, 0.95 + 0.05 / 100 - 1e-6);
  EXPECT_NEAR(processInformation(testing::contaminated(0, 10), 6, 1).factor, 1, 1e-10);
  EXPECT_TRUE(processInformation(noise, 6, 0.1).genie);
  std::cout << "contaminated(0.05,10), six states: " << six.factor << "\n";
}

TEST(ProcessInformation, OfAVectorStudentsTIsThePublishedOne) {  // (nu + n) / (nu + n + 2)
  NoiseDensity density;
  density.studentise(4);
  for (const int n : {1, 2, 6}) EXPECT_NEAR(density.radialInformation(n), (4.0 + n) / (4.0 + n + 2), 1e-7) << n;
}

}  // namespace
}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/evaluation/aperture.hpp"

#include <cmath>

#include "support.hpp"

namespace sas_motion {
namespace {

struct Series {
  std::vector<double> time, along, across;
  template <class F, class G>
  Series(double duration, F along_at, G across_at) {
    for (int i = 0; i * 0.02 < duration; ++i) {
      time.push_back(1.6e9 + i * 0.02);
      along.push_back(along_at(i * 0.02));
      across.push_back(across_at(i * 0.02));
    }
  }
  ApertureError error(double speed = 1.5) const { return apertureError(time, along, across, speed, {}); }
};

TEST(Aperture, TimeIsRangeTimesWavelengthOverElementSpeed) {
  const auto error = Series(
                         100, [](double) { return 0; }, [](double) { return 0; })
                         .error();
  EXPECT_NEAR(error.time, 100 * 0.015 / (0.1 * 1.5), 1e-12);
  EXPECT_EQ(error.windows, 9u);  // the tenth is cut
}

TEST(Aperture, OffsetAndSteadyDriftDoNotMatter) {
  const auto error = Series(
                         200, [](double t) { return 50 + 0.3 * t; }, [](double t) { return -7 - 0.02 * t; })
                         .error();
  EXPECT_LT(error.along, 1e-5);  // stamps of 1.6e9 s have 0.2 us
  EXPECT_LT(error.across, 1e-6);
}

TEST(Aperture, ASineOfManyPeriodsHasItsRootMeanSquare) {
  const double amplitude = 0.01;
  const auto error =
      Series(
          400, [](double) { return 0; }, [&](double t) { return amplitude * std::sin(2 * kPi * t / 0.5); })
          .error();
  EXPECT_NEAR(error.across, amplitude / std::sqrt(2.0), 0.01 * amplitude);
  EXPECT_LT(error.along, 1e-9);
}

TEST(Aperture, AParabolaLeavesItsKnownRemainder) {  // a t^2 about its line over T: a T^2 / (6 sqrt 5)
  const double a = 1e-4;
  Series series(
      10.02, [](double) { return 0; }, [&](double t) { return a * t * t; });
  EXPECT_NEAR(series.error().across, a * 100 / (6 * std::sqrt(5.0)), 1e-5);
}

TEST(Aperture, WithoutSpeedOrDataThereIsNone) {
  EXPECT_EQ(Series(
                100, [](double t) { return t * t; }, [](double) { return 0; })
                .error(0)
                .windows,
            0u);
  EXPECT_EQ(Series(
                0, [](double) { return 0; }, [](double) { return 0; })
                .error()
                .windows,
            0u);
  EXPECT_EQ(Series(
                3, [](double t) { return t * t; }, [](double) { return 0; })
                .error()
                .windows,
            0u);
}

}  // namespace
}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/reacquiring_filter.hpp"

#include <cmath>

#include "sas_motion/filters/gated_kalman_filter.hpp"
#include "sas_motion/filters/robust_kalman_filter.hpp"
#include "support.hpp"

namespace sas_motion {
namespace {

using Gated = ReacquiringFilter<GatedKalmanFilter<6>, 6>;

LinearMeasurement<6, 1> reading(double innovation, double time, int source = 0) {
  LinearMeasurement<6, 1> z;
  z.H.setZero();
  z.H(0, 0) = 1;
  z.R(0, 0) = 1;
  z.innovation(0) = innovation;
  z.time = time;
  z.source = source;
  return z;
}

TEST(ReacquiringFilter, IsTheInnerFilterWhileMeasurementsAreBelieved) {
  Random random = testing::announced(65);
  const RobustKalmanFilter<6> inner({});
  const ReacquiringFilter<RobustKalmanFilter<6>, 6> filter(inner, 3);
  const auto prior = testing::randomBelief<6>(random);
  const auto z = testing::randomMeasurement<6, 2>(random);
  const auto expected = inner.update(prior, z);
  const auto update = filter.update({prior, {}}, z);
  EXPECT_EQ(update.belief.state.mean, expected.belief.mean);
  EXPECT_EQ(update.belief.state.covariance, expected.belief.covariance);
  EXPECT_EQ(update.verdict, expected.verdict);
}

/// Feeds a reading a second and returns when the first one was fused; negative where none was.
template <class Innovation>
double firstFused(double reset_after, double duration, Innovation innovation_at) {
  const Gated filter(GatedKalmanFilter<6>({}), reset_after);
  Gated::Belief belief;
  for (double t = 0; t <= duration; ++t) {
    const auto update = filter.update(belief, reading(innovation_at(t), t));
    if (update.verdict == Verdict::Accepted) {
      EXPECT_GT(update.belief.state.mean(0), 95);  // it has come over
      EXPECT_GT(testing::smallestEigenvalue<6>(update.belief.state.covariance), 0);
      return t;
    }
    EXPECT_EQ(update.belief.state.mean, Gaussian<6>().mean);
    belief = update.belief;
  }
  return -1;
}

TEST(ReacquiringFilter, LetsASensorBackInOnceItHasLongSaidTheSame) {
  for (const double reset_after : {15.0, 30.0}) {
    const double fused = firstFused(reset_after, 100, [](double) { return 100.0; });
    EXPECT_GE(fused, reset_after);
    EXPECT_LE(fused, reset_after + 3);
  }
}

TEST(ReacquiringFilter, ScatteredOutliersStayOut) {
  Random random = testing::announced(66);
  EXPECT_LT(
      firstFused(15, 100, [&](double t) { return (static_cast<int>(t) % 2 ? 1 : -1) * (100 + 50 * random.uniform()); }),
      0);
}

TEST(ReacquiringFilter, AGoodReadingInBetweenIsForgiveness) {
  const Gated filter(GatedKalmanFilter<6>({}), 15);
  Gated::Belief belief;
  for (double t = 0; t < 29; ++t) {
    const auto update = filter.update(belief, reading(t == 14 ? 0 : 100, t));
    ASSERT_EQ(update.verdict, t == 14 ? Verdict::Accepted : Verdict::Rejected) << t;
    belief = update.belief;
  }
}

TEST(ReacquiringFilter, SensorsAreWatchedOneByOne) {
  const Gated filter(GatedKalmanFilter<6>({}), 15);
  Gated::Belief belief;
  for (double t = 0; t < 15; ++t)
    for (const int source : {1, 2}) belief = filter.update(belief, reading(source == 1 ? 100 : 0, t, source)).belief;
  EXPECT_EQ(filter.update(belief, reading(100, 20, 2)).verdict, Verdict::Rejected);  // sensor 2 has been good so far
  EXPECT_EQ(filter.update(belief, reading(100, 20, 1)).verdict, Verdict::Accepted);
}

TEST(ReacquiringFilter, BrokenMeasurementsChangeNothing) {
  const Gated filter(GatedKalmanFilter<6>({}), 1);
  Gated::Belief belief;
  for (double t = 0; t < 30; ++t) {
    const auto update = filter.update(belief, reading(std::nan(""), t));
    ASSERT_EQ(update.verdict, Verdict::Invalid);
    belief = update.belief;
  }
  EXPECT_EQ(filter.update(belief, reading(100, 31)).verdict, Verdict::Rejected);  // the first that counts
  EXPECT_EQ(belief.state.mean, Gaussian<6>().mean);
}

TEST(ReacquiringFilter, RefusesAResetAfterNoTime) {
  EXPECT_THROW(Gated(GatedKalmanFilter<6>({}), 0), std::invalid_argument);
}

}  // namespace
}  // namespace sas_motion

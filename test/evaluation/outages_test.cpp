// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/outages.hpp"

#include <gtest/gtest.h>

namespace sas_motion {
namespace {

using Stamps = std::vector<Stamp>;

/// Every second from `begin` to `end`, without those in between `from` and `to`.
Stamps everySecond(int begin, int end, int from = 0, int to = 0) {
  Stamps stamps;
  for (int second = begin; second <= end; ++second)
    if (second <= from || second >= to) stamps.push_back(second * kNanosecondsPerSecond);
  return stamps;
}

Stamps shifted(Stamps stamps, Stamp offset) {
  for (Stamp& stamp : stamps) stamp += offset;
  return stamps;
}

Solution at(double seconds, double east, double north) {
  Solution solution;
  solution.stamp = stampFromSeconds(seconds);
  solution.position_map << east, north, 0;
  return solution;
}

TEST(TimeOffset, IsThatAtWhichEveryAuditIsOfAReading) {
  const Stamps fixes = everySecond(0, 200, 60, 120);
  for (const double seconds : {0.0, -1.0, 0.25, 18.0, -3600.0}) {
    const Stamp offset = stampFromSeconds(seconds);
    EXPECT_EQ(timeOffset(fixes, shifted(fixes, offset)), offset) << seconds;
    const Stamps started_late(fixes.begin() + 5, fixes.end());
    EXPECT_EQ(timeOffset(fixes, shifted(started_late, offset)), offset) << seconds;
  }
}

TEST(TimeOffset, IsZeroWhereNoneFits) {
  const Stamps fixes = everySecond(0, 100);
  EXPECT_EQ(timeOffset(fixes, {}), 0);
  EXPECT_EQ(timeOffset({}, fixes), 0);
  EXPECT_EQ(timeOffset(fixes, {stampFromSeconds(3), stampFromSeconds(4.3)}), 0);
  EXPECT_EQ(timeOffset(fixes, everySecond(10, 90)), 0) << "of several, the least";
}

/// GIVEN fixes that are 1 s older than their stamps, and none for a minute, WHEN the estimate drifts by 0.2 m/s until
/// the first new fix, THEN the error at the end is that before the fix, though its stamp comes 1 s later.
TEST(Outages, EndWhereTheFixWasReallyTaken) {
  std::vector<Solution> truth, estimates;
  for (int tenth = 0; tenth <= 2000; ++tenth) {
    const double time = 0.1 * tenth;
    truth.push_back(at(time, 0, 2 * time));
    estimates.push_back(at(time, time > 60 && time < 120 - 1e-6 ? 0.2 * (time - 60) : 0, 2 * time));
  }
  const TrueTrack track(truth);
  const Stamps taken = everySecond(0, 200, 60, 120), stamped = shifted(taken, kNanosecondsPerSecond);
  const auto naive = outages(stamped, track, estimates);
  ASSERT_EQ(naive.size(), 1u);
  EXPECT_LT(naive[0].error_end, 0.1) << "the first new fix is fused before its stamp";
  const auto found = outages(shifted(stamped, timeOffset(stamped, taken)), track, estimates);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].begin, 60, 1e-9);
  EXPECT_NEAR(found[0].duration, 60, 1e-9);
  EXPECT_NEAR(found[0].error_end, 0.2 * 59.9, 1e-6);
  EXPECT_NEAR(found[0].distance, 2 * 59.9, 1e-6);
}

TEST(Outages, AreOfHalfAMinuteAtLeastAndNeedTruthAndEstimates) {
  const TrueTrack track({at(0, 0, 0), at(100, 0, 100)});  // a gap in the truth itself
  EXPECT_TRUE(outages(everySecond(0, 100, 20, 45), track, {at(30, 0, 0)}).empty());
  EXPECT_TRUE(outages(everySecond(0, 100, 20, 60), track, {at(30, 0, 0)}).empty());
}

}  // namespace
}  // namespace sas_motion

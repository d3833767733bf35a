// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/solution_errors.hpp"

#include <cmath>

#include "sas_motion/math/angles.hpp"
#include "support.hpp"

namespace sas_motion {
namespace {

/// A body in the plane: heads north at 2 m/s, without a height.
Solution inThePlane(double seconds) {
  Solution solution;
  solution.stamp = stampFromSeconds(seconds);
  solution.position_map << 0, 2 * seconds, 0;
  solution.q_map_base = Eigen::Quaterniond(Eigen::AngleAxisd(kPi / 2, Vector<3>::UnitZ()));
  solution.velocity_base << 2, 0, 0;
  solution.pose_covariance.setIdentity();
  solution.twist_covariance.setIdentity();
  solution.pose_covariance.diagonal().segment<3>(2).setConstant(kNotEstimated);
  return solution;
}

std::vector<std::string> groupsOf(const Solution& estimate, const Solution& truth) {
  EstimatorScorer scorer;
  score(estimate, {truth, headingOf(truth.q_map_base)}, scorer);
  std::vector<std::string> names;
  for (const auto& [name, summary] : scorer.errors()) names.push_back(name);
  return names;
}

using Names = std::vector<std::string>;

TEST(SolutionErrors, AnUnknownQuantityIsNotScored) {
  Solution truth = inThePlane(0);
  EXPECT_EQ(groupsOf(inThePlane(0), truth), (Names{"position", "heading", "speed"}));
  truth.pose_covariance(5, 5) = truth.twist_covariance(0, 0) = kNotEstimated;
  EXPECT_EQ(groupsOf(inThePlane(0), truth), Names{"position"});
  EXPECT_EQ(groupsOf(truth, inThePlane(0)), Names{"position"}) << "unknown to the estimate";
}

TEST(SolutionErrors, ACurrentIsScoredWhereBothHaveOne) {
  Solution estimate = inThePlane(0), truth = inThePlane(0);
  estimate.current = Current{{0.3, 0.4}, Matrix<2>::Identity()};
  EXPECT_EQ(groupsOf(estimate, truth).size(), 3u);
  truth.current = Current{};
  EstimatorScorer scorer;
  score(estimate, {truth, 0}, scorer);
  EXPECT_EQ(scorer.errors().back().first, "current");
  EXPECT_NEAR(scorer.errors().back().second.max, 0.5, 1e-12);
  EXPECT_NEAR(scorer.nees().back().second.mean, 0.25, 1e-12);
}

TEST(SolutionErrors, HeightVelocityAndTiltAreOfABodyInSpace) {
  Solution estimate = inThePlane(0), truth = inThePlane(0);
  estimate.pose_covariance.setIdentity();
  EXPECT_EQ(groupsOf(estimate, truth).size(), 3u) << "truth has no height";
  truth.pose_covariance.setZero();
  EXPECT_EQ(groupsOf(estimate, truth), (Names{"position", "heading", "speed", "height", "velocity", "tilt"}));
}

TEST(SolutionErrors, DriftIsAlongAndAcrossTheTrueHeading) {
  EstimatorScorer scorer;
  for (int i = 0; i <= 100; ++i) {
    const Solution truth = inThePlane(i);
    Solution estimate = truth;
    estimate.position_map += Vector<3>(0.03 * i, -0.04 * i, 0);
    score(estimate, {truth, 0}, scorer);
    if (i > 0) scorer.addDistance(2);
  }
  EXPECT_NEAR(scorer.drift(), 5.0 / 200, 1e-12);
  EXPECT_NEAR(scorer.errors().front().second.max, 5, 1e-12);
  EXPECT_LT(scorer.aperture().across, 1e-4);  // a steady drift is no aperture error
}

TEST(SolutionErrors, WhatIsNotFiniteHasDiverged) {
  Solution estimate = inThePlane(0);
  estimate.position_map.x() = std::nan("");
  EstimatorScorer scorer;
  score(estimate, {inThePlane(0), 0}, scorer);
  EXPECT_TRUE(scorer.report().diverged);
  EXPECT_TRUE(scorer.errors().empty());
}

TEST(TrueTrack, InterpolatesButNotOverGaps) {
  Solution turned = inThePlane(2);
  turned.q_map_base = Eigen::Quaterniond(Eigen::AngleAxisd(kPi, Vector<3>::UnitZ()));  // heads west
  turned.current = Current{{1, 0}, Matrix<2>::Zero()};
  const TrueTrack track({inThePlane(0), turned, inThePlane(10)});
  const auto between = track.at(stampFromSeconds(0.5));
  ASSERT_TRUE(between);
  EXPECT_NEAR(between->solution.position_map.y(), 1, 1e-12);
  EXPECT_NEAR(between->heading, -kPi / 8, 1e-12);
  EXPECT_NEAR(headingOf(between->solution.q_map_base), between->heading, 1e-12);
  EXPECT_FALSE(between->solution.current) << "known at one end only";
  EXPECT_TRUE(track.at(stampFromSeconds(2))->solution.current);
  EXPECT_FALSE(track.at(stampFromSeconds(5))) << "8 s without truth";
  EXPECT_FALSE(track.at(stampFromSeconds(-1)));
  EXPECT_FALSE(track.at(stampFromSeconds(11)));
}

}  // namespace
}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>

#include "imaging/imaging_support.hpp"
#include "sas_motion/imaging/point_target.hpp"
#include "sas_motion/imaging/trajectory.hpp"

namespace sas_motion::imaging::testing {
namespace {

const Eigen::Vector3d kTarget{0, -29, 0};

std::vector<double> timesOf(const std::vector<PingPose>& poses) {
  std::vector<double> times;
  for (const auto& pose : poses) times.push_back(pose.position.x() / 2);  // at 2 m/s
  return times;
}

TEST(FitTrend, LeavesTheRestOfALine) {
  const Trend trend = fitTrend({10, 11, 12, 13}, {1.5, 3.5, 5.5 + 0.4, 7.5});
  EXPECT_NEAR(trend.mean, 4.6, 1e-12);
  EXPECT_NEAR(trend.slope, 2.04, 1e-12);
  EXPECT_NEAR(trend.rms, 0.4 * std::sqrt(0.7) / 2,
              1e-12);  // the share of a single value at the third of four places that no line takes
}

TEST(ApertureTrajectoryError, IsWhatMeanAndTrendLeaveOfASwayTowardsTheTarget) {
  const SonarDescription sonar = smallSonar();
  const auto truth = track(201, 0.02);
  auto estimate = truth;
  const double towards = 0.01, height = 10, range = std::hypot(29.0, height);
  for (std::size_t i = 0; i < truth.size(); ++i)
    estimate[i].position += Eigen::Vector3d(
        3, -2 + 0.05 * truth[i].position.x() - towards * std::sin(2 * kPi * 5 * truth[i].position.x() / 4.02), 0);
  const auto error = apertureTrajectoryError(sonar, timesOf(truth), truth, estimate, kTarget);
  const double expected = towards * 29 / range / std::sqrt(2.0);
  EXPECT_NEAR(error.line_of_sight.rms, expected, 0.02 * expected);
  EXPECT_NEAR(error.line_of_sight.mean, -2 * 29 / range, 1e-3);  // 2 m too near
  EXPECT_NEAR(error.along.mean, 3, 1e-9);
  EXPECT_NEAR(error.along.rms, 0, 1e-9);
}

TEST(ApertureTrajectoryError, OfThePathsHasTheAttitudeToo) {
  SonarDescription sonar = smallSonar();
  sonar.receivers = 2;
  const auto truth = track(51, 0.1);
  auto estimate = truth;
  const double yaw = 0.02;
  for (auto& pose : estimate) pose.C_local_body = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const auto error = apertureTrajectoryError(sonar, timesOf(truth), truth, estimate, kTarget);
  EXPECT_EQ(error.line_of_sight.rms, 0);
  const double each = yaw * sonar.spacing / 2 / 2 * 29 /
                      std::hypot(29.0, 10.0);  // of half the path; one receiver too near, one too far
  EXPECT_NEAR(error.path.rms, each, 0.02 * each);
}

TEST(ImageShift, IsWhereThePeakGoes) {
  const SonarDescription sonar = smallSonar();
  const auto truth = track(200, 0.02);
  auto estimate = truth;
  for (auto& pose : estimate) pose.position += Eigen::Vector3d(0.7, 0.4 + 0.01 * pose.position.x(), 0);
  const auto error = apertureTrajectoryError(sonar, timesOf(truth), truth, estimate, kTarget);
  const Eigen::Vector3d shift = error.image_shift;
  EchoLines lines = compressedEchoes(sonar, echoPaths(sonar, truth), points({kTarget}));
  lines.paths = echoPaths(sonar, estimate);
  ImageGrid grid = gridAround(kTarget + shift, 160, 128);
  grid.origin.x() += 0.01;  // off the pixels
  ChipOptions chip;
  chip.search_radius = 0.3;
  const auto measures = measurePointTarget(backproject(lines, grid, {}), kTarget + shift, chip);
  ASSERT_TRUE(measures.complete);
  EXPECT_GT(shift.norm(), 0.5);
  EXPECT_LT(error.path.rms, 1e-4) << "a moved image is no blurred one";
  EXPECT_NEAR(measures.peak_position.x() - kTarget.x(), shift.x(), 0.02);
  EXPECT_NEAR(measures.peak_position.y() - kTarget.y(), shift.y(), 0.005);
}

}  // namespace
}  // namespace sas_motion::imaging::testing

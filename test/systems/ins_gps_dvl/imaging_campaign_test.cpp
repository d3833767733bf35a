// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <map>

#include "campaign/suites.hpp"
#include "sas_motion/imaging/focus_bench.hpp"
#include "sas_motion/imaging/focus_scene.hpp"
#include "sas_motion/imaging/trajectory.hpp"

namespace sas_motion {
namespace {

using testing::expectRefused;
using testing::runAll;
using testing::suiteOf;

const std::string kConfig = SAS_MOTION_SOURCE_DIR "/config/";

std::string imagingSuite(const std::string& estimators, const std::string& more = "") {
  return "{runs: 1, campaigns: [{name: images, system: imaging, scenario: " + kConfig +
         "scenarios/ins/survey.yaml, duration: 200, skip: 120, windows: 2, config: " + kConfig +
         "focus_survey.yaml, estimators: " + estimators + ", laws: [{name: clean}]" + more + "}]}";
}

/// The measures of each window, by estimator.
std::map<std::string, std::vector<std::map<std::string, double>>> windowsOf(const std::string& suite) {
  std::map<std::string, std::vector<std::map<std::string, double>>> all;
  const auto runs = runAll(suiteOf(suite));
  for (const auto& report : runs.front())
    for (const auto& window : report.windows) all[report.estimator].emplace_back(window.begin(), window.end());
  return all;
}

TEST(ImagingSystem, TheImageFollowsTheNavigation) {
  // GIVEN a survey on which a sonar looks at a point from 10 m of track, WHEN it is focused along each estimate
  const auto windows = windowsOf(imagingSuite("[error_free, ins, gnss_alone, robust_kf27, steady_robust_kf27]"));
  for (std::size_t i = 0; i < 2; ++i) {
    // THEN truth at the stamps of the IMU loses nothing
    const auto truth = windows.at("error_free").at(i);
    EXPECT_LT(truth.at("path_wavelengths"), 1e-3);
    EXPECT_LT(std::abs(truth.at("peak_loss")), 1e-3);
    EXPECT_LT(std::abs(truth.at("pslr_along")), 0.05);
    EXPECT_LT(std::abs(truth.at("islr_along")), 0.01);
    // the steady solution makes an image, within the targets after autofocus, and the others none
    const auto steady = windows.at("steady_robust_kf27").at(i);
    EXPECT_LT(steady.at("line_of_sight_wavelengths"), 1.0 / 32);
    EXPECT_LT(steady.at("along_wavelengths"), 1.0 / 32);
    EXPECT_LT(std::abs(steady.at("pslr_range")), 0.5);
    EXPECT_LT(std::abs(steady.at("islr_range")), 1);
    EXPECT_LT(std::abs(steady.at("autofocus_pslr_along")), 0.5);
    EXPECT_LT(std::abs(steady.at("autofocus_islr_along")), 1);
    for (const char* name : {"ins", "gnss_alone", "robust_kf27"})
      EXPECT_GT(windows.at(name).at(i).at("peak_loss"), steady.at("peak_loss") + 6) << name;
  }
}

TEST(ImagingSystem, SaysWhatIsWrong) {
  expectRefused(imagingSuite("[kf28]"), "kf28");
  expectRefused(imagingSuite("[]"), "estimators");
  expectRefused("{campaigns: [{name: images, system: imaging, scenario: " + kConfig +
                    "scenarios/ins/survey.yaml, estimators: [ins], laws: [{name: clean}]}]}",
                "config");
  expectRefused("{campaigns: [{name: images, system: imaging, scenario: " + kConfig +
                    "scenarios/ins/survey.yaml, config: " + kConfig +
                    "focus_survey.yaml, duration: 122, skip: 120, estimators: [ins], laws: [{name: clean}]}]}",
                "duration");
}

TEST(FocusBench, AConstantOffsetMovesTheImageAndDoesNotBlurIt) {
  const auto settings = imaging::readFocus(kConfig + "focus_survey.yaml");
  std::vector<imaging::PingPose> truth(26);
  std::vector<double> times;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    times.push_back(0.2 * static_cast<double>(i));
    truth[i].position = {2 * times[i] - 5, 0.3 * std::sin(times[i]), settings.sonar.altitude};
    truth[i].velocity = {2, 0.3 * std::cos(times[i]), 0};
  }
  const Eigen::Vector3d offset(3, -2, 0);
  auto estimate = truth;
  for (auto& pose : estimate) pose.position += offset;
  imaging::FocusBench bench(settings, times, truth, 1);
  const auto moved = bench.focus(estimate).targets.front();
  EXPECT_NEAR(moved.peak_error, offset.norm(), 0.01);
  EXPECT_LT(std::abs(moved.peak_loss), 0.01);
  EXPECT_NEAR(moved.along.pslr, bench.errorFree().targets.front().along.pslr, 0.05);
  EXPECT_NEAR(moved.along.islr, bench.errorFree().targets.front().along.islr, 0.05);
  // but a speed that is 1 % too high does
  for (std::size_t i = 0; i < truth.size(); ++i) estimate[i].position.x() += 0.02 * (times[i] - 2.5);
  EXPECT_GT(bench.focus(estimate).targets.front().peak_loss, 3);
}

}  // namespace
}  // namespace sas_motion

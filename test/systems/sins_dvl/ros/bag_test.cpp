// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "bag/bag_output.hpp"
#include "bag/odometry_in.hpp"
#include "bag/reprocess.hpp"
#include "sas_motion/systems/sins_dvl/estimator.hpp"
#include "systems/registry.hpp"
#include "systems/sins_dvl/ros/recorder.hpp"

namespace sas_motion::ros_side {
namespace {

constexpr double kSeconds = 20;

sins::Scenario scenarioWithLevers() {
  auto scenario = sins::Scenario::fromFile(SAS_MOTION_SOURCE_DIR "/config/scenarios/sins_dvl/large_angle.yaml");
  scenario.duration = kSeconds;
  scenario.parameters.dvl_lever_body = {0.3, 2, -0.5};
  scenario.parameters.depth_lever_body = {0.1, 1, -0.2};
  return scenario;
}

/// The same readings without a bag between.
std::vector<ins::NavigationSolution> inMemory(const sins::Scenario& scenario, std::uint64_t seed,
                                              const std::string& name, int particles) {
  const auto recording = sins::simulate(scenario, ins::Trajectory(scenario.track, scenario.duration), seed);
  sins::Config config;
  config.parameters = scenario.parameters;
  config.particles.particles = particles;
  const auto estimator = sins::makeEstimator(name, config);
  estimator->start(recording.start, 0);
  ins::Output output;
  auto next = recording.aiding.begin();
  for (std::size_t k = 1; k < recording.imu.size(); ++k) {
    for (; next != recording.aiding.end() && next->reading.stamp <= recording.imu[k].stamp; ++next)
      estimator->process(next->reading, output);
    estimator->process(recording.imu[k], output);
  }
  return output.solutions;
}

TEST(SinsBag, AReprocessedBagSaysWhatTheSameReadingsSayInMemory) {
  // GIVEN a simulated run from a heading that is 5 degrees off, WHEN it goes through messages, a bag, tf, alignment and
  // reprocess, THEN only their rounding is between it and the run in memory: start, velocity and lever arms are those
  // of the simulator
  const std::string folder = ::testing::TempDir() + "/sins_bag_test", file = folder + "/sins.bag",
                    config = folder + "/a.yaml";
  std::filesystem::create_directories(folder + "/out");
  std::ofstream(config)
      << "{system: sins_dvl, output_rate: 100, lag: 2, datum: [60, 120, 0], particles: {number: 100}}";
  const sins::Scenario scenario = scenarioWithLevers();
  BagOutput bag(file);
  SinsRecorder(scenario, 7, bag).record([](double) {});
  bag.commit();
  const std::vector<std::string> names{"ss_srupf", "ss_srukf"};
  reprocess(file, folder + "/out", names, *openSystem(config), [](double) {});

  const LocalFrame frame({60, 120, 0});
  for (const auto& name : names) {
    const auto messages = odometryIn(folder + "/out/sins.bag", name + "/odometry");
    const auto solutions = inMemory(scenario, 7, name, 100);
    ASSERT_EQ(messages.size(), solutions.size());
    ASSERT_EQ(messages.size(), static_cast<std::size_t>(100 * kSeconds));
    expectBelow(name, differencesBetween(messages, solutions, frame),
                {1e-5, 1e-6, 1e-7, 1e-4});  // the start knows of the way from the attitude to the fix
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace sas_motion::ros_side

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "bag/bag_output.hpp"
#include "bag/odometry_in.hpp"
#include "bag/reprocess.hpp"
#include "systems/ins_gps_dvl/ros/recorder.hpp"
#include "systems/ins_gps_dvl/stream.hpp"
#include "systems/registry.hpp"

namespace sas_motion::ros_side {
namespace {

TEST(InsBag, AReprocessedBagSaysWhatTheSameReadingsSayInMemory) {
  // GIVEN a simulated run, WHEN it goes through messages, a bag, tf and reprocess, THEN only their rounding is between
  // it and the run in memory
  const std::string folder = ::testing::TempDir() + "/ins_bag_test", file = folder + "/ins.bag",
                    config = folder + "/a.yaml";
  std::filesystem::create_directories(folder + "/out");
  std::ofstream(config) << "{system: ins_gps_dvl, output_rate: 100, lag: 2, datum: [54.35, 10.15, 0]}";
  const ins::Scenario scenario = ins::testing::surveyOf(60);
  BagOutput bag(file);
  InsRecorder(scenario, 7, bag).record([](double) {});
  bag.commit();
  reprocess(file, folder + "/out", {"kf27", "robust_kf27"}, *openSystem(config), [](double) {});

  const LocalFrame frame({54.35, 10.15, 0});
  for (const std::string name : {"kf27", "robust_kf27"}) {
    const auto messages = odometryIn(folder + "/out/ins.bag", name + "/odometry");
    const auto solutions =
        ins::testing::settled(ins::testing::streamOf(scenario, 7), ins::testing::optionsOf(scenario), name).solutions;
    ASSERT_EQ(messages.size(), solutions.size());
    ASSERT_GT(messages.size(), 5800u);
    expectBelow(name, differencesBetween(messages, solutions, frame), {1e-6, 1e-8, 1e-10, 1e-8});
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace sas_motion::ros_side

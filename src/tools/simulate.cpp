// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// simulate SCENARIO.yaml -o OUT.bag: a scenario to a bag with sensors and truth.
#include <optional>

#include "systems/registry.hpp"
#include "tools/main_guard.hpp"
#include "tools/progress.hpp"

namespace {

using namespace sas_motion;

struct Options {
  SimulationRequest request;
  std::string out;
};

void run(const Options& options) {
  ros_side::BagOutput bag(options.out);
  std::optional<Progress> progress;
  simulate(options.request, bag, [&](double total, double passed) {
    if (!progress) progress.emplace("simulate", total, total);
    progress->advance(passed);
  });
  bag.commit();
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Simulates a scenario into a bag. A towfish's: gnss/fix, imu/data, dvl/twist, /tf_static, and truth/odometry, "
      "truth/fix, truth/current, truth/label. With 'system: usbl', a calibration's: gnss/fix, imu/data, "
      "usbl/measurement, usbl/transponder, /tf_static, and truth/odometry, truth/label, truth/usbl_mounting. With "
      "'system: ins_gps_dvl', a survey's: gnss/fix, imu/data, dvl/twist, depth/pose, /tf_static, and truth/odometry, "
      "truth/fix, truth/label. With 'system: sins_dvl', a towed body's: imu/data, dvl/twist, depth/pose, /tf_static, "
      "one gnss/fix and one gnss/velocity at the start, and truth/odometry, truth/fix, truth/label.",
      "simulate");
  app.add_option("SCENARIO", options.request.scenario, "scenario to play (YAML)")->required();
  app.add_option("-o,--output", options.out, "bag to write")->required();
  app.add_option("--seed", options.request.seed, "seed of all noise (default 1)");
  app.add_option("--duration", options.request.duration, "seconds, instead of the scenario's")
      ->check(CLI::PositiveNumber);
  return runTool(app, argc, argv, [&] { run(options); });
}

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// simulate SCENARIO.yaml -o OUT.bag: a scenario to a bag with sensors and truth.
#include <cmath>

#include "bag/bag_output.hpp"
#include "systems/ins_gps_dvl/ros/recorder.hpp"
#include "systems/towfish/ros/recorder.hpp"
#include "systems/usbl/ros/recorder.hpp"
#include "tools/main_guard.hpp"
#include "tools/progress.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::ros_side;

constexpr double kTruthPeriod = 0.1;  // s between truth messages of a towfish

struct Options {
  std::string scenario, out;
  std::uint64_t seed = 1;
  double duration = 0;
};

void simulateTowfish(const Options& options) {
  towfish::Scenario scenario = towfish::Scenario::fromFile(options.scenario);
  if (options.duration > 0) scenario.duration = options.duration;
  BagOutput bag(options.out);
  TowfishRecorder recorder(scenario, bag);
  towfish::Simulator simulator(scenario, options.seed);
  const long every = std::max(1L, std::lround(kTruthPeriod / scenario.step));
  Progress progress("simulate", scenario.duration, scenario.duration);
  recorder.transforms();
  for (long step = 0; simulator.next(); ++step) {
    if (step % every == 0) recorder.truth(simulator.truth());
    recorder.measurements(simulator.measurements());
    if (step % 100 == 0) progress.advance(100 * scenario.step);
  }
  bag.commit();
}

/// A scenario whose recorder plays it from start to end.
template <class Scenario, class Recorder>
void simulateBy(const Options& options) {
  Scenario scenario = Scenario::fromFile(options.scenario);
  if (options.duration > 0) scenario.duration = options.duration;
  BagOutput bag(options.out);
  Recorder recorder(scenario, options.seed, bag);
  Progress progress("simulate", scenario.duration, scenario.duration);
  recorder.record([&](double seconds) { progress.advance(seconds); });
  bag.commit();
}

void run(const Options& options) {
  auto yaml = YamlSection::fromFile(options.scenario);
  std::string system;
  yaml.text("system", system);
  if (system.empty()) return simulateTowfish(options);
  if (system == "usbl") return simulateBy<usbl::Scenario, UsblRecorder>(options);
  if (system == "ins_gps_dvl") return simulateBy<ins::Scenario, InsRecorder>(options);
  if (system == "sins_dvl") return simulateBy<sins::Scenario, InsRecorder>(options);
  yaml.fail("system", "is '" + system + "' but must be usbl, ins_gps_dvl or sins_dvl, or left out for a towfish");
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Simulates a scenario into a bag. A towfish's: gnss/fix, imu/data, dvl/twist, /tf_static, and truth/odometry, "
      "truth/fix, truth/current, truth/label. "
      "With 'system: usbl', a calibration's: gnss/fix, imu/data, usbl/measurement, usbl/transponder, /tf_static, and "
      "truth/odometry, truth/label, "
      "truth/usbl_mounting. With 'system: ins_gps_dvl', a survey's: gnss/fix, imu/data, dvl/twist, depth/pose, "
      "/tf_static, and truth/odometry, truth/fix, "
      "truth/label. With 'system: sins_dvl', a towed body's: imu/data, dvl/twist, depth/pose, /tf_static, one gnss/fix "
      "and one gnss/velocity at the start, and "
      "truth/odometry, truth/fix, truth/label.",
      "simulate");
  app.add_option("SCENARIO", options.scenario, "scenario to play (YAML)")->required();
  app.add_option("-o,--output", options.out, "bag to write")->required();
  app.add_option("--seed", options.seed, "seed of all noise (default 1)");
  app.add_option("--duration", options.duration, "seconds, instead of the scenario's")->check(CLI::PositiveNumber);
  return runTool(app, argc, argv, [&] { run(options); });
}

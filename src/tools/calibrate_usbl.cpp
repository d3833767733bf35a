// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// calibrate_usbl IN.bag -o calibration.yaml: how a USBL array is mounted, from a recorded calibration run.
#include <fmt/format.h>

#include <filesystem>

#include "bag/bag_reader.hpp"
#include "sas_motion/io/atomic_file.hpp"
#include "systems/usbl/graph/batch.hpp"
#include "systems/usbl/ros/calibration_result.hpp"
#include "tools/main_guard.hpp"
#include "tools/progress.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::ros_side;

constexpr int kNotTrusted = 3;  // exit status

struct Options {
  std::string bag, out = "calibration.yaml", config, mode;
  std::vector<std::string> estimators{"ckf", "vbckf", "hckf", "hvbckf", "batch"};
};

CalibrationResult calibrate(const Options& options) {
  CalibrationResult result;
  result.bag = std::filesystem::path(options.bag).filename().string();
  result.settings = UsblSettings::fromFile(options.config);
  if (!options.mode.empty()) result.settings.calibration.mode = usbl::modeFromName(options.mode);
  {
    const BagReader bag(options.bag);
    const double seconds = (bag.end() - bag.begin()).toSec();
    Progress progress("read", seconds, seconds);
    result.recording =
        UsblRecording::read(options.bag, result.settings, [&](double passed) { progress.advance(passed); });
  }
  Progress progress("calibrate", static_cast<double>(options.estimators.size()), 0);
  result.comparison = usbl::compare(result.recording.pings, result.settings.calibration, options.estimators,
                                    usbl::makeFitter, [&] { progress.advance(1); });
  if (!result.comparison.failure.empty())
    throw std::runtime_error(fmt::format("{}: {}", options.bag, result.comparison.failure));
  return result;
}

bool run(const Options& options) {
  const std::filesystem::path trace = std::filesystem::path(options.out).replace_extension(".json");
  if (trace == options.out)
    throw std::runtime_error(fmt::format(
        "{}: the trace takes the name with .json; give the calibration another, such as .yaml", options.out));
  const CalibrationResult result = calibrate(options);
  writeFile(trace, calibrationTrace(result));
  writeFile(options.out, calibrationDocument(result));
  fmt::print("{}", calibrationTable(result));
  return result.comparison.trusted();
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Finds the mounting angles and the lever arm of a USBL array from a bag with gnss/fix, imu/data, "
      "usbl/measurement and usbl/transponder.",
      "calibrate_usbl");
  app.footer(
      "Beside the calibration a trace of the same name with .json is written, for calibration_report.py. The exit "
      "status is 0 for a calibration that may\nbe trusted, 3 for one that says itself that it may not (the track "
      "cannot "
      "tell, a filter and batch disagree, or most readings contradict it), 1 where there is none, 2 for a wrong\n"
      "command line.");
  app.add_option("BAG", options.bag, "bag to read")->required();
  app.add_option("-o,--output", options.out, "calibration to write (YAML; default: calibration.yaml)");
  app.add_option("--estimators", options.estimators,
                 fmt::format("names, comma-separated, of {} (default: ckf,vbckf,hckf,hvbckf,batch); batch always runs",
                             fmt::join(usbl::estimatorNames(), ", ")))
      ->delimiter(',')
      ->check(CLI::IsMember(usbl::estimatorNames()));
  app.add_option("--config", options.config, "configuration (YAML; default: built in, see config/usbl.yaml)");
  app.add_option("--mode", options.mode, "what of a direction is used, instead of the configuration's")
      ->check(CLI::IsMember(usbl::modeNames()));
  bool trusted = true;
  const int status = runTool(app, argc, argv, [&] { trusted = run(options); });
  return status == 0 && !trusted ? kNotTrusted : status;
}

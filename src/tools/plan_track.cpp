// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// plan_track SCENARIO.yaml [--track waypoints.csv]: predicts how well a planned track determines a USBL array's
// mounting.
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "sas_motion/evaluation/information.hpp"
#include "sas_motion/systems/usbl/problem.hpp"
#include "sas_motion/systems/usbl/simulator.hpp"
#include "systems/usbl/ros/calibration_result.hpp"
#include "tools/main_guard.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::usbl;

constexpr int kNotObservable = 3;  // exit status

struct Options {
  std::string scenario, track, config, mode;
  double duration = 0;
};

/// The two numbers of a line; nothing for other lines.
std::optional<Vector<2>> pairOf(std::string line) {
  std::replace(line.begin(), line.end(), ',', ' ');
  std::istringstream stream(line);
  Vector<2> pair;
  std::string rest;
  if (!(stream >> pair(0) >> pair(1)) || stream >> rest || !pair.allFinite()) return std::nullopt;
  return pair;
}

/// Waypoints, east and north of the datum [m], from a file with the header `east,north` [m] or `latitude,longitude`
/// [deg].
std::vector<Vector<2>> readWaypoints(const std::string& file, const Geodetic& datum) {
  std::ifstream stream(file);
  std::string line;
  if (!stream || !std::getline(stream, line))
    throw std::runtime_error(fmt::format("{}: cannot be read or is empty; check the path", file));
  line.erase(std::remove_if(line.begin(), line.end(), [](unsigned char c) { return std::isspace(c); }), line.end());
  const bool geodetic = line == "latitude,longitude";
  if (!geodetic && line != "east,north")
    throw std::runtime_error(
        fmt::format("{}: line 1 is '{}' but must be east,north [m] or latitude,longitude [deg]", file, line));
  const LocalFrame frame(datum);
  std::vector<Vector<2>> points;
  for (int number = 2; std::getline(stream, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const auto pair = pairOf(line);
    if (!pair || (geodetic && std::abs((*pair)(0)) > 90))
      throw std::runtime_error(
          fmt::format("{}: line {} is '{}' but must be two numbers, a point on Earth", file, number, line));
    points.push_back(geodetic ? Vector<2>(frame.position_enu({(*pair)(0), (*pair)(1), datum.altitude}).head<2>())
                              : *pair);
    if (points.size() > 1 && points.back() == points[points.size() - 2]) points.pop_back();
  }
  if (points.size() < 2)
    throw std::runtime_error(fmt::format("{}: holds {} different points but a track needs two", file, points.size()));
  return points;
}

/// The pings along the scenario's track without noise, but with the variance of good noise.
Problem planned(const Scenario& scenario, const Config& config) {
  Problem problem{Model(config.mode), config.prior, {}, Vector<kChannels>::Ones()};
  for (const auto& labelled : simulatePings(scenario, 1)) {
    Ping ping = labelled.ping;
    ping.reading.value = Model().predict(scenario.truth, ping);
    ping.reading.variance /= scenario.stated_factor;
    ping.reading = problem.model.convert(ping.reading);
    problem.pings.push_back(ping);
  }
  return problem;
}

bool run(const Options& options) {
  Scenario scenario = Scenario::fromFile(options.scenario);
  const auto settings = ros_side::UsblSettings::fromFile(options.config);
  Config config = settings.calibration;
  if (!options.mode.empty()) config.mode = modeFromName(options.mode);
  if (options.duration > 0) scenario.duration = options.duration;
  if (!options.track.empty()) {
    scenario.track.kind = Track::Kind::Waypoints;
    scenario.track.waypoints = readWaypoints(options.track, scenario.datum);
  }
  const Problem problem = planned(scenario, config);
  if (problem.pings.empty())
    throw std::runtime_error(fmt::format("{}: gives no ping in {} s; check usbl.rate and the duration",
                                         options.scenario, scenario.duration));
  Vector<kChannels> factor;
  for (int i = 0; i < kChannels; ++i) factor(i) = MeasurementInformation(scenario.noise[i]).factor();
  const Observability result = observability(problem, scenario.truth, factor);

  fmt::print("{}: {} pings in {} s at {} m/s, {}\n\n{:<20}{:>14}{:>14}\n", scenario.name, problem.pings.size(),
             scenario.duration, scenario.track.speed, modeName(config.mode), "", "known before", "bound after");
  for (const int i : result.unknowns) {
    const std::string name = fmt::format("{} [{}]", unknownNames()[i], ros_side::tableUnit(i));
    fmt::print("{:<20}{:>14.4f}{:>14.4f}\n", name, ros_side::inTableUnit(i, problem.prior.sigma(i)),
               ros_side::inTableUnit(i, result.bound(i)));
  }
  fmt::print("\nsingular values of the pings' information over the prior's: {:.3g}\n",
             fmt::join(result.singular_values, ", "));
  fmt::print("{}{}\n", result.observable ? "observable: " : "", result.verdict);
  return result.observable;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Says how well a track would tell the mounting of a USBL array: the Cramer-Rao bound of every unknown and "
      "whether all are seen.",
      "plan_track");
  app.footer(
      "The exit status is 0 where every unknown is seen, 3 where one is not, 1 where there is no answer, 2 for a wrong "
      "command line.");
  app.add_option("SCENARIO", options.scenario, "scenario with transponder, track and noise (YAML, system: usbl)")
      ->required();
  app.add_option("--track", options.track,
                 "waypoints instead of the scenario's track (CSV with the header east,north in metres from the datum, "
                 "or latitude,longitude)");
  app.add_option("--config", options.config,
                 "configuration with what is known before (YAML; default: built in, see config/usbl.yaml)");
  app.add_option("--mode", options.mode, "what of a direction is used, instead of the configuration's")
      ->check(CLI::IsMember(modeNames()));
  app.add_option("--duration", options.duration, "seconds, instead of the scenario's")->check(CLI::PositiveNumber);
  bool observable = true;
  const int status = runTool(app, argc, argv, [&] { observable = run(options); });
  return status == 0 && !observable ? kNotObservable : status;
}

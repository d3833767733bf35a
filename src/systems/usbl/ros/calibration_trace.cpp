// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "systems/usbl/ros/calibration_result.hpp"

namespace sas_motion::ros_side {

using namespace usbl;
using nlohmann::json;

namespace {

/// Rounds to six digits.
double shortened(double value) {
  if (value == 0 || !std::isfinite(value)) return value;
  const double unit = std::pow(10.0, 5 - std::floor(std::log10(std::abs(value))));
  return std::round(value * unit) / unit;
}

std::vector<double> states(const State& values) {
  std::vector<double> numbers;
  for (int i = 0; i < kStates; ++i) numbers.push_back(inTableUnit(i, values(i)));
  return numbers;
}

json traceOf(const Estimated& e, Stamp begin) {
  json trace;
  for (const auto& point : e.trace) {
    trace["t"].push_back(secondsBetween(begin, point.stamp));
    for (int i = 0; i < kStates; ++i) {
      trace["mean"][unknownNames()[i]].push_back(shortened(inTableUnit(i, point.mean(i))));
      trace["sigma"][unknownNames()[i]].push_back(shortened(inTableUnit(i, point.sigma(i))));
    }
  }
  return trace;
}

/// Residuals over the estimated noise, that noise over the stated one and the simulator's labels, by channel over time.
json residualsOf(const CalibrationResult& result, const Estimated& e) {
  const Comparison& comparison = result.comparison;
  const auto channels = channelNames(comparison.problem.model.mode());
  json columns;
  for (std::size_t i = 0; i < comparison.problem.pings.size(); ++i) {
    const Vector<kChannels> whitened = whitenedResidual(comparison, e, i);
    const auto label = result.recording.outlier.find(comparison.problem.pings[i].stamp);
    for (int c = 0; c < kChannels; ++c) {
      const bool has = comparison.problem.pings[i].reading.has(c);
      auto& channel = columns[channels[c]];
      channel["residual"].push_back(has ? json(shortened(whitened(c))) : json());
      channel["noise"].push_back(shortened(e.noise[i](c)));
      if (!result.recording.outlier.empty())
        channel["outlier"].push_back(label != result.recording.outlier.end() && label->second[c]);
    }
  }
  return columns;
}

json estimatorOf(const CalibrationResult& result, const Estimated& e, Stamp begin) {
  if (!e.failure.empty()) return {{"failure", e.failure}};
  return {{"x", states(e.x.head<kStates>())},
          {"sigma", states(e.sigma().head<kStates>())},
          {"lock_ins", e.lock_ins},
          {"trace", traceOf(e, begin)},
          {"channels", residualsOf(result, e)}};
}

/// Position of the vessel from the transponder at each ping.
json pingsOf(const CalibrationResult& result, Stamp begin) {
  json pings;
  for (const auto& ping : result.comparison.problem.pings) {
    pings["t"].push_back(secondsBetween(begin, ping.stamp));
    pings["east"].push_back(shortened(-ping.transponder_map(0)));
    pings["north"].push_back(shortened(-ping.transponder_map(1)));
  }
  return pings;
}

}  // namespace

std::string calibrationTrace(const CalibrationResult& result) {
  const Comparison& comparison = result.comparison;
  const Stamp begin = comparison.problem.pings.front().stamp;
  json tree{{"schema", "sas_motion/calibration/1"},
            {"bag", result.bag},
            {"array", result.arrayFrame()},
            {"mode", modeName(comparison.problem.model.mode())}};
  tree["observable"] = comparison.observability.observable;
  tree["trusted"] = comparison.trusted();
  tree["conclusion"] = result.conclusion();
  tree["verdict"] = comparison.observability.verdict;
  tree["warnings"] = comparison.warnings;
  tree["channels"] = channelNames(comparison.problem.model.mode());
  tree["answer"] = comparison.best().name;
  tree["unknowns"] = std::vector<std::string>(unknownNames().begin(), unknownNames().begin() + kStates);
  tree["bound"] = states(comparison.observability.bound.head<kStates>());
  tree["singular_values"] = comparison.observability.singular_values;
  tree["nominal"] = result.recording.has_nominal;
  tree["measurements"] = result.recording.readings;
  tree["left_out"] = result.recording.left_out;
  if (const auto truth = result.truth()) tree["truth"] = states(*truth);
  tree["pings"] = pingsOf(result, begin);
  for (const auto& e : comparison.estimates) {
    tree["order"].push_back(e.name);
    tree["estimators"][e.name] = estimatorOf(result, e, begin);
  }
  return tree.dump() + "\n";
}

}  // namespace sas_motion::ros_side

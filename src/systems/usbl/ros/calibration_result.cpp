// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/usbl/ros/calibration_result.hpp"

#include <fmt/format.h>

#include "sas_motion/math/angles.hpp"

namespace sas_motion::ros_side {

using namespace usbl;

namespace {

constexpr int kName = 16, kColumn = 20;

std::string row(const std::string& name, const std::vector<std::string>& cells) {
  std::string text = fmt::format("{:<{}}", name, kName);
  for (const auto& cell : cells) text += fmt::format("{:>{}}", cell, kColumn);
  return text + "\n";
}

std::string nameOf(int unknown) { return fmt::format("{} [{}]", unknownNames()[unknown], tableUnit(unknown)); }

std::vector<std::string> names(const Comparison& comparison) {
  std::vector<std::string> all;
  for (const auto& estimated : comparison.estimates) all.push_back(estimated.name);
  return all;
}

std::string estimates(const CalibrationResult& result) {
  const Comparison& comparison = result.comparison;
  auto header = names(comparison);
  header.emplace_back("bound");
  std::string text = row("", header);
  for (const int i : comparison.observability.unknowns) {
    std::vector<std::string> cells;
    for (const auto& e : comparison.estimates) {
      const bool has = e.failure.empty() && e.sigma()(i) > 0;
      cells.push_back(has ? fmt::format("{:.4f} ± {:.4f}", inTableUnit(i, e.x(i)), inTableUnit(i, e.sigma()(i))) : "-");
    }
    cells.push_back(fmt::format("{:.4f}", inTableUnit(i, comparison.observability.bound(i))));
    text += row(nameOf(i), cells);
  }
  return text;
}

std::string errors(const CalibrationResult& result) {
  const auto truth = result.truth();
  if (!truth) return "";
  std::string text = "\nerror against truth, and in standard deviations\n" + row("", names(result.comparison));
  for (int i = 0; i < kStates; ++i) {
    std::vector<std::string> cells;
    for (const auto& e : result.comparison.estimates) {
      const double error = e.x(i) - (*truth)(i);
      cells.push_back(e.failure.empty() ? fmt::format("{:.4f} ({:+.1f})", inTableUnit(i, error), error / e.sigma()(i))
                                        : "-");
    }
    text += row(nameOf(i), cells);
  }
  return text;
}

std::string residuals(const CalibrationResult& result) {
  const Comparison& comparison = result.comparison;
  const auto channels = channelNames(comparison.problem.model.mode());
  std::string text =
      fmt::format("\nresiduals of {}; mean and rms without outliers [m, deg]\n", comparison.best().name) +
      row("", {"readings", "outliers", "mean", "rms", "noise over stated"});
  for (int i = 0; i < kChannels; ++i) {
    const ChannelStatistics s = channelStatistics(comparison, comparison.best(), i);
    const double unit = i == 0 || comparison.problem.model.mode() == Mode::DirectionCosines ? 1 : kRadPerDeg;
    text += row(channels[i],
                {fmt::format("{}", s.count), fmt::format("{}", s.outliers), fmt::format("{:.4f}", s.mean / unit),
                 fmt::format("{:.4f}", s.rms / unit), fmt::format("{:.3f}", s.noise)});
  }
  return text + fmt::format("pings with outliers, minute by minute: {}\n", fmt::join(result.outliersByMinute(), " "));
}

}  // namespace

double inTableUnit(int unknown, double value) { return isAngle(unknown) ? value / kRadPerDeg : value; }

const char* tableUnit(int unknown) { return isAngle(unknown) ? "deg" : unknown == kRangeScale ? "-" : "m"; }

std::optional<State> CalibrationResult::truth() const {
  if (!recording.truth) return std::nullopt;
  return correctionTo(*recording.truth, recording.nominal);
}

std::vector<std::size_t> CalibrationResult::outliersByMinute() const {
  const auto& pings = comparison.problem.pings;
  std::vector<std::size_t> counts;
  for (std::size_t i = 0; i < pings.size(); ++i) {
    const auto minute = static_cast<std::size_t>(secondsBetween(pings.front().stamp, pings[i].stamp) / 60);
    if (minute >= counts.size()) counts.resize(minute + 1);
    if (whitenedResidual(comparison, comparison.best(), i).cwiseAbs().maxCoeff() > kOutlier) ++counts[minute];
  }
  return counts;
}

std::string CalibrationResult::conclusion() const {
  const auto& observability = comparison.observability;
  if (!comparison.implausible.empty()) return "not to be trusted: " + comparison.implausible;
  if (!observability.observable) return observability.verdict;
  if (!comparison.agrees)
    return fmt::format(
        "not to be trusted: {} and batch disagree, their squared distance is {:.0f} where {:.1f} is the limit; it may "
        "have locked in to wrong readings",
        comparison.best().name, comparison.distance, agreementLimit());
  const bool alone = comparison.best().name == "batch";
  return fmt::format("observable: {}{}", observability.verdict,
                     alone ? "" : fmt::format("; {} and batch agree", comparison.best().name));
}

std::string calibrationTable(const CalibrationResult& result) {
  const Comparison& comparison = result.comparison;
  std::string text =
      fmt::format("{}: {} pings of {} measurements of {}, {}{}\n\n", result.bag, comparison.problem.pings.size(),
                  result.recording.readings, result.arrayFrame(), modeName(comparison.problem.model.mode()),
                  result.recording.has_nominal ? "; corrections of the nominal mounting" : "");
  text += estimates(result) + errors(result) + residuals(result);
  for (const auto* counts : {&result.recording.left_out, &result.recording.refused})
    for (const auto& [reason, number] : *counts) text += fmt::format("left out: {} {}\n", number, reason);
  for (const auto& e : comparison.estimates) {
    if (e.lock_ins > 0) text += fmt::format("{}: had locked in and started anew, times: {}\n", e.name, e.lock_ins);
    if (!e.failure.empty()) text += fmt::format("failed: {}\n", e.failure);
  }
  text += fmt::format("singular values of the pings' information over the prior's: {:.3g}\n",
                      fmt::join(comparison.observability.singular_values, ", "));
  for (const auto& warning : comparison.warnings) text += fmt::format("mind: {}\n", warning);
  return text + result.conclusion() + "\n";
}

}  // namespace sas_motion::ros_side

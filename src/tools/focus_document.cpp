// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "focus_result.hpp"
#include "sas_motion/math/angles.hpp"

namespace sas_motion {

using namespace imaging;
using nlohmann::json;

namespace {

json toJson(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

json toJson(const CutMeasures& cut) {
  return {{"irw", cut.irw}, {"pslr", cut.pslr}, {"islr", cut.islr}, {"main_lobe", cut.main_lobe}, {"extent", cut.extent}, {"complete", cut.complete}};
}

json toJson(const PointTargetMeasures& target) {
  json entry{{"complete", target.complete}};
  if (!target.complete) return entry;
  entry.update({{"range", toJson(target.range)}, {"along", toJson(target.along)}, {"peak_loss", target.peak_loss}, {"peak_error", target.peak_error}});
  return entry;
}

json toJson(const FocusImage& image) {
  json entry{{"image", image.stem + ".npy"}, {"entropy", image.entropy}, {"whole_image_islr", image.whole_image_islr}, {"targets", json::array()}};
  for (const auto& target : image.targets) entry["targets"].push_back(toJson(target));
  return entry;
}

json toJson(const FocusedTrajectory& trajectory, double wavelength) {
  json entry = toJson(trajectory.image);
  const auto& error = trajectory.error;
  entry["topic"] = trajectory.topic;
  for (const auto& [name, trend] : {std::pair("line_of_sight", error.line_of_sight), std::pair("along", error.along), std::pair("path", error.path)}) {
    entry["aperture_error"][name] = trend.rms;
    entry["aperture_error"][std::string(name) + "_wavelengths"] = trend.rms / wavelength;
  }
  entry["image_shift"] = toJson(error.image_shift);
  if (trajectory.autofocused) entry["autofocused"] = toJson(*trajectory.autofocused);
  return entry;
}

json windowJson(const FocusWindow& window) {
  return {{"start", window.start},
          {"duration", window.duration},
          {"speed", window.speed},
          {"length", window.speed * window.duration},
          {"ping_rate", window.ping_rate},
          {"pings", window.pings},
          {"origin_map", toJson(window.frame.origin_map)},
          {"yaw_deg", window.frame.yaw / kRadPerDeg}};
}

std::string tableRow(const std::string& name, const ApertureTrajectoryError& error, double wavelength, const PointTargetMeasures& target, double entropy) {
  std::string row =
      fmt::format("{:<24}{:>9.4f}{:>9.4f}{:>9.4f}{:>8.3f}", name, error.line_of_sight.rms, error.along.rms, error.path.rms, error.path.rms / wavelength);
  if (!target.complete) return row + "   no peak whose side lobes lie inside the image\n";
  const auto cut = [](const CutMeasures& c) {
    return fmt::format("{:>8.3f}{:>7.1f}{:>7.1f}{:>7.2f}{}", c.irw, c.pslr, c.islr, c.extent, c.complete ? ' ' : '*');
  };
  return row + fmt::format("{}{}{:>7.1f}{:>8.2f}{:>8.2f}\n", cut(target.along), cut(target.range), target.peak_loss, target.peak_error, entropy);
}

/// Aperture errors are RMS without mean and trend.
std::string tableHead() {
  const std::string cut = fmt::format("{:>8}{:>7}{:>7}{:>7} ", "IRW", "PSLR", "ISLR", "extent"),
                    unit = fmt::format("{:>8}{:>7}{:>7}{:>7} ", "m", "dB", "dB", "m");
  return fmt::format("{:<24}{:-^35}{:-^30}{:-^30}{:-^15}\n", "", " aperture error ", " cut along track ", " cut in range ", " peak ") +
         fmt::format("{:<24}{:>9}{:>9}{:>9}{:>8}{}{}{:>7}{:>8}{:>8}\n", "trajectory", "sight", "along", "path", "path", cut, cut, "loss", "error", "entropy") +
         fmt::format("{:<24}{:>9}{:>9}{:>9}{:>8}{}{}{:>7}{:>8}{:>8}\n", "", "m", "m", "m", "lambda", unit, unit, "dB", "m", "nat");
}

}  // namespace

std::string focusDocument(const FocusResult& result) {
  const double wavelength = result.settings.sonar.wavelength();
  json all{{"schema", "sas_motion/focus/1"}, {"bag", result.bag}, {"window", windowJson(result.window)}, {"wavelength", wavelength}};
  const auto places = targetPlaces(result.settings);
  for (std::size_t i = 0; i < places.size(); ++i) all["targets"].push_back({{"range", result.settings.targets[i].range}, {"place", toJson(places[i])}});
  for (const auto& trajectory : result.trajectories) {
    all["order"].push_back(trajectory.name);
    all["trajectories"][trajectory.name] = toJson(trajectory, wavelength);
  }
  return all.dump(2) + "\n";
}

std::string focusTable(const FocusResult& result) {
  const FocusWindow& window = result.window;
  const double wavelength = result.settings.sonar.wavelength();
  std::string text = fmt::format("{}: {:.2f} s from {:.2f} s at {:.2f} m/s: {:.1f} m of aperture, {} pings, wavelength {:.4g} m\n", result.bag, window.duration,
                                 window.start, window.speed, window.speed * window.duration, window.pings, wavelength);
  for (std::size_t i = 0; i < result.settings.targets.size(); ++i) {
    text += fmt::format("\ntarget at {} m\n{}", result.settings.targets[i].range, tableHead());
    for (const auto& t : result.trajectories) {
      text += tableRow(t.name, t.error, wavelength, t.image.targets[i], t.image.entropy);
      if (t.autofocused) text += tableRow("  autofocused", t.error, wavelength, t.autofocused->targets[i], t.autofocused->entropy);
    }
  }
  const auto cut_off = [](const FocusedTrajectory& t) {
    return std::any_of(t.image.targets.begin(), t.image.targets.end(), [](const auto& m) { return m.complete && !(m.along.complete && m.range.complete); });
  };
  if (std::any_of(result.trajectories.begin(), result.trajectories.end(), cut_off))
    text += "* the main lobe or the extent reaches over the chip: what is missing is left out\n";
  return text;
}

}  // namespace sas_motion

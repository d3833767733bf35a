// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "sas_motion/math/angles.hpp"
#include "tools/focus_steps.hpp"

namespace sas_motion {

using namespace imaging;
using nlohmann::json;

namespace {

json toJson(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

json toJson(const CutMeasures& cut) {
  return {{"irw", cut.irw},       {"pslr", cut.pslr},        {"islr", cut.islr}, {"main_lobe", cut.main_lobe},
          {"extent", cut.extent}, {"complete", cut.complete}};
}

json toJson(const PointTargetMeasures& target) {
  json entry{{"complete", target.complete}};
  if (!target.complete) return entry;
  entry.update({{"range", toJson(target.range)},
                {"along", toJson(target.along)},
                {"peak_loss", target.peak_loss},
                {"peak_error", target.peak_error}});
  return entry;
}

json toJson(const FocusImage& image) {
  json entry{{"image", image.stem + ".npy"},
             {"entropy", image.entropy},
             {"whole_image_islr", image.whole_image_islr},
             {"targets", json::array()}};
  for (const auto& target : image.targets) entry["targets"].push_back(toJson(target));
  return entry;
}

json toJson(const FocusedTrajectory& trajectory, double wavelength) {
  json entry = toJson(trajectory.image);
  const auto& error = trajectory.error;
  entry["topic"] = trajectory.topic;
  for (const auto& [name, trend] : {std::pair("line_of_sight", error.line_of_sight), std::pair("along", error.along),
                                    std::pair("path", error.path)}) {
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

std::string errorCells(const ApertureTrajectoryError& error, double wavelength) {
  return fmt::format("{:>9.4f}{:>9.4f}{:>9.4f}{:>8.3f}", error.line_of_sight.rms, error.along.rms, error.path.rms,
                     error.path.rms / wavelength);
}

std::string measureCells(const PointTargetMeasures& target, double entropy) {
  if (!target.complete) return "   no peak whose side lobes lie inside the image\n";
  const auto cut = [](const CutMeasures& c) {
    return fmt::format("{:>8.3f}{:>7.1f}{:>7.1f}{:>7.2f}{}", c.irw, c.pslr, c.islr, c.extent, c.complete ? ' ' : '*');
  };
  return fmt::format("{}{}{:>7.1f}{:>8.2f}{:>8.2f}\n", cut(target.along), cut(target.range), target.peak_loss,
                     target.peak_error, entropy);
}

/// Aperture errors are RMS without mean and trend.
std::string tableHead() {
  const std::string cut = fmt::format("{:>8}{:>7}{:>7}{:>7} ", "IRW", "PSLR", "ISLR", "extent"),
                    unit = fmt::format("{:>8}{:>7}{:>7}{:>7} ", "m", "dB", "dB", "m");
  return fmt::format("{:<24}{:-^35}{:-^30}{:-^30}{:-^15}\n", "", " aperture error ", " cut along track ",
                     " cut in range ", " peak ") +
         fmt::format("{:<24}{:>9}{:>9}{:>9}{:>8}{}{}{:>7}{:>8}{:>8}\n", "trajectory", "sight", "along", "path", "path",
                     cut, cut, "loss", "error", "entropy") +
         fmt::format("{:<24}{:>9}{:>9}{:>9}{:>8}{}{}{:>7}{:>8}{:>8}\n", "", "m", "m", "m", "lambda", unit, unit, "dB",
                     "m", "nat");
}

}  // namespace

std::string focusDocument(const FocusResult& result) {
  const double wavelength = result.settings.sonar.wavelength();
  json all{{"schema", "sas_motion/focus/1"},
           {"bag", result.bag},
           {"window", windowJson(result.window)},
           {"wavelength", wavelength}};
  for (std::size_t i = 0; i < result.places.size(); ++i)
    all["targets"].push_back({{"range", result.settings.targets[i].range}, {"place", toJson(result.places[i])}});
  for (const auto& trajectory : result.trajectories) {
    all["order"].push_back(trajectory.name);
    all["trajectories"][trajectory.name] = toJson(trajectory, wavelength);
  }
  return all.dump(2) + "\n";
}

std::string focusTable(const FocusResult& result) {
  const FocusWindow& window = result.window;
  const double wavelength = result.settings.sonar.wavelength();
  const std::string text = fmt::format(
      "{}: {:.2f} s from {:.2f} s at {:.2f} m/s: {:.1f} m of aperture, {} pings, wavelength {:.4g} m\n", result.bag,
      window.duration, window.start, window.speed, window.speed * window.duration, window.pings, wavelength);
  std::string tables;
  for (std::size_t i = 0; i < result.settings.targets.size(); ++i) {
    tables += fmt::format("\ntarget at {} m\n{}", result.settings.targets[i].range, tableHead());
    for (const auto& t : result.trajectories) {
      tables += fmt::format("{:<24}{}{}", t.name, errorCells(t.error, wavelength),
                            measureCells(t.image.targets[i], t.image.entropy));
      if (t.autofocused)
        tables +=
            fmt::format("{:<59}{}", "  autofocused", measureCells(t.autofocused->targets[i], t.autofocused->entropy));
    }
  }
  if (tables.find('*') != std::string::npos)
    tables += "* the main lobe or the extent reaches over the chip: what is missing is left out\n";
  return text + tables;
}

}  // namespace sas_motion

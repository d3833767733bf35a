// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "sas_motion/math/angles.hpp"
#include "systems/usbl/ros/calibration_result.hpp"

namespace sas_motion::ros_side {

using namespace usbl;

namespace {

std::string quoted(const std::string& text) { return nlohmann::json(text).dump(); }  // a JSON string is one of YAML

template <class Numbers>
std::string list(const Numbers& numbers) {
  std::vector<std::string> texts;
  for (const double x : numbers) texts.push_back(fmt::format("{:.9g}", x));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

/// A list in the table's units.
std::string part(const Unknowns& values, int first, int count) {
  std::vector<double> numbers;
  for (int i = first; i < first + count; ++i) numbers.push_back(inTableUnit(i, values(i)));
  return list(numbers);
}

/// Roll, pitch and yaw about fixed axes forward, port, up, as URDF has them [rad].
Vector<3> rpyOf(const Matrix<3>& R) {
  return {std::atan2(R(2, 1), R(2, 2)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0)), std::atan2(R(1, 0), R(0, 0))};
}

std::string staticTransform(const CalibrationResult& result) {
  const Transform T = transformOf(result.mounting());
  const Vector<3> xyz = T.translation(), rpy = rpyOf(T.linear());
  const std::string parent = result.settings.base_frame, child = result.arrayFrame();
  const std::string words = fmt::format("{:.6f} {:.6f} {:.6f}", xyz(0), xyz(1), xyz(2));
  return fmt::format(
      "static_transform:             # {0} to {1}; REP-103: forward, port, up\n"
      "  parent: {2}\n  child: {3}\n"
      "  xyz: {4}   # [m]\n"
      "  rpy: {5}   # about forward, port, up, fixed axes [rad]\n"
      "  urdf: {6}\n"
      "  launch: {7}\n",
      parent, child, quoted(parent), quoted(child), list(std::vector<double>{xyz(0), xyz(1), xyz(2)}),
      list(std::vector<double>{rpy(0), rpy(1), rpy(2)}),
      quoted(fmt::format("<origin xyz=\"{}\" rpy=\"{:.8f} {:.8f} {:.8f}\"/>", words, rpy(0), rpy(1), rpy(2))),
      quoted(fmt::format("<node pkg=\"tf2_ros\" type=\"static_transform_publisher\" name=\"{}_broadcaster\" args=\"{} "
                         "{:.8f} {:.8f} {:.8f} {} {}\"/>",
                         child, words, rpy(2), rpy(1), rpy(0), parent, child)));
}

std::string mountingOf(const Mounting& mounting) {
  const Attitude angles = attitudeOf(mounting.C_body_array);
  const Vector<3> ros = transformOf(mounting).translation();
  return fmt::format(
      "angles_deg:                   # of the whole mounting\n"
      "  pitch: {:.9g}               # about starboard, bow up\n  roll: {:.9g}                # about forward, "
      "starboard down\n"
      "  heading: {:.9g}             # about up, clockwise\n"
      "lever_arm:                    # of the whole mounting, reference point to acoustic centre [m]\n"
      "  starboard_forward_up: {}\n  forward_port_up: {}   # REP-103\n",
      angles.pitch / kRadPerDeg, angles.roll / kRadPerDeg, angles.heading / kRadPerDeg, list(mounting.lever_arm_body),
      list(ros));
}

std::string covariance(const Matrix<kUnknowns>& P) {
  std::string text =
      "covariance:                   # of the correction's pitch, roll, heading, starboard, forward, up [rad, m]\n";
  for (int row = 0; row < kStates; ++row)
    text += fmt::format("  - {}\n", list(std::vector<double>(P.row(row).begin(), P.row(row).begin() + kStates)));
  return text;
}

std::string estimator(const Comparison& comparison, const Estimated& e) {
  std::string text = fmt::format("  {}:\n", e.name);
  if (!e.failure.empty()) return text + fmt::format("    failure: {}\n", quoted(e.failure));
  const Unknowns sigma = e.sigma();
  text += fmt::format(
      "    angles_deg: {}\n    angles_sigma_deg: {}\n    lever_arm: {}\n    lever_arm_sigma: {}\n    lock_ins: {}\n",
      part(e.x, 0, 3), part(sigma, 0, 3), part(e.x, 3, 3), part(sigma, 3, 3), e.lock_ins);
  if (sigma(kTransponderX) > 0)
    text += fmt::format("    transponder: {}\n    transponder_sigma: {}\n", part(e.x, kTransponderX, 3),
                        part(sigma, kTransponderX, 3));
  if (sigma(kRangeScale) > 0)
    text +=
        fmt::format("    range_scale: {:.9g}\n    range_scale_sigma: {:.9g}\n", e.x(kRangeScale), sigma(kRangeScale));
  std::vector<double> noise;
  for (int i = 0; i < kChannels; ++i) noise.push_back(channelStatistics(comparison, e, i).noise);
  return text + fmt::format("    noise_over_stated: {}\n", list(noise));
}

std::string residuals(const CalibrationResult& result) {
  const auto channels = channelNames(result.comparison.problem.model.mode());
  std::string text = fmt::format("residuals:                    # of {}; mean and rms without outliers [m, rad]\n",
                                 result.comparison.best().name);
  for (int i = 0; i < kChannels; ++i) {
    const ChannelStatistics s = channelStatistics(result.comparison, result.comparison.best(), i);
    text += fmt::format("  {}: {{readings: {}, outliers: {}, mean: {:.6g}, rms: {:.6g}, noise_over_stated: {:.6g}}}\n",
                        channels[i], s.count, s.outliers, s.mean, s.rms, s.noise);
  }
  return text + fmt::format("outliers_by_minute: [{}]   # pings\n", fmt::join(result.outliersByMinute(), ", "));
}

std::string observability(const Observability& o) {
  std::vector<std::string> names;
  std::vector<double> bound;
  for (const int i : o.unknowns) {
    names.push_back(unknownNames()[i]);
    bound.push_back(inTableUnit(i, o.bound(i)));
  }
  return fmt::format(
      "observability:\n  unknowns: [{}]\n  bound: {}   # Cramer-Rao bound [deg, m, -]\n"
      "  singular_values: {}   # of the pings' information over the prior's\n  weak_direction: {}\n  weak_sigma: {}   "
      "# what the pings alone know of it, over what the prior does\n",
      fmt::join(names, ", "), list(bound), list(o.singular_values), list(o.weak_direction),
      std::isfinite(o.weak_sigma) ? fmt::format("{:.6g}", o.weak_sigma) : ".inf");
}

std::string counts(const std::string& key, const std::map<std::string, std::uint64_t>& numbers) {
  if (numbers.empty()) return key + ": {}\n";
  std::string text = key + ":\n";
  for (const auto& [reason, number] : numbers) text += fmt::format("  {}: {}\n", quoted(reason), number);
  return text;
}

}  // namespace

std::string calibrationDocument(const CalibrationResult& result) {
  const Comparison& comparison = result.comparison;
  const Estimated& best = comparison.best();
  std::string text = fmt::format(
      "# A USBL calibration. Where trusted is false, its figures are not to be used, and there is no "
      "static_transform.\n"
      "bag: {}\nmode: {}\narray: {}\n"
      "observable: {}\nagrees_with_batch: {}   # an estimator that has locked in does not\nplausible: {}   # most "
      "readings agree with it\ntrusted: {}\n"
      "conclusion: {}\nverdict: {}\nestimator: {}                # whose answer this is\n",
      quoted(result.bag), modeName(comparison.problem.model.mode()), quoted(result.arrayFrame()),
      comparison.observability.observable, comparison.agrees, comparison.implausible.empty(), comparison.trusted(),
      quoted(result.conclusion()), quoted(comparison.observability.verdict), best.name);
  text += mountingOf(result.mounting());
  const Unknowns sigma = best.sigma();
  text += fmt::format(
      "sigma:                        # of both\n  angles_deg: {}   # pitch, roll, heading\n  lever_arm: {}   # "
      "starboard, forward, up [m]\n",
      part(sigma, 0, 3), part(sigma, 3, 3));
  if (comparison.trusted()) text += staticTransform(result);
  text += fmt::format(
      "nominal: {}                # whether the bag had a nominal mounting; correction is what was found of it\n",
      result.recording.has_nominal);
  text += fmt::format("correction: {{angles_deg: {}, lever_arm: {}}}\n", part(best.x, 0, 3), part(best.x, 3, 3)) +
          covariance(best.covariance);
  if (const auto truth = result.truth())
    text += fmt::format("truth: {{angles_deg: {}, lever_arm: {}}}   # of the correction, from the simulator\n",
                        part(Model::widened(*truth), 0, 3), part(Model::widened(*truth), 3, 3));
  text += "estimators:                   # all of them, as corrections [deg, m]\n";
  for (const auto& e : comparison.estimates) text += estimator(comparison, e);
  text += residuals(result) + observability(comparison.observability);
  text += fmt::format("pings: {}\nmeasurements: {}\n", comparison.problem.pings.size(), result.recording.readings);
  text += counts("left_out", result.recording.left_out) + counts("refused", result.recording.refused);
  std::vector<std::string> warnings;
  for (const auto& warning : comparison.warnings) warnings.push_back(quoted(warning));
  return text + fmt::format("warnings: [{}]\n", fmt::join(warnings, ", "));
}

}  // namespace sas_motion::ros_side

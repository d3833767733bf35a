// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sas_motion/config/yaml_section.hpp"
#include "sas_motion/math/angles.hpp"
#include "sas_motion/math/random.hpp"
#include "sas_motion/navigation/attitude.hpp"
#include "sas_motion/navigation/local_frame.hpp"
#include "sas_motion/noise/noise_law.hpp"
#include "sas_motion/noise/noise_source.hpp"
#include "sas_motion/systems/usbl/model.hpp"

namespace sas_motion::usbl {

/// The vessel's track, east and north of the datum [m].
struct Track {
  enum class Kind { FigureEight, Circle, Waypoints };
  Kind kind = Kind::FigureEight;
  Vector<2> centre = Vector<2>::Zero();  ///< of the circle, or the crossing of the figure-eight
  double radius = 112;                   ///< of the circle or of each half of the figure-eight [m]
  double heading = 0;                    ///< at the crossing of the figure-eight [rad]
  std::vector<Vector<2>> waypoints;      ///< sailed again and again
  double turn_rate = 4 * kRadPerDeg;     ///< between waypoints [rad/s]
  double speed = 2;                      ///< [m/s]
};

/// A simulated calibration: vessel, array, transponder and noise. Defaults are the paper's where it prints them.
/// [ZhangTao]
struct Scenario {
  std::string name;
  double duration = 1000;  ///< [s]
  Geodetic datum{32.1459, 118.7718, 32};
  Track track;
  double wave_pitch = 2 * kRadPerDeg, wave_roll = 4 * kRadPerDeg;  ///< amplitudes [rad]
  double wave_period = 8;                                          ///< of roll; pitch has a fifth less [s]

  Unknowns truth = defaultTruth();                    ///< mounting, lever arm, error of the survey, range scale
  Vector<3> transponder_map{-100, 200, -100};         ///< as surveyed; east, north, up of the datum [m]
  Vector<3> gnss_lever_arm_body = Vector<3>::Zero();  ///< antenna from the reference point; starboard, forward, up [m]

  double ping_rate = 1;                            ///< [1/s]
  double range_sigma = 0.2;                        ///< [m]
  double direction_sigma = 0.2 * kRadPerDeg;       ///< [rad]
  double stated_factor = 1;                        ///< stated variance over the true one [-]
  std::array<NoiseMix, kChannels> noise;           ///< by channel
  double gnss_rate = 5;                            ///< [1/s]
  double gnss_sigma = 0.02, gnss_sigma_up = 0.04;  ///< [m]
  double attitude_rate = 20;                       ///< [1/s]
  double attitude_sigma = 0.01 * kRadPerDeg;       ///< pitch and roll [rad]
  double heading_sigma = 0.03 * kRadPerDeg;        ///< [rad]

  static Unknowns defaultTruth();
  /// Throws ConfigError.
  static Scenario fromFile(const std::string& file);
  static Scenario read(YamlSection yaml);
};

constexpr Stamp kScenarioStart = 1'600'000'000 * kNanosecondsPerSecond;  ///< stamp of every scenario's start

/// Pose of the vessel's reference point.
struct Pose {
  Vector<3> position_map = Vector<3>::Zero();  ///< east, north, up of the datum [m]
  Attitude attitude;
};

/// A ping with the labels of each channel's noise for oracles.
struct LabelledPing {
  Ping ping;
  std::array<bool, kChannels> outlier{};
  Vector<kChannels> variance = Vector<kChannels>::Ones();  ///< of this draw, over the good one [-]
};

/// The pose along the track at a time since the start [s]; the map axes are those at the datum.
class Vessel {
 public:
  explicit Vessel(const Scenario& scenario);
  /// Times must not fall on a track of waypoints.
  Pose at(double time);

 private:
  void followWaypoints(double time);

  Scenario scenario_;
  Pose pose_;          // of waypoints
  double sailed_ = 0;  // time of pose_ [s]
  std::size_t next_ = 1;
};

/// Draws the sensors' readings. Each sensor has its own stream of noise, so the pings do not depend on the rate of
/// GNSS. The same scenario and seed give the same numbers.
class Simulator {
 public:
  Simulator(const Scenario& scenario, std::uint64_t seed);

  /// The reading at a true pose; nothing where the reply is lost. Times must rise.
  std::optional<LabelledPing> ping(double time, const Pose& truth);
  Pose measuredAttitude(const Pose& truth);      ///< with the attitude's noise
  Vector<3> measuredAntenna(const Pose& truth);  ///< the GNSS antenna's position with its noise; map [m]

  const LocalFrame& frame() const { return frame_; }
  const Geodetic& transponder() const { return transponder_; }  ///< as surveyed

 private:
  Scenario scenario_;
  LocalFrame frame_;
  Geodetic transponder_;
  std::vector<NoiseSource> channels_;
  Random attitude_noise_, gnss_noise_;
};

/// All pings of a scenario, each with the vessel's pose as measured at the ping's own stamp.
std::vector<LabelledPing> simulatePings(const Scenario& scenario, std::uint64_t seed);

/// From a position to the surveyed transponder, in the axes east, north, up at that position [m].
Vector<3> transponderFrom(const Geodetic& position, const Geodetic& transponder);

}  // namespace sas_motion::usbl

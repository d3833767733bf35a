// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sas_motion/config/yaml_section.hpp"
#include "sas_motion/math/angles.hpp"
#include "sas_motion/navigation/local_frame.hpp"
#include "sas_motion/noise/noise_law.hpp"
#include "sas_motion/systems/usbl/model.hpp"

namespace sas_motion::usbl {

/// Where the vessel sails, east and north of the datum [m].
struct Track {
  enum class Kind { FigureEight, Circle, Waypoints };
  Kind kind = Kind::FigureEight;
  Vector<2> centre = Vector<2>::Zero();  ///< of the circle, or where the figure-eight crosses itself
  double radius = 112;                   ///< of the circle, or of each half of the figure-eight [m]
  double heading = 0;                    ///< at the crossing of the figure-eight [rad]
  std::vector<Vector<2>> waypoints;      ///< sailed round and round
  double turn_rate = 4 * kRadPerDeg;     ///< between waypoints [rad/s]
  double speed = 2;                      ///< [m/s]
};

/// A calibration at sea: the vessel, the array, the transponder and their noise. [ZhangTao; defaults of the paper where
/// it prints them]
struct Scenario {
  std::string name;
  double duration = 1000;  ///< [s]
  Geodetic datum{32.1459, 118.7718, 32};
  Track track;
  double wave_pitch = 2 * kRadPerDeg, wave_roll = 4 * kRadPerDeg;  ///< amplitudes [rad]
  double wave_period = 8;                                          ///< of roll; pitch is faster by a quarter [s]

  Unknowns truth = defaultTruth();                    ///< mounting, lever arm, error of the survey, range scale
  Vector<3> transponder_map{-100, 200, -100};         ///< as surveyed; east, north, up of the datum [m]
  Vector<3> gnss_lever_arm_body = Vector<3>::Zero();  ///< antenna from the reference point; starboard, forward, up [m]

  double ping_rate = 1;                            ///< [1/s]
  double range_sigma = 0.2;                        ///< [m]
  double direction_sigma = 0.2 * kRadPerDeg;       ///< [rad]
  double stated_factor = 1;                        ///< variance that messages state, over the true one
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

}  // namespace sas_motion::usbl

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sas_motion/navigation/local_frame.hpp"
#include "sas_motion/noise/noise_law.hpp"
#include "sas_motion/systems/towfish/model.hpp"

namespace sas_motion::towfish {

/// When a simulated sensor measures, and with what noise. Rate 0 means that there is none.
struct SimulatedSensor {
  double rate = 0;   ///< [1/s]
  double phase = 0;  ///< of its first measurement after the start [s]
  double sigma = 1;  ///< standard deviation of the good noise [m, rad, m/s, rad/s]
  NoiseMix noise;
};

/// A simulated instrument.
struct SimulatedSource : SimulatedSensor {
  Sensor sensor = Sensor::Position;
  std::string name;                              ///< of the source; empty: the sensor's
  std::string topic, frame;                      ///< of its messages in a bag
  Vector<2> lever_arm_body = Vector<2>::Zero();  ///< of a position's antenna from base_link: forward, starboard [m]
  double time_offset = 0;                        ///< added to its stamps in a bag [s]
};

/// A change of the current while the vessel crosses a front.
struct CurrentFront {
  double time = -1;                      ///< of its middle; negative for none [s]
  double width = 20;                     ///< duration of the crossing [s]
  Vector<2> change = Vector<2>::Zero();  ///< north, east [m/s]
};

/// What a simulated survey is like. `random_walk` draws truth from the motion model; `survey` sails parallel lines with
/// turns at the ends.
struct Scenario {
  enum class Kind { RandomWalk, Survey };

  std::string name;
  double duration = 600;  ///< [s]
  double step = 0.01;     ///< of the truth; periods and phases of sensors are multiples of it [s]
  Geodetic datum{54.35, 10.15, 0};
  Kind kind = Kind::RandomWalk;
  double heading = 0;                     ///< at the start [rad]
  double speed = 2;                       ///< at the start; through the water [m/s]
  MotionParameters motion;                ///< of the random walk, and of the current in both kinds
  NoiseMix process;                       ///< of the random walk's noise
  Vector<2> current = Vector<2>::Zero();  ///< at the start; north, east [m/s]
  CurrentFront front;

  double line_length = 400;           ///< survey: distance through the water between turns [m]
  double turn_rate = 3 * kRadPerDeg;  ///< survey: in the turns [rad/s]
  double yaw_sigma = 1 * kRadPerDeg;  ///< survey: by the waves [rad]
  double yaw_period = 9;              ///< survey: of the waves [s]
  double surge_sigma = 0.05;          ///< survey: of the speed [m/s]

  std::vector<SimulatedSource> sources;  ///< the default one of each Sensor, then others

  Scenario();
  /// The default source of a sensor.
  SimulatedSource& source(Sensor which) { return sources[static_cast<std::size_t>(which)]; }
  SimulatedSensor& sensor(Sensor which) { return source(which); }
  const SimulatedSensor& sensor(Sensor which) const { return sources[static_cast<std::size_t>(which)]; }

  /// Throws ConfigError.
  static Scenario read(YamlSection yaml);
  static Scenario fromFile(const std::string& file) { return read(YamlSection::fromFile(file)); }
};

}  // namespace sas_motion::towfish

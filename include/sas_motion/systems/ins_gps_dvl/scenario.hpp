// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sas_motion/config/yaml_section.hpp"
#include "sas_motion/noise/noise_law.hpp"
#include "sas_motion/systems/ins_gps_dvl/model.hpp"
#include "sas_motion/systems/ins_gps_dvl/trajectory.hpp"

namespace sas_motion::ins {

/// A time without readings: under water there is no GPS.
struct Outage {
  double begin = 0, end = 0;  ///< first and last moment without [s]
};

/// A survey with INS, GPS, DVL, a depth gauge and, where asked for, micronavigation.
struct Scenario {
  struct Readings {
    double rate = 1;  ///< [1/s]; 0: there is no such sensor
    NoiseMix noise;   ///< law of the white noise, row by row
    std::vector<Outage> outages;
  };

  std::string name;
  double duration = 1200;  ///< [s]
  Track track;
  Parameters parameters;
  double imu_rate = 100;  ///< [1/s]
  std::array<Readings, kSensors> sensors{Readings{1, {}, {}}, Readings{5, {}, {}}, Readings{1, {}, {}},
                                         Readings{0, {}, {}}};  ///< by Sensor
  /// Micronavigation from each ping to the next; its rate is that of pings.
  struct Dpc {
    double white_along = 2e-3, white_sight = 0.2e-3;  ///< [m/s]
    double depression = 20 * kRadPerDeg;              ///< of the line of sight below the body's plane [rad]
    bool starboard = true;                            ///< looks there, else to port

    Vector<3> sightBody() const;  ///< starboard, forward, up
  };
  Dpc dpc;

  Readings& sensor(Sensor which) { return sensors[static_cast<std::size_t>(which)]; }
  const Readings& sensor(Sensor which) const { return sensors[static_cast<std::size_t>(which)]; }

  /// Throws ConfigError.
  static Scenario fromFile(const std::string& file);
  static Scenario read(YamlSection yaml);
  /// The section `dpc`, over what is there.
  void readDpc(YamlSection yaml);
  /// The law under `key`; every one but quantised.
  static NoiseMix readNoise(YamlSection& owner, const std::string& key);
  /// Outages under `key`: a list of {begin, end}.
  static std::vector<Outage> readOutages(YamlSection& owner, const std::string& key);
};

/// A file's keys start, track and waves. Throws ConfigError.
void readTrack(YamlSection& yaml, Track& track);

}  // namespace sas_motion::ins

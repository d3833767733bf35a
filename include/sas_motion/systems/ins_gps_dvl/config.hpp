// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "sas_motion/config/yaml_section.hpp"
#include "sas_motion/systems/ins_gps_dvl/aligned_estimator.hpp"

namespace sas_motion::ins {

/// How a sensor's messages are taken.
struct MessageOptions {
  Vector<3> white = Vector<3>::Zero();  ///< standard deviations where the message states none [m, m/s]
  double floor = 0;                     ///< the smallest standard deviation taken from a message [m, m/s]
  bool override_message = false;        ///< use the configured noise whatever the message states
  double time_offset = 0;               ///< added to the message's stamp [s]
  bool enabled = true;
};

/// Everything that decides an estimate beside the messages.
struct Settings {
  Settings();

  SessionOptions session;
  std::array<MessageOptions, kSensors> messages;  ///< by Sensor
  double imu_time_offset = 0;                     ///< added to the stamps of the IMU [s]
  double surface = 0;       ///< height of the water's surface above the ellipsoid: depths are below it [m]
  double output_rate = 50;  ///< of estimates [1/s]

  MessageOptions& of(Sensor sensor) { return messages[static_cast<std::size_t>(sensor)]; }
  const MessageOptions& of(Sensor sensor) const { return messages[static_cast<std::size_t>(sensor)]; }
};

/// Reads the sections imu, gps, dvl, depth, start, estimators and the keys beside them. Throws ConfigError.
void readSettings(YamlSection& yaml, Settings& settings);

// What all systems with an INS have in common. All throw ConfigError.
/// How an aiding sensor's messages are taken, apart from their noise; the last keys of its section.
void readMessages(YamlSection& yaml, MessageOptions& options);
/// What the IMU can measure, and its stamps.
void readUnit(YamlSection& yaml, Mechanisation::Options& imu, Settings& settings);
/// How the INS starts; its misalignment is at most `largest_deg`.
void readStart(YamlSection& yaml, SessionOptions& session, double largest_deg);
/// The keys lag, max_gap and output_rate, and the section estimators.
void readSession(YamlSection& yaml, Settings& settings);

// What a scenario and the settings have in common: how wrong a sensor is. All throw ConfigError.
void readImuErrors(YamlSection& yaml, Parameters& parameters, double& rate);
void readGpsErrors(YamlSection& yaml, Parameters& parameters);
void readDvlErrors(YamlSection& yaml, Parameters& parameters);
void readDepthErrors(YamlSection& yaml, Parameters& parameters);

}  // namespace sas_motion::ins

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "sas_motion/config/yaml_section.hpp"

namespace sas_motion::imaging {

/// A synthetic aperture sonar. Body axes: x forward along the array, y to port, z up.
struct SonarDescription {
  double carrier = 100e3;      ///< [Hz]
  double bandwidth = 40e3;     ///< of the chirp [Hz]
  double pulse_length = 5e-3;  ///< [s]
  double element = 0.1;        ///< length along the array of the transmitter and of each receiver [m]
  int receivers = 8;           ///< elements of the receiver array [-]
  double spacing = 0.1;        ///< between the centres of neighbouring receivers [m]
  double ping_rate = 8;        ///< [Hz]
  double speed = 3;            ///< highest speed at which the ping rate samples the aperture [m/s]
  double sound_speed = 1500;   ///< [m/s]
  double altitude = 10;        ///< over the bottom [m]
  double near_range = 20;      ///< slant range where the swath begins [m]
  double far_range = 45;       ///< slant range where it ends [m]
  double oversampling = 1.5;   ///< complex sampling rate over bandwidth [-]
  bool stop_and_hop = false;   ///< the model takes the receivers as still between transmission and echo
  Eigen::Vector3d transmitter_body = Eigen::Vector3d::Zero();     ///< centre [m]
  Eigen::Vector3d receiver_array_body = Eigen::Vector3d::Zero();  ///< middle of the array [m]

  double wavelength() const { return sound_speed / carrier; }               ///< [m]
  double rangeResolution() const { return sound_speed / (2 * bandwidth); }  ///< c/2B [m]
  double sampleRate() const { return oversampling * bandwidth; }            ///< of the complex baseband [Hz]
  /// Centre of a receiver in body axes; the first is the aftmost [m].
  Eigen::Vector3d receiverBody(int receiver) const;
};

/// The lowest ping rate that samples the aperture at this speed [Hz]. Phase centres must lie at most half an element
/// apart, and a ping of N receivers adds N of them, half their spacing apart. [Bellettini2002]
double neededPingRate(const SonarDescription& sonar, double speed);

/// The highest ping rate at which the echo from the far range ends before the next ping [Hz].
double greatestPingRate(const SonarDescription& sonar);

/// Delay of the echo from the far range [s].
double echoTime(const SonarDescription& sonar);

/// The transmitted pulse at complex baseband: a linear sweep from -B/2 to B/2, of amplitude 1, sampled at sampleRate().
std::vector<std::complex<double>> chirp(const SonarDescription& sonar);

/// Reads the keys of a sonar, named as the members of SonarDescription. Throws ConfigError, also where the ping rate
/// undersamples the aperture at `speed` or overlaps echoes; its message then names the rate needed.
void readSonar(YamlSection yaml, SonarDescription& sonar);

}  // namespace sas_motion::imaging

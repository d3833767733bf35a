// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "sas_motion/imaging/sonar.hpp"

namespace sas_motion::imaging {

/// The sonar at the transmission of a ping, in any local frame with z up.
struct PingPose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();          ///< of the body's origin [m]
  Eigen::Matrix3d C_local_body = Eigen::Matrix3d::Identity();  ///< v_local = C v_body; body x forward, y to port, z up
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< used without stop_and_hop only [m/s]
};

/// The ends of a path from the transmitter to the bottom and back to one receiver.
struct EchoPath {
  Eigen::Vector3d transmitter = Eigen::Vector3d::Zero();        ///< at transmission [m]
  Eigen::Vector3d receiver = Eigen::Vector3d::Zero();           ///< at transmission [m]
  Eigen::Vector3d receiver_velocity = Eigen::Vector3d::Zero();  ///< until the echo ends; zero: stop and hop [m/s]
  Eigen::Vector3d forward = Eigen::Vector3d::UnitX();           ///< axis of the elements: broadside lies across it

  /// Whether transmitter and receiver stand still in one place, so that both ways have one range.
  bool monostatic() const { return transmitter == receiver && receiver_velocity.isZero(0); }
  Eigen::Vector3d phaseCentre() const { return (transmitter + receiver) / 2; }
};

/// The paths of all receivers of all pings, ping by ping.
std::vector<EchoPath> echoPaths(const SonarDescription& sonar, const std::vector<PingPose>& poses);

/// Length of the path by way of `point`, exact for a constant receiver velocity [m].
double pathLength(const EchoPath& path, const Eigen::Vector3d& point, double sound_speed);

/// Two-way amplitude of the beam towards `point` at the carrier, 1 at broadside: sinc^2(D sin(theta) / lambda).
double beamAmplitude(const EchoPath& path, const Eigen::Vector3d& point, const SonarDescription& sonar);

/// Received signals as complex baseband, one line a path: a path of length L gives the phase exp(-j 2 pi f0 L / c).
struct EchoLines {
  double carrier = 0;        ///< f0 [Hz]
  double sound_speed = 0;    ///< c [m/s]
  double sample_rate = 0;    ///< [Hz]
  double first_delay = 0;    ///< of sample 0 after transmission [s]
  int samples = 0;           ///< in a line
  std::size_t left_out = 0;  ///< lines that are zero because an echo in them was not finite
  std::vector<EchoPath> paths{};
  std::vector<std::complex<float>> data{};  ///< lines x samples

  const std::complex<float>* line(std::size_t i) const { return data.data() + i * static_cast<std::size_t>(samples); }
  std::complex<float>* line(std::size_t i) { return data.data() + i * static_cast<std::size_t>(samples); }
  /// Whether all samples of the lines first ... first + count - 1 are finite.
  bool finite(std::size_t first, std::size_t count) const;
  /// Place of an echo by a path of this length in its line [samples].
  double position(double path_length) const { return (path_length / sound_speed - first_delay) * sample_rate; }
};

enum class RangeFilter {
  Matched,    ///< the chirp's conjugate: the highest ratio of signal to noise
  Equalized,  ///< flat over the band: a sinc without the chirp's Fresnel ripple
};
enum class RangeWindow { Rectangular, Hamming };

struct CompressionOptions {
  RangeFilter filter = RangeFilter::Matched;
  RangeWindow window = RangeWindow::Rectangular;  ///< over the band
  int threads = 1;
};

/// Compresses raw echoes in range; a peak has its scatterer's amplitude, phases and delays stay, and lines become a
/// pulse shorter. A line with a sample that is not finite becomes zero and counts as left out.
EchoLines compressRange(const EchoLines& raw, const SonarDescription& sonar, const CompressionOptions& options);

}  // namespace sas_motion::imaging

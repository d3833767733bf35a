// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sas_motion/math/random.hpp"
#include "sas_motion/navigation/attitude.hpp"
#include "sas_motion/noise/noise_source.hpp"
#include "sas_motion/systems/usbl/scenario.hpp"

namespace sas_motion::usbl {

constexpr Stamp kScenarioStart = 1'600'000'000 * kNanosecondsPerSecond;  ///< stamp of every scenario's beginning

/// Where the vessel's reference point is and how she lies.
struct Pose {
  Vector<3> position_map = Vector<3>::Zero();  ///< east, north, up of the datum [m]
  Attitude attitude;
};

/// A ping, and what an oracle is told of each channel's noise.
struct LabelledPing {
  Ping ping;
  std::array<bool, kChannels> outlier{};
  Vector<kChannels> variance = Vector<kChannels>::Ones();  ///< of this draw, over the good one [-]
};

/// The pose along the track at a time since the start [s]; the map axes are those at the datum.
class Vessel {
 public:
  explicit Vessel(const Scenario& scenario);
  /// Times must not fall where the track has waypoints.
  Pose at(double time);

 private:
  void followWaypoints(double time);

  Scenario scenario_;
  Pose pose_;          // of waypoints
  double sailed_ = 0;  // time up to which waypoints have been followed [s]
  std::size_t next_ = 1;
};

/// Draws what the sensors say. Streams of noise are apart: the same pings with any rate of GNSS. The same scenario and
/// seed give the same numbers.
class Simulator {
 public:
  Simulator(const Scenario& scenario, std::uint64_t seed);

  /// What the array hears at a true pose; nothing where the reply is lost. Times must rise.
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

/// All pings of a scenario, each with the vessel's pose as GNSS and attitude measure it at that very moment.
std::vector<LabelledPing> simulatePings(const Scenario& scenario, std::uint64_t seed);

/// The surveyed transponder from a position, in the axes east, north, up at that position [m].
Vector<3> transponderFrom(const Geodetic& position, const Geodetic& transponder);

}  // namespace sas_motion::usbl

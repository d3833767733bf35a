// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "sas_motion/systems/ins_gps_dvl/navigator.hpp"
#include "sas_motion/systems/ins_gps_dvl/reading.hpp"

namespace sas_motion::ins {

/// Where estimators begin, with the state and its standard deviations there.
struct Start {
  NavigationState state;
  Stamp stamp = 0;
  Parameters parameters;  ///< with the standard deviations of this start and the lever arms of the sensors heard so far
};

/// What estimators are fed with, in time order. An audit is the word on a reading that none of them gets.
using Event = std::variant<Start, Aiding, ImuReading, Audit>;

struct AlignmentOptions {
  double max_age = 1;         ///< of attitude and velocity when a fix comes [s]
  double velocity_wait = 10;  ///< for the velocity; then the body is taken to be at rest [s]
  bool fixes_aid = true;      ///< else they only start the INS, which is as sure of its position as the fix
  double position_sigma =
      30;  ///< far more than a fix is off by: the fix itself, fused at once, decides the variance of the position [m]
  double velocity_sigma = 1;            ///< the same of the DVL's velocity [m/s]
  double rest_velocity_sigma = 5;       ///< where there is no DVL [m/s]
  double ground_velocity_sigma = 0.05;  ///< of GNSS's velocity where it states none [m/s]
};

/// Finds the first moment to start at: a fix that comes after an attitude and a velocity. Takes readings in time order,
/// passes them on once it has started, and refuses those before.
///
/// The start is at the attitude's stamp. Position and velocity get wide standard deviations and the fix is fused at
/// once, so that the filter finds what errors they share with GPS and DVL. A velocity of GNSS starts it with
/// the standard deviation of that velocity.
class Alignment {
 public:
  Alignment(const AlignmentOptions& options, const Parameters& parameters)
      : options_(options), parameters_(parameters) {}

  /// Appends what estimators get of this reading to `events`.
  void take(const Reading& reading, std::vector<Event>& events);

  bool started() const { return started_; }
  /// What the start waits for, the first that holds.
  enum class Lack { InertialUnit, Attitude, Fix, FixAfterAttitude, Velocity, Nothing };
  Lack lack() const;

 private:
  /// On to the estimators.
  void pass(const Reading& reading, std::vector<Event>& events) const;
  void gather(const Reading& reading, std::vector<Event>& events);
  /// Where to start, now that this fix has come; nothing where something is missing.
  std::optional<Start> startAt(const Aiding& fix);
  /// Of GNSS, else of the DVL, else of a body at rest; false where there is none and it is worth waiting for one.
  bool setVelocity(const Aiding& fix, Start& start) const;
  Vector<3> positionSigma(const Aiding& fix, const Start& start) const;
  bool fresh(Stamp stamp, const Aiding& fix) const { return secondsBetween(stamp, fix.stamp) <= options_.max_age; }

  AlignmentOptions options_;
  Parameters parameters_;
  bool started_ = false, heard_unit_ = false, heard_fix_ = false;
  std::optional<InertialReading> attitude_;
  std::vector<Reading> since_;      // readings after it
  std::optional<Aiding> velocity_;  // the DVL's newest
  std::optional<GroundVelocity> ground_velocity_;
  std::optional<Stamp> first_located_;  // of the first fix that came after an attitude
};

}  // namespace sas_motion::ins

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "sas_motion/navigation/mechanisation.hpp"

namespace sas_motion {

/// A track for imaging: the integrated readings of an INS, which slowly follow a fused solution's velocity and
/// position. No reading of another sensor makes the track jump or bend within an aperture.
class SteadyTrack {
 public:
  struct Options {
    double velocity_time = 30, position_time = 3000;  ///< time constants [s]
  };

  SteadyTrack(const NavigationState& start, const Options& options) : options_(options), state_(start), fused_(start) {}

  /// Follows the fused solution over `dt` seconds without a reading.
  void move(const NavigationState& fused, double dt) {
    displace(state_,
             displacement(fused_, fused) + dt * lag_ + dt / options_.position_time * displacement(state_, fused));
    lag_ *= std::exp(-dt / options_.velocity_time);
    fused_ = fused;
  }
  /// Takes up a jump of the fused solution at a reading.
  void jump(const NavigationState& fused) {
    lag_ += fused_.velocity_nav - fused.velocity_nav;
    fused_ = fused;
  }

  NavigationState state() const {
    NavigationState smooth = fused_;
    smooth.latitude = state_.latitude;
    smooth.longitude = state_.longitude;
    smooth.height = state_.height;
    smooth.velocity_nav += lag_;
    return smooth;
  }

 private:
  Options options_;
  NavigationState state_, fused_;
  Vector<3> lag_ = Vector<3>::Zero();  // velocity of the steady solution less the fused one
};

}  // namespace sas_motion

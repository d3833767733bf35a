// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "sas_motion/navigation/mechanisation.hpp"

namespace sas_motion {

/// For imaging: what an INS measures, integrated, which follows a fused solution's velocity and position slowly, so
/// that no reading makes it jump or bend within an aperture.
class SteadyTrack {
 public:
  struct Options {
    double velocity_time = 30, position_time = 3000;  ///< in which it follows [s]
  };

  SteadyTrack(const NavigationState& start, const Options& options) : options_(options), state_(start), fused_(start) {}

  /// The fused solution has moved, without a reading, for `dt` seconds.
  void move(const NavigationState& fused, double dt) {
    displace(state_,
             displacement(fused_, fused) + dt * lag_ + dt / options_.position_time * displacement(state_, fused));
    lag_ *= std::exp(-dt / options_.velocity_time);
    fused_ = fused;
  }
  /// A reading has made the fused solution jump.
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

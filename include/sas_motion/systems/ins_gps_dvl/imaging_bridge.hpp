// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/imaging/micronavigation.hpp"
#include "sas_motion/imaging/trajectory.hpp"
#include "sas_motion/navigation/local_frame.hpp"
#include "sas_motion/systems/ins_gps_dvl/model.hpp"

/// Between navigation, whose body axes are starboard, forward, up, and imaging, whose are forward, port, up.
namespace sas_motion::ins {

/// The state as imaging sees it. `map` is so near that east, north and up at the body are those of its origin.
imaging::TimedPose poseIn(const LocalFrame& map, Stamp stamp, const NavigationState& state);

/// Parameters::dpc_lever_body of this sonar: the middle between its transmitter and its receiver array [m].
Vector<3> phaseCentre(const imaging::SonarDescription& sonar);

/// The reading that estimators get of a valid measurement between pings at `first` and `second`, at the middle of its
/// displacement: `along` and `sight` over the interval T, with variances sigma^2 / T^2. A displacement is a mean
/// velocity, on the axes half-way between the pings' attitudes, `delay` before that middle, of a phase centre that
/// accelerates while the echo is under way. What the velocity and the axes at the middle differ by from that is taken
/// from the estimated motion, in any local frame: up to 1.1 mm/s in the waves of a default track, twenty times the
/// standard deviation along the sight. Errors of the estimate cancel as far as they do not change within T. `estimated`
/// must reach from first to second + 2 delay; throws std::invalid_argument where it does not.
Aiding dpcReading(const imaging::Micronavigation& found, const imaging::SonarDescription& sonar,
                  const imaging::Trajectory& estimated, Stamp first, Stamp second);

}  // namespace sas_motion::ins

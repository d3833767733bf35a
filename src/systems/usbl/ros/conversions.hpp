// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sas_motion/UsblMeasurement.h>

#include <optional>
#include <string>

#include "ros/messages.hpp"
#include "sas_motion/systems/usbl/mounting.hpp"
#include "systems/usbl/ros/settings.hpp"

/// The only place where the calibration's axes (starboard, forward, up) meet those of REP-103 (forward, port, up).
namespace sas_motion::ros_side {

/// Range, angle to starboard, angle to forward. A channel whose stated variance is unusable takes the settings' or is
/// absent.
usbl::Reading readingOf(const sas_motion::UsblMeasurement& message, const UsblSettings& settings);
/// The message of a reading; a direction's variance is that of the first which is there.
sas_motion::UsblMeasurement measurementOf(const usbl::Reading& reading);

usbl::Mounting mountingOf(const Transform& T_base_array);
Transform transformOf(const usbl::Mounting& mounting);
/// The id that a transponder's frame_id holds; nothing where it is no number.
std::optional<std::uint32_t> transponderId(const std::string& frame_id);

}  // namespace sas_motion::ros_side

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/session/session.hpp"
#include "sas_motion/systems/towfish/estimator.hpp"

/// Between the towfish's state (north, east, clockwise heading, speed through the water) and the solution of every
/// system.
namespace sas_motion::towfish {

/// A state as a solution; its place where the map is known.
Solution solutionOf(const Estimate& estimate, const LocalFrame* map);
/// The belief that a user sets.
Gaussian<kStates> beliefOf(const StateRequest& request);

}  // namespace sas_motion::towfish

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "evaluation/estimator_scorer.hpp"
#include "evaluation/true_track.hpp"

namespace sas_motion {

/// Hands the errors of a solution of any system to a scorer: position, heading, speed over ground and current; height,
/// velocity and tilt where estimate and truth have a height.
void score(const Solution& estimate, const TruePoint& truth, EstimatorScorer& scorer);

}  // namespace sas_motion

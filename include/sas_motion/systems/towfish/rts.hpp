// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/systems/towfish/problem.hpp"

namespace sas_motion::towfish {

/// Solves the smoothing problem by iterated, re-weighted, fixed-interval smoothing: a Kalman filter forward over the
/// problem linearised and weighted at the last trajectory, a Rauch-Tung-Striebel pass back [Rauch1965; Bell1994 for the
/// iteration as Gauss-Newton].
///
/// The pass back is in Bryson and Frazier's form, which carries the adjoint of the state and inverts no predicted
/// covariance [Bierman1973]. A step that would raise the cost is halved. Redescending losses start from the Huber
/// solution. Work and memory are linear in the nodes; the loop does not allocate.
SmootherResult smoothRts(const SmoothingProblem& problem, const SmootherOptions& options);

}  // namespace sas_motion::towfish

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/robust/loss.hpp"

namespace sas_motion {

/// E[psi(r)^2] for standard normal r. A robust estimate of scale divides by it to be consistent for Gaussian noise
/// (Huber's proposal 2). [Huber1981, 6.4]
double gaussianMeanSquaredInfluence(const Loss& loss);

}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/imaging/fourier.hpp"
#include "sas_motion/imaging/sonar.hpp"

namespace sas_motion::imaging {

/// The transmitted pulse at complex baseband: a linear frequency sweep from -B/2 to B/2 over the pulse length, of
/// amplitude 1, sampled at sampleRate().
Spectrum chirp(const SonarDescription& sonar);

}  // namespace sas_motion::imaging

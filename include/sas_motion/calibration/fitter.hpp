// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "sas_motion/calibration/robust_fit.hpp"

namespace sas_motion::usbl {

/// Calibrates by all pings at once, from the prior's mean, the noise's scale beside.
using Fitter = std::function<Fit(const Problem& problem, const FitOptions& options)>;

/// The fitter of a name; empty for an unknown one.
using FitterFactory = std::function<Fitter(const std::string& name)>;

}  // namespace sas_motion::usbl

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "sas_motion/systems/usbl/robust_fit.hpp"

namespace sas_motion::usbl {

/// Calibrates by all pings at once, from the prior's mean, the noise's scale beside.
using Fitter = std::function<Fit(const Problem& problem, const FitOptions& options)>;

/// The fitter of a name; empty for an unknown one.
using FitterFactory = std::function<Fitter(const std::string& name)>;

/// batch without a factor graph: the native fit; empty for another name.
inline Fitter nativeFitter(const std::string& name) {
  if (name != "batch") return {};
  return [](const Problem& problem, const FitOptions& options) { return fit(problem, options); };
}

}  // namespace sas_motion::usbl

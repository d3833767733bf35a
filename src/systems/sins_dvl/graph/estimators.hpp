// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/systems/sins_dvl/estimator.hpp"

namespace sas_motion::sins {

/// All estimators: those of makeEstimator and batch, fixed_lag, which know the same sensors and start from the same
/// attitude, however wrong. Null for an unknown name.
std::unique_ptr<ins::Estimator> makeAnyEstimator(const std::string& name, const Config& config);

/// The names that makeAnyEstimator accepts.
const std::vector<std::string>& anyEstimatorNames();

}  // namespace sas_motion::sins

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/systems/towfish/estimator.hpp"

namespace sas_motion::towfish {

/// All estimators: those of makeEstimator and batch, gnc, fixed_lag. Null for an unknown name.
std::unique_ptr<Estimator> makeAnyEstimator(const std::string& name, const Config& config);

/// The names that makeAnyEstimator accepts.
const std::vector<std::string>& estimatorNames();

}  // namespace sas_motion::towfish

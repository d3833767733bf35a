// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sas_motion/imaging/focus_bench.hpp"

namespace sas_motion {

/// The measures of all trajectories (JSON).
std::string focusDocument(const imaging::FocusResult& result);
/// The same in short, for a terminal.
std::string focusTable(const imaging::FocusResult& result);

}  // namespace sas_motion

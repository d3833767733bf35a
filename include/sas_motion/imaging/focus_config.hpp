// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/imaging/focus_scene.hpp"

namespace sas_motion::imaging {

/// Reads what `focus` looks at and how. The sonar stands under `sonar`, or in the file that `sonar_file` names,
/// relative to this one. Throws ConfigError.
FocusSettings readFocus(const std::string& file);

}  // namespace sas_motion::imaging

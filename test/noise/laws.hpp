// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include "sas_motion/noise/noise_law.hpp"

namespace sas_motion::testing {

/// A law of this kind with these members, e.g. law(Kind::StudentT, {{&NoiseLaw::nu, 3}}).
inline NoiseLaw law(NoiseLaw::Kind kind, const std::vector<std::pair<double NoiseLaw::*, double>>& values) {
  NoiseLaw result;
  result.kind = kind;
  for (const auto& [member, value] : values) result.*member = value;
  return result;
}

}  // namespace sas_motion::testing

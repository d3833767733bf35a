// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <algorithm>

#include "sas_motion/config/yaml_section.hpp"
#include "sas_motion/robust/loss.hpp"

namespace sas_motion {

/// The keys loss and tuning. A loss without a tuning gets its customary one. Throws ConfigError.
inline void readLoss(YamlSection& yaml, Loss& loss) {
  const auto& names = lossNames();
  std::string name = lossName(loss.kind());
  yaml.text("loss", name);
  if (std::find(names.begin(), names.end(), name) == names.end())
    yaml.fail("loss", fmt::format("is '{}' but must be one of {}", name, fmt::join(names, ", ")));
  const LossKind kind = lossFromName(name);
  double tuning = kind == loss.kind() ? loss.tuning() : Loss::defaultTuning(kind);
  yaml.number("tuning", tuning, {kTiny, 1e9});
  loss = Loss(kind, tuning);
}

}  // namespace sas_motion

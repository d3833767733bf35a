// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// For tests and measurements of what is compiled once for each set of vector instructions.
#pragma once

#include <hwy/targets.h>

namespace sas_motion {

/// Calls `work` once for each set of vector instructions of this machine, which the library then works with.
template <class Work>
void forEachInstructionSet(Work&& work) {
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    work();
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace sas_motion

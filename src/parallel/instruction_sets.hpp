// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// For tests and measurements of what is compiled once for each set of vector instructions.
#pragma once

#ifdef SAS_MOTION_HIGHWAY
#include <hwy/targets.h>
#endif

namespace sas_motion {

/// Calls `work` once for each set of vector instructions of this machine, which the library then works with; without
/// Highway once.
template <class Work>
void forEachInstructionSet(Work&& work) {
#ifdef SAS_MOTION_HIGHWAY
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    work();
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
#else
  work();
#endif
}

}  // namespace sas_motion

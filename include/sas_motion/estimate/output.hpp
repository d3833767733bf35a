// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sas_motion/estimate/audit.hpp"
#include "sas_motion/estimate/solution.hpp"

namespace sas_motion {

/// What an estimator has to say since it was last asked, each in time order. The caller clears it. An estimator says it
/// in its system's own state, a session in the solutions that every system has in common.
template <class State>
struct OutputOf {
  std::vector<State> solutions;
  std::vector<Audit> audits;
  void clear() {
    solutions.clear();
    audits.clear();
  }
};
using Output = OutputOf<Solution>;

/// Visits solutions and audits, each in time order, in the order of both; at one stamp audits first.
template <class State, class OnSolution, class OnAudit>
void inTimeOrder(const OutputOf<State>& output, const OnSolution& on_solution, const OnAudit& on_audit) {
  auto audit = output.audits.begin();
  for (const auto& solution : output.solutions) {
    for (; audit != output.audits.end() && audit->stamp <= solution.stamp; ++audit) on_audit(*audit);
    on_solution(solution);
  }
  for (; audit != output.audits.end(); ++audit) on_audit(*audit);
}

}  // namespace sas_motion

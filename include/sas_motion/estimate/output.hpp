// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sas_motion/estimate/audit.hpp"
#include "sas_motion/estimate/solution.hpp"

namespace sas_motion {

/// The new answers of an estimator, each in time order; the caller clears them. An estimator writes its system's own
/// state, a session the solutions that every system has in common.
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

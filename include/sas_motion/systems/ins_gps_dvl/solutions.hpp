// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sas_motion/systems/ins_gps_dvl/estimator.hpp"

namespace sas_motion::ins {

/// What one run of a navigator has solutions of.
enum class Source { Fused, Gps, Dvl, Smooth };
enum class FilterKind { Unaided, Kalman, OpenLoop, Robust };
constexpr FilterKind kFilterKinds[]{FilterKind::Unaided, FilterKind::Kalman, FilterKind::OpenLoop, FilterKind::Robust};

/// A solution by name: which filter runs, and which of its solutions is meant.
struct NamedSolution {
  std::string name;
  FilterKind filter;
  Source source;
};
const std::vector<NamedSolution>& namedSolutions();
/// Null for an unknown name.
const NamedSolution* findSolution(const std::string& name);

/// Calls `visit` with the filter of this kind and the options of its navigator.
template <class Visit>
void withFilter(FilterKind kind, const Config& config, const Visit& visit) {
  NavigatorOptions options;
  options.imu = config.imu;
  options.feedback = kind == FilterKind::Kalman || kind == FilterKind::Robust;
  switch (kind) {
    case FilterKind::Unaided: return visit(Unaided(), options);
    case FilterKind::Kalman:
    case FilterKind::OpenLoop: return visit(KalmanFilter<kStates>(), options);
    case FilterKind::Robust: return visit(RobustKalmanFilter<kStates>(config.robust_kf), options);
  }
}

/// What the navigator answers at its stamp, or nothing where this source has no answer then.
template <class Filter>
std::optional<NavigationSolution> solutionOf(const Navigator<Filter>& navigator, Source source);

}  // namespace sas_motion::ins

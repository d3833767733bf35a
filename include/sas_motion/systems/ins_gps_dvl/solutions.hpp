// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sas_motion/systems/ins_gps_dvl/estimator.hpp"

namespace sas_motion::ins {

/// What one run of a navigator has solutions of.
enum class Source { Fused, Gnss, Dvl, Steady };
/// What a run of a navigator is made with.
struct FilterKind {
  std::string filter;     ///< its name, see withFilter(); empty: none, so that nothing is fused
  bool feedback = false;  ///< whether it corrects the INS, or the output alone

  bool operator==(const FilterKind& other) const { return filter == other.filter && feedback == other.feedback; }
};
/// None, every filter of 27 states with feedback, and kf without.
const std::vector<FilterKind>& filterKinds();

/// A solution by name: which filter runs, and which of its solutions is meant.
struct NamedSolution {
  std::string name;
  FilterKind filter;
  Source source;
};
const std::vector<NamedSolution>& namedSolutions();
/// Null for an unknown name.
const NamedSolution* findSolution(const std::string& name);

/// What an estimator is called now whose name was another one before; any other name as it is.
std::string currentName(const std::string& name);

/// Calls `visit` with the filter of this kind and the options of its navigator.
template <class Visit>
void withFilter(const FilterKind& kind, const Config& config, const Visit& visit) {
  NavigatorOptions options;
  options.imu = config.imu;
  options.feedback = kind.feedback;
  if (kind.filter.empty()) return visit(Unaided(), options);
  sas_motion::withFilter<kStates>(kind.filter, config.filters, [&](const auto& filter) { visit(filter, options); });
}

/// What the navigator answers at its stamp, or nothing where this source has no answer then.
template <class Filter>
std::optional<NavigationSolution> solutionOf(const Navigator<Filter>& navigator, Source source);

}  // namespace sas_motion::ins

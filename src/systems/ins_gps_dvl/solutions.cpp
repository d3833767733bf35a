// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/ins_gps_dvl/solutions.hpp"

#include <algorithm>
#include <map>

namespace sas_motion::ins {
namespace {

/// Of velocity, position and attitude, in SI units and metres.
Matrix<9> covarianceOf(const Gaussian<kStates>& belief, const Errors& unit) {
  Vector<9> scale = unit.head<9>();
  scale.segment<3>(kPosition).setOnes();
  return scale.asDiagonal() * belief.covariance.topLeftCorner<9, 9>() * scale.asDiagonal();
}

}  // namespace

const std::vector<FilterKind>& filterKinds() {
  static const std::vector<FilterKind> all = [] {
    std::vector<FilterKind> kinds{{"", false}};
    for (const char* name : kFilterNames)
      if (sas_motion::withFilter<kStates>(name, {}, [](const auto&) {})) kinds.push_back({name, true});
    kinds.push_back({"kf", false});
    return kinds;
  }();
  return all;
}

const std::vector<NamedSolution>& namedSolutions() {
  static const std::vector<NamedSolution> all = [] {
    std::vector<NamedSolution> solutions;
    for (const auto& kind : filterKinds()) {
      const std::string name = kind.filter + "27";
      if (kind.filter.empty()) {
        solutions.insert(
            solutions.end(),
            {{"ins", kind, Source::Fused}, {"gnss_alone", kind, Source::Gnss}, {"dvl", kind, Source::Dvl}});
      } else if (kind.feedback) {
        solutions.insert(solutions.end(), {{name, kind, Source::Fused},
                                           {"gnss_" + name, kind, Source::Gnss},
                                           {"dvl_" + name, kind, Source::Dvl},
                                           {"steady_" + name, kind, Source::Steady}});
      } else {
        solutions.push_back({"open_loop_" + name, kind, Source::Fused});
      }
    }
    return solutions;
  }();
  return all;
}

std::string currentName(const std::string& name) {
  static const std::map<std::string, std::string> renamed{{"ckf27", "kf27"},
                                                          {"robust_ckf27", "robust_kf27"},
                                                          {"open_loop_ckf27", "open_loop_kf27"},
                                                          {"smooth_ckf27", "steady_kf27"},
                                                          {"smooth_robust_ckf27", "steady_robust_kf27"},
                                                          {"dvl_ckf27", "dvl_kf27"},
                                                          {"dvl_robust_ckf27", "dvl_robust_kf27"},
                                                          {"gps_ckf27", "gnss_kf27"},
                                                          {"gps_robust_ckf27", "gnss_robust_kf27"},
                                                          {"gps", "gnss_alone"},
                                                          {"gnss", "gnss_alone"}};  // gnss/fix is the receiver's topic
  const auto found = renamed.find(name);
  return found == renamed.end() ? name : found->second;
}

const NamedSolution* findSolution(const std::string& name) {
  const auto& all = namedSolutions();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const NamedSolution& solution) { return solution.name == name; });
  return found == all.end() ? nullptr : &*found;
}

template <class Filter>
std::optional<NavigationSolution> solutionOf(const Navigator<Filter>& navigator, Source source) {
  NavigationSolution solution;
  solution.stamp = navigator.stamp();
  solution.rate_body = navigator.rate_body();
  switch (source) {
    case Source::Fused:
      solution.state = navigator.fused();
      if constexpr (!std::is_same_v<Filter, Unaided>)
        solution.covariance = covarianceOf(navigator.belief(), navigator.model().unit());
      break;
    case Source::Dvl:
      solution.state = navigator.dvl();
      solution.has_attitude = false;
      break;
    case Source::Steady: solution.state = navigator.steady(); break;
    case Source::Gnss:
      if (!navigator.gps()) return std::nullopt;
      solution.stamp = navigator.gps()->stamp;
      solution.state = navigator.gps()->state;
      solution.has_velocity = solution.has_attitude = false;
      solution.rate_body.reset();
  }
  return solution;
}

#define SAS_MOTION_INSTANTIATE(Filter) \
  template std::optional<NavigationSolution> solutionOf(const Navigator<Filter<kStates>>&, Source);
SAS_MOTION_FOR_LARGE_FILTERS(SAS_MOTION_INSTANTIATE)
template std::optional<NavigationSolution> solutionOf(const Navigator<Unaided>&, Source);

}  // namespace sas_motion::ins

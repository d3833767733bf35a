// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/ins_gps_dvl/solutions.hpp"

#include <algorithm>

namespace sas_motion::ins {
namespace {

/// Of velocity, position and attitude, in SI units and metres.
Matrix<9> covarianceOf(const Gaussian<kStates>& belief, const Errors& unit) {
  Vector<9> scale = unit.head<9>();
  scale.segment<3>(kPosition).setOnes();
  return scale.asDiagonal() * belief.covariance.topLeftCorner<9, 9>() * scale.asDiagonal();
}

}  // namespace

const std::vector<NamedSolution>& namedSolutions() {
  using Kind = FilterKind;
  static const std::vector<NamedSolution> all{{"ins", Kind::Unaided, Source::Fused},
                                              {"gps", Kind::Unaided, Source::Gps},
                                              {"dvl", Kind::Unaided, Source::Dvl},
                                              {"ckf27", Kind::Kalman, Source::Fused},
                                              {"gps_ckf27", Kind::Kalman, Source::Gps},
                                              {"dvl_ckf27", Kind::Kalman, Source::Dvl},
                                              {"open_loop_ckf27", Kind::OpenLoop, Source::Fused},
                                              {"robust_ckf27", Kind::Robust, Source::Fused},
                                              {"gps_robust_ckf27", Kind::Robust, Source::Gps},
                                              {"dvl_robust_ckf27", Kind::Robust, Source::Dvl},
                                              {"smooth_ckf27", Kind::Kalman, Source::Smooth},
                                              {"smooth_robust_ckf27", Kind::Robust, Source::Smooth}};
  return all;
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
    case Source::Smooth: solution.state = navigator.smooth(); break;
    case Source::Gps:
      if (!navigator.gps()) return std::nullopt;
      solution.stamp = navigator.gps()->stamp;
      solution.state = navigator.gps()->state;
      solution.has_velocity = solution.has_attitude = false;
      solution.rate_body.reset();
  }
  return solution;
}

template std::optional<NavigationSolution> solutionOf(const Navigator<KalmanFilter<kStates>>&, Source);
template std::optional<NavigationSolution> solutionOf(const Navigator<RobustKalmanFilter<kStates>>&, Source);
template std::optional<NavigationSolution> solutionOf(const Navigator<Unaided>&, Source);

}  // namespace sas_motion::ins

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The one list of the filters that systems choose by name. A further filter gets a row in each part of this file.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "sas_motion/config/yaml_section.hpp"
#include "sas_motion/filters/bank_kalman_filter.hpp"
#include "sas_motion/filters/calibrated_filter.hpp"
#include "sas_motion/filters/gated_kalman_filter.hpp"
#include "sas_motion/filters/mixture_kalman_filter.hpp"
#include "sas_motion/filters/reacquiring_filter.hpp"
#include "sas_motion/filters/robust_kalman_filter.hpp"
#include "sas_motion/filters/student_t_kalman_filter.hpp"

// Explicit instantiations: DO(KalmanFilter) and so on for every filter, for those that work in 27 states too, and for
// those that a CalibratedFilter may wrap.
#define SAS_MOTION_FOR_CALIBRATED_FILTERS(KIND, DO) DO(KIND, RobustKalmanFilter) DO(KIND, StudentTKalmanFilter)
#define SAS_MOTION_FOR_LARGE_FILTERS(DO) \
  DO(KalmanFilter) DO(GatedKalmanFilter) DO(RobustKalmanFilter) DO(MixtureKalmanFilter)
#define SAS_MOTION_FOR_FILTERS(DO) SAS_MOTION_FOR_LARGE_FILTERS(DO) DO(StudentTKalmanFilter) DO(BankKalmanFilter)

namespace sas_motion {

SAS_MOTION_FOR_CALIBRATED_FILTERS(extern, SAS_MOTION_INSTANTIATE_CALIBRATED)

/// The names that withFilter() accepts. It also accepts robust_kf_LOSS, e.g. robust_kf_cauchy.
constexpr std::array<const char*, 7> kFilterNames{"kf",   "gated_kf",   "robust_kf", "student_t_kf",
                                                  "mckf", "mixture_kf", "bank_kf"};

/// The options of every filter, and of the rule to re-acquire.
struct FilterOptions {
  GatedKalmanOptions gated_kf;
  RobustKalmanOptions robust_kf;
  StudentTKalmanOptions student_t_kf;
  RobustKalmanOptions mckf = correntropyOptions(5);
  MixtureKalmanOptions mixture_kf;
  BankKalmanOptions bank_kf;
  double reset_after = 20;  ///< see ReacquiringFilter [s]
};

/// Reads a section for each filter; the caller finishes `yaml`. Throws ConfigError.
inline void readOptions(YamlSection& yaml, FilterOptions& options) {
  yaml.section("kf").finish();
  readOptions(yaml.section("gated_kf"), options.gated_kf);
  readOptions(yaml.section("robust_kf"), options.robust_kf);
  readOptions(yaml.section("student_t_kf"), options.student_t_kf);
  readCorrentropyOptions(yaml.section("mckf"), options.mckf);
  readOptions(yaml.section("mixture_kf"), options.mixture_kf);
  readOptions(yaml.section("bank_kf"), options.bank_kf);
}

/// States that bank_kf and student_t_kf are compiled for at most: each hypothesis of the first holds them all, and code
/// for more makes the compiler slow down the second in six.
constexpr int kFewStates = 6;

/// Calls `use` with the filter of N states that has this name, set up by `options`; false where no filter has it.
template <int N, class Use>
bool withFilter(const std::string& name, const FilterOptions& options, Use&& use) {
  if (name == "kf") return use(KalmanFilter<N>()), true;
  if (name == "gated_kf") return use(GatedKalmanFilter<N>(options.gated_kf)), true;
  if (name == "robust_kf") return use(RobustKalmanFilter<N>(options.robust_kf)), true;
  if (name == "mckf") return use(RobustKalmanFilter<N>(options.mckf)), true;
  if (name == "mixture_kf") return use(MixtureKalmanFilter<N>(options.mixture_kf)), true;
  if constexpr (N <= kFewStates) {
    if (name == "student_t_kf") return use(StudentTKalmanFilter<N>(options.student_t_kf)), true;
    if (name == "bank_kf") return use(BankKalmanFilter<N>(options.bank_kf)), true;
  }
  const std::string prefix = "robust_kf_";  // with another loss at its customary tuning
  if (name.rfind(prefix, 0) != 0) return false;
  const auto& losses = lossNames();
  const std::string loss = name.substr(prefix.size());
  if (std::find(losses.begin(), losses.end(), loss) == losses.end()) return false;
  auto with_loss = options.robust_kf;
  with_loss.loss = Loss(lossFromName(loss));
  return use(RobustKalmanFilter<N>(with_loss)), true;
}

/// The filter inside the guard that it needs where nobody resets it.
template <template <int> class Filter, int N>
auto guarded(const Filter<N>& filter, double reset_after) {
  using Calibrated = CalibratedFilter<Filter<N>, N>;
  if constexpr (Filter<N>::kGuard == Guard::CalibratedAndReacquiring)
    return ReacquiringFilter<Calibrated, N>(Calibrated(filter), reset_after);
  else if constexpr (Filter<N>::kGuard == Guard::Reacquiring)
    return ReacquiringFilter<Filter<N>, N>(filter, reset_after);
  else
    return filter;
}
template <class Filter>
using Guarded = decltype(guarded(std::declval<Filter>(), 1));

/// The same as withFilter(), with the filter in its guard.
template <int N, class Use>
bool withGuardedFilter(const std::string& name, const FilterOptions& options, Use&& use) {
  return withFilter<N>(name, options, [&](const auto& filter) { use(guarded(filter, options.reset_after)); });
}

}  // namespace sas_motion

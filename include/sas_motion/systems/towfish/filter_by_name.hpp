// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>

#include "sas_motion/filters/calibrated_filter.hpp"
#include "sas_motion/filters/reacquiring_filter.hpp"
#include "sas_motion/systems/towfish/config.hpp"

namespace sas_motion::towfish {

/// Calls `use` with the filter of six states that has this name, set up by `config`; false where no filter has it. A
/// filter that may disbelieve measurements for good is wrapped so that it can come back; bank_kf does so itself.
template <class Use>
bool withFilter(const std::string& name, const Config& config, Use&& use) {
  const auto reacquiring = [&](auto filter) {
    use(ReacquiringFilter<decltype(filter), kStates>(filter, config.reset_after));
    return true;
  };
  const auto calibrated = [&](auto filter) { return reacquiring(CalibratedFilter<decltype(filter), kStates>(filter)); };
  if (name == "kf") return use(KalmanFilter<kStates>()), true;
  if (name == "bank_kf") return use(BankKalmanFilter<kStates>(config.bank_kf)), true;
  if (name == "gated_kf") return reacquiring(GatedKalmanFilter<kStates>(config.gated_kf));
  if (name == "robust_kf") return calibrated(RobustKalmanFilter<kStates>(config.robust_kf));
  if (name == "mckf") return calibrated(RobustKalmanFilter<kStates>(config.mckf));
  if (name == "mixture_kf") return reacquiring(MixtureKalmanFilter<kStates>(config.mixture_kf));
  if (name == "student_t_kf") return calibrated(StudentTKalmanFilter<kStates>(config.student_t_kf));
  const std::string prefix = "robust_kf_";  // with another loss at its customary tuning
  if (name.rfind(prefix, 0) != 0) return false;
  const auto& losses = lossNames();
  const std::string loss = name.substr(prefix.size());
  if (std::find(losses.begin(), losses.end(), loss) == losses.end()) return false;
  auto options = config.robust_kf;
  options.loss = Loss(lossFromName(loss));
  return calibrated(RobustKalmanFilter<kStates>(options));
}

}  // namespace sas_motion::towfish

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/filters/linearized.hpp"
#include "sas_motion/filters/update.hpp"

namespace sas_motion {

/// The time update that all Gaussian filters share: P^- = F P F^T + Q and the model's mean. (9a), (9b) [Zhu2007]
template <int N>
Gaussian<N> predictGaussian(const Gaussian<N>& belief, const Transition<N>& transition);

/// The guard that keeps an unattended filter from rejecting good measurements for ever, see guarded().
enum class Guard { None, Reacquiring, CalibratedAndReacquiring };

/// The extended Kalman filter, Joseph form. (9) [Zhu2007]
template <int N>
class KalmanFilter {
 public:
  using Belief = Gaussian<N>;
  static constexpr Guard kGuard = Guard::None;

  Belief predict(const Belief& belief, const Transition<N>& transition) const {
    return predictGaussian(belief, transition);
  }

  template <int M>
  Update<Belief, M> update(const Belief& prior, const LinearMeasurement<N, M>& z) const;
};

}  // namespace sas_motion

#include "sas_motion/filters/impl/kalman_filter.hpp"

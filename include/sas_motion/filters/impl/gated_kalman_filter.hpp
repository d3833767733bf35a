// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/filters/gated_kalman_filter.hpp"
#include "sas_motion/filters/impl/instantiate.hpp"

namespace sas_motion {

template <int N>
template <int M>
Update<Gaussian<N>, M> GatedKalmanFilter<N>::update(const Belief& prior, const LinearMeasurement<N, M>& z) const {
  auto result = kalman_.update(prior, z);
  if (result.verdict == Verdict::Accepted && result.nis > gate_.threshold(M)) {
    result.belief = prior;
    result.weights.setZero();
    result.verdict = Verdict::Rejected;
  }
  return result;
}

SAS_MOTION_INSTANTIATE_UPDATES(extern, GatedKalmanFilter)
SAS_MOTION_INSTANTIATE_LARGE_UPDATES(extern, GatedKalmanFilter)

}  // namespace sas_motion

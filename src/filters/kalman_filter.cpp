// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/kalman_filter.hpp"

namespace sas_motion {

#define SAS_MOTION_INSTANTIATE(KIND, N) \
  KIND template Gaussian<N> predictGaussian(const Gaussian<N>&, const Transition<N>&);
SAS_MOTION_FOR_STATES(, SAS_MOTION_INSTANTIATE)
SAS_MOTION_INSTANTIATE(, 27)
#undef SAS_MOTION_INSTANTIATE
SAS_MOTION_INSTANTIATE_UPDATES(, KalmanFilter)
SAS_MOTION_INSTANTIATE_LARGE_UPDATES(, KalmanFilter)

}  // namespace sas_motion

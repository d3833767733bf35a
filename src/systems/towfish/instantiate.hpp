// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The one list of the filters that the pipeline is compiled for.
#pragma once

#include "sas_motion/filters/bank_kalman_filter.hpp"
#include "sas_motion/filters/calibrated_filter.hpp"
#include "sas_motion/filters/gaussian_sum_filter.hpp"
#include "sas_motion/filters/kalman_filter.hpp"
#include "sas_motion/filters/mixture_kalman_filter.hpp"
#include "sas_motion/filters/reacquiring_filter.hpp"

#define SAS_MOTION_FOR_FILTERS(Pipeline)                                                                       \
  template class Pipeline<BankKalmanFilter<kStates>>;                                                          \
  template class Pipeline<GaussianSumFilter<kStates>>;                                                         \
  template class Pipeline<KalmanFilter<kStates>>;                                                              \
  template class Pipeline<ReacquiringFilter<GatedKalmanFilter<kStates>, kStates>>;                             \
  template class Pipeline<ReacquiringFilter<MixtureKalmanFilter<kStates>, kStates>>;                           \
  template class Pipeline<ReacquiringFilter<CalibratedFilter<RobustKalmanFilter<kStates>, kStates>, kStates>>; \
  template class Pipeline<ReacquiringFilter<CalibratedFilter<StudentTKalmanFilter<kStates>, kStates>, kStates>>;

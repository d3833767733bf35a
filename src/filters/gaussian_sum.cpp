// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/gaussian_sum.hpp"

namespace sas_motion {

#define SAS_MOTION_INSTANTIATE(KIND, N)  \
  KIND template struct GaussianBlock<N>; \
  KIND template struct GaussianSum<N>;
SAS_MOTION_FOR_STATES(, SAS_MOTION_INSTANTIATE)
#undef SAS_MOTION_INSTANTIATE

}  // namespace sas_motion

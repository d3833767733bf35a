// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Vectors for a file that is compiled once for each set of instructions, by Highway; where Highway is missing, once for
// one lane. Has no include guard: Highway includes the file again and again.
#ifdef SAS_MOTION_HIGHWAY
#include <hwy/foreach_target.h>  // comes before highway.h
//
#include <hwy/highway.h>
#else
#include "parallel/one_lane.hpp"
#endif

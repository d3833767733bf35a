// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/math/types.hpp"

namespace sas_motion {

/// ln N(residual; 0, root root^T) without the constant in 2 pi; not finite where the root is singular.
template <int M>
double logDensity(const Vector<M>& residual, const Matrix<M>& root) {
  return -0.5 * root.template triangularView<Eigen::Lower>().solve(residual).squaredNorm() -
         root.diagonal().array().log().sum();
}

}  // namespace sas_motion

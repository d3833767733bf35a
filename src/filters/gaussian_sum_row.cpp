// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/impl/gaussian_sum_row.hpp"

#include <algorithm>
#include <cmath>

namespace sas_motion {
namespace {

constexpr double kBeyondReach = 40;  // branches whose log-weight is further below the largest are dropped

}  // namespace

void keepHeaviest(std::vector<GaussianSumBranch>& branches, std::size_t count) {
  const auto heavier = [](const GaussianSumBranch& a, const GaussianSumBranch& b) {
    return a.log_weight > b.log_weight;
  };
  const double best = std::min_element(branches.begin(), branches.end(), heavier)->log_weight;
  for (auto& b : branches) b.log_weight -= best;
  branches.erase(std::remove_if(branches.begin(), branches.end(),
                                [](const GaussianSumBranch& b) { return b.log_weight < -kBeyondReach; }),
                 branches.end());
  if (branches.size() <= count) return;
  std::nth_element(branches.begin(), branches.begin() + static_cast<std::ptrdiff_t>(count), branches.end(), heavier);
  branches.resize(count);
}

#define SAS_MOTION_INSTANTIATE(KIND, N) KIND template struct GaussianSumRow<N>;
SAS_MOTION_FOR_STATES(, SAS_MOTION_INSTANTIATE)
#undef SAS_MOTION_INSTANTIATE

}  // namespace sas_motion

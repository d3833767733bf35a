// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/gaussian_sum_filter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sas_motion {
namespace {

void requireTerms(const char* what, std::vector<NoiseTerm>& terms) {
  double total = 0;
  for (const auto& term : terms) {
    if (!(term.variance > 0) || !(term.probability >= 0) || !std::isfinite(term.mean))
      throw std::invalid_argument(
          fmt::format("{}: a term needs a positive variance and a probability of at least 0", what));
    total += term.probability;
  }
  if (!(total > 0)) throw std::invalid_argument(fmt::format("{}: at least one probability must be positive", what));
  for (auto& term : terms) term.probability /= total;
  terms.erase(std::remove_if(terms.begin(), terms.end(), [](const NoiseTerm& term) { return term.probability == 0; }),
              terms.end());
}

}  // namespace

GaussianSumOptions checked(GaussianSumOptions options) {
  requireTerms("measurement", options.measurement);
  requireTerms("process", options.process);
  if (!(options.epoch >= 0)) throw std::invalid_argument(fmt::format("epoch: {} must be at least 0", options.epoch));
  if (!(options.persistence >= 0 && options.persistence < 1))
    throw std::invalid_argument(fmt::format("persistence: {} must lie in [0, 1)", options.persistence));
  if (!(options.mode.rate >= 0) || !(options.mode.length > 0))
    throw std::invalid_argument("mode: rate must be at least 0 and length positive");
  if (options.hypotheses < 1 || options.branches < options.hypotheses)
    throw std::invalid_argument("hypotheses must be at least 1, and branches at least as many");
  return options;
}

SAS_MOTION_INSTANTIATE_UPDATES(, GaussianSumFilter)

}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/gated_kalman_filter.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "filters/instantiate.hpp"
#include "sas_motion/config/yaml_section.hpp"

namespace sas_motion {
namespace {

double checkedProbability(double probability) {
  if (!(probability > 0 && probability < 1))
    throw std::invalid_argument(fmt::format("probability is {} but must lie between 0 and 1", probability));
  return probability;
}

}  // namespace

void readOptions(YamlSection yaml, GatedKalmanOptions& options) {
  yaml.number("probability", options.probability, {0.5, 0.999999});
  yaml.finish();
}

template <int N>
GatedKalmanFilter<N>::GatedKalmanFilter(const Options& options) : gate_(checkedProbability(options.probability)) {}

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

SAS_MOTION_INSTANTIATE_UPDATES(GatedKalmanFilter)
SAS_MOTION_INSTANTIATE_LARGE_UPDATES(GatedKalmanFilter)

}  // namespace sas_motion

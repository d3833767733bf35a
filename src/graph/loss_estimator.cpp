// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "graph/loss_estimator.hpp"

#include <boost/make_shared.hpp>
#include <cmath>
#include <iostream>

namespace sas_motion {

void LossEstimator::print(const std::string& prefix) const {
  std::cout << prefix << lossName(loss_.kind()) << " " << loss_.tuning() << "\n";
}

bool LossEstimator::equals(const gtsam::noiseModel::mEstimator::Base& other, double tolerance) const {
  const auto* same = dynamic_cast<const LossEstimator*>(&other);
  return same && same->loss_.kind() == loss_.kind() && std::abs(same->loss_.tuning() - loss_.tuning()) <= tolerance;
}

gtsam::SharedNoiseModel robustNoise(const Loss& loss, double sigma) {
  const auto gaussian = gtsam::noiseModel::Isotropic::Sigma(1, sigma);
  if (loss.kind() == LossKind::L2) return gaussian;
  return gtsam::noiseModel::Robust::Create(boost::make_shared<LossEstimator>(loss), gaussian);
}

}  // namespace sas_motion

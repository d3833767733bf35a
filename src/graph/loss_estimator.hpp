// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtsam/linear/LossFunctions.h>
#include <gtsam/linear/NoiseModel.h>

#include <boost/make_shared.hpp>
#include <cmath>
#include <iostream>

#include "sas_motion/robust/loss.hpp"

namespace sas_motion {

/// A Loss for GTSAM's scalar factors, so that filters and factor graphs use the same weight function.
class LossEstimator final : public gtsam::noiseModel::mEstimator::Base {
 public:
  explicit LossEstimator(const Loss& loss) : loss_(loss) {}
  double weight(double residual) const override { return loss_.weight(residual); }
  double loss(double residual) const override { return loss_.rho(residual); }
  void print(const std::string& prefix) const override {
    std::cout << prefix << lossName(loss_.kind()) << " " << loss_.tuning() << "\n";
  }
  bool equals(const gtsam::noiseModel::mEstimator::Base& other, double tolerance) const override {
    const auto* same = dynamic_cast<const LossEstimator*>(&other);
    return same && same->loss_.kind() == loss_.kind() && std::abs(same->loss_.tuning() - loss_.tuning()) <= tolerance;
  }

 private:
  Loss loss_;
};

/// Scalar noise of standard deviation sigma under a loss; plain Gaussian for L2.
inline gtsam::SharedNoiseModel robustNoise(const Loss& loss, double sigma) {
  const auto gaussian = gtsam::noiseModel::Isotropic::Sigma(1, sigma);
  if (loss.kind() == LossKind::L2) return gaussian;
  return gtsam::noiseModel::Robust::Create(boost::make_shared<LossEstimator>(loss), gaussian);
}

}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtsam/linear/LossFunctions.h>
#include <gtsam/linear/NoiseModel.h>

#include "sas_motion/robust/loss.hpp"

namespace sas_motion {

/// Our losses as GTSAM's, so that filter and factor graph weigh a residual by the same function. For scalar factors.
class LossEstimator final : public gtsam::noiseModel::mEstimator::Base {
 public:
  explicit LossEstimator(const Loss& loss) : loss_(loss) {}
  double weight(double residual) const override { return loss_.weight(residual); }
  double loss(double residual) const override { return loss_.rho(residual); }
  void print(const std::string& prefix) const override;
  bool equals(const gtsam::noiseModel::mEstimator::Base& other, double tolerance) const override;

 private:
  Loss loss_;
};

/// Scalar noise of standard deviation sigma under a loss; plain Gaussian for L2.
gtsam::SharedNoiseModel robustNoise(const Loss& loss, double sigma);

}  // namespace sas_motion

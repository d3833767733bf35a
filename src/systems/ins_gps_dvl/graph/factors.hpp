// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtsam/nonlinear/NonlinearFactor.h>
#include <gtsam/nonlinear/NonlinearFactorGraph.h>

#include <boost/make_shared.hpp>

#include "sas_motion/robust/loss.hpp"
#include "systems/ins_gps_dvl/graph/interval.hpp"

namespace sas_motion::ins {

using ModelPtr = std::shared_ptr<const ErrorModel>;
using IntervalPtr = std::shared_ptr<const InertialInterval>;

/// Two nodes and what the IMU read between them: the errors that the way integrated from the first has at the
/// second. It is integrated anew at each linearisation, over the Earth as it is; Jacobians and noise are those of
/// ErrorModel::transition. (C.4)
class InertialFactor final : public gtsam::NoiseModelFactor3<Node, Node, Constants> {
 public:
  /// The noise is frozen at `start`.
  InertialFactor(gtsam::Key from, gtsam::Key to, const ModelPtr& model, const IntervalPtr& interval, const Node& start,
                 const Constants& constants);
  gtsam::Vector evaluateError(const Node& from, const Node& to, const Constants& constants,
                              boost::optional<gtsam::Matrix&> H_from, boost::optional<gtsam::Matrix&> H_to,
                              boost::optional<gtsam::Matrix&> H_constants) const override;
  gtsam::NonlinearFactor::shared_ptr clone() const override { return boost::make_shared<InertialFactor>(*this); }

 private:
  ModelPtr model_;
  IntervalPtr interval_;
  Vector<9> decay_;  // of what wanders, over the interval
};

/// One scalar row of a reading of a sensor that aids under a loss: the innovation of ErrorModel. A factor a row, since
/// GTSAM gives a vector factor one weight.
class AidingFactor final : public gtsam::NoiseModelFactor {
 public:
  /// `rate_body` is that of the body against inertial space at the reading; `loss` is on the row.
  AidingFactor(gtsam::Key node, const ModelPtr& model, const Aiding& reading, const Vector<3>& rate_body, int row,
               const Loss& loss);
  gtsam::Vector unwhitenedError(const gtsam::Values& values,
                                boost::optional<std::vector<gtsam::Matrix>&> H = boost::none) const override;
  gtsam::NonlinearFactor::shared_ptr clone() const override { return boost::make_shared<AidingFactor>(*this); }
  /// The error over its standard deviation, before the loss.
  double residual(const gtsam::Values& values) const { return unwhitenedError(values)(0) / sigma_; }

 private:
  /// What a DVL's scale, misalignment and lever arm change.
  void distort(const gtsam::Values& values, const LinearMeasurement<kStates, 3>& z, double& error,
               Matrix<1, kStates>& row, boost::optional<std::vector<gtsam::Matrix>&> H) const;

  ModelPtr model_;
  Aiding reading_;
  Vector<3> rate_body_;
  int row_;
  double sigma_;
};

/// A filter's joint belief of a node and the constants.
class BeliefFactor final : public gtsam::NoiseModelFactor2<Node, Constants> {
 public:
  BeliefFactor(gtsam::Key node, const NavigationState& fused, const Gaussian<kStates>& belief);
  gtsam::Vector evaluateError(const Node& node, const Constants& constants, boost::optional<gtsam::Matrix&> H_node,
                              boost::optional<gtsam::Matrix&> H_constants) const override;
  gtsam::NonlinearFactor::shared_ptr clone() const override { return boost::make_shared<BeliefFactor>(*this); }

 private:
  Node node_;
  Constants constants_;
};

/// The keys of a DVL's scale, misalignment and lever arm, where they are estimated.
gtsam::KeyVector dvlKeys(const Parameters& parameters);

}  // namespace sas_motion::ins

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtsam/nonlinear/NonlinearFactor.h>
#include <gtsam/nonlinear/NonlinearFactorGraph.h>

#include <boost/make_shared.hpp>

#include "sas_motion/systems/towfish/model.hpp"
#include "sas_motion/systems/towfish/problem.hpp"

namespace sas_motion::towfish {

using gtsam::Key;

/// x_k = f(x_{k-1}) + w with w ~ N(0, Q): error x_k - f(x_{k-1}), the heading wrapped; analytic Jacobians of the model.
class MotionFactor final : public gtsam::NoiseModelFactor2<StateVector, StateVector> {
 public:
  MotionFactor(Key from, Key to, const Model& model, const Input& input, double dt, const StateMatrix& Q);
  gtsam::Vector evaluateError(const StateVector& from, const StateVector& to, boost::optional<gtsam::Matrix&> H_from,
                              boost::optional<gtsam::Matrix&> H_to) const override;
  gtsam::NonlinearFactor::shared_ptr clone() const override { return boost::make_shared<MotionFactor>(*this); }

 private:
  Model model_;
  Input input_;
  double dt_;
};

/// One scalar row of a measurement under a loss: error h(x) - z. A factor a row, since GTSAM gives a vector factor one
/// weight.
class RowFactor final : public gtsam::NoiseModelFactor1<StateVector> {
 public:
  RowFactor(Key key, const Model& model, const Measurement& z, int row, const Loss& loss);
  gtsam::Vector evaluateError(const StateVector& x, boost::optional<gtsam::Matrix&> H) const override;
  gtsam::NonlinearFactor::shared_ptr clone() const override { return boost::make_shared<RowFactor>(*this); }

 private:
  Model model_;
  Measurement z_;
  int row_;
};

/// The prior on a node: error x - m, the heading wrapped.
class PriorStateFactor final : public gtsam::NoiseModelFactor1<StateVector> {
 public:
  PriorStateFactor(Key key, const Gaussian<kStates>& prior);
  gtsam::Vector evaluateError(const StateVector& x, boost::optional<gtsam::Matrix&> H) const override;
  gtsam::NonlinearFactor::shared_ptr clone() const override { return boost::make_shared<PriorStateFactor>(*this); }

 private:
  StateVector mean_;
};

/// A factor for each row of a measurement.
void addRows(gtsam::NonlinearFactorGraph& graph, Key key, const Model& model, const Measurement& z, const Loss& loss);

}  // namespace sas_motion::towfish

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/towfish/graph/factors.hpp"

#include <cmath>

#include "graph/loss_estimator.hpp"

namespace sas_motion::towfish {

MotionFactor::MotionFactor(Key from, Key to, const Model& model, const Input& input, double dt, const StateMatrix& Q)
    : NoiseModelFactor2(gtsam::noiseModel::Gaussian::Covariance(Q), from, to), model_(model), input_(input), dt_(dt) {}

gtsam::Vector MotionFactor::evaluateError(const StateVector& from, const StateVector& to,
                                          boost::optional<gtsam::Matrix&> H_from,
                                          boost::optional<gtsam::Matrix&> H_to) const {
  if (H_to) *H_to = StateMatrix::Identity();
  if (!H_from) return Model::difference(to, model_.predict(from, input_, dt_));
  const auto step = model_.transition(from, input_, dt_);
  *H_from = -step.F;
  return Model::difference(to, step.mean);
}

RowFactor::RowFactor(Key key, const Model& model, const Measurement& z, int row, const Loss& loss)
    : NoiseModelFactor1(robustNoise(loss, std::sqrt(z.variance(row))), key), model_(model), z_(z), row_(row) {}

gtsam::Vector RowFactor::evaluateError(const StateVector& x, boost::optional<gtsam::Matrix&> H) const {
  return model_.linearize(z_, x, [&](const auto& linear) -> gtsam::Vector {
    if (H) *H = linear.H.row(row_);
    return gtsam::Vector1(-linear.innovation(row_));
  });
}

PriorStateFactor::PriorStateFactor(Key key, const Gaussian<kStates>& prior)
    : NoiseModelFactor1(gtsam::noiseModel::Gaussian::Covariance(prior.covariance), key), mean_(prior.mean) {}

gtsam::Vector PriorStateFactor::evaluateError(const StateVector& x, boost::optional<gtsam::Matrix&> H) const {
  if (H) *H = StateMatrix::Identity();
  return Model::difference(x, mean_);
}

void addRows(gtsam::NonlinearFactorGraph& graph, Key key, const Model& model, const Measurement& z, const Loss& loss) {
  for (int row = 0; row < rowsOf(z.sensor); ++row) graph.emplace_shared<RowFactor>(key, model, z, row, loss);
}

}  // namespace sas_motion::towfish

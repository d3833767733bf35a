// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/ins_gps_dvl/graph/factors.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "graph/loss_estimator.hpp"

namespace sas_motion::ins {
namespace {

// Least noise of an interval, of the size of what its integration is good to: the solver stands a bounded ratio of
// noises.
constexpr double kLeastVelocity = 1e-6, kLeastPosition = 3e-6, kLeastAttitude = 1e-5,
                 kLeastWandering = 1e-6;  // [m/s], [m], [mrad], units of the states

Vector<kNodeStates> leastVariance() {
  const Vector<3> ones = Vector<3>::Ones();
  Vector<kNodeStates> sigma;
  sigma << kLeastVelocity * ones, kLeastPosition * ones, kLeastAttitude * ones, kLeastWandering * Vector<9>::Ones();
  return sigma.cwiseAbs2();
}

/// Inverse of the root of a covariance, with units and positive definite.
gtsam::SharedNoiseModel gaussian(const gtsam::Matrix& covariance) {
  const gtsam::Matrix inverse_root =
      covariance.llt().matrixL().solve(gtsam::Matrix::Identity(covariance.rows(), covariance.cols()));
  return gtsam::noiseModel::Gaussian::SqrtInformation(inverse_root, false);
}

/// Of the INS the model has errors, which a step of the node takes away; of what wanders the node has the model's
/// errors themselves.
Vector<kNodeStates> signs() {
  Vector<kNodeStates> s;
  s << Vector<9>::Ones(), -Vector<9>::Ones();
  return s;
}

template <std::size_t Rows, std::size_t Cols>
Matrix<Rows, Cols> part(const ErrorMatrix& A, const std::array<int, Rows>& rows, const std::array<int, Cols>& cols) {
  Matrix<Rows, Cols> result;
  for (std::size_t i = 0; i < Rows; ++i)
    for (std::size_t j = 0; j < Cols; ++j) result(static_cast<int>(i), static_cast<int>(j)) = A(rows[i], cols[j]);
  return result;
}

gtsam::SharedNoiseModel inertialNoise(const ErrorModel& model, const InertialInterval& interval, const Node& start,
                                      const Constants& constants) {
  ErrorMatrix Q = model.transition(integrate(interval, start, constants).motion, interval.duration, Errors::Zero()).Q;
  Q.diagonal() += interval.gap_variance;
  Matrix<kNodeStates> Q_node = part(Q, kNodeIndices, kNodeIndices);
  Q_node.diagonal() += leastVariance();
  return gaussian(Q_node);
}

/// By how much an attitude error phi shrinks as a turn takes some of it away: the right Jacobian of rotations,
/// inverted, at -phi. Only near phi = 0 is that the identity. [Forster2017, (9)]
Matrix<3> attitudeErrorByTurn(const Vector<3>& phi) {
  const double angle = phi.norm();
  const double second =
      angle < 1e-3 ? 1.0 / 12 : 1 / (angle * angle) - (1 + std::cos(angle)) / (2 * angle * std::sin(angle));
  const Matrix<3> turn = skew(phi);
  return Matrix<3>::Identity() - 0.5 * turn + second * turn * turn;
}

/// Calls `visit` with the linear measurement of a reading.
template <class Visit>
void withMeasurement(const ErrorModel& model, const NavigationState& ins, const Aiding& reading,
                     const Vector<3>& rate_body, const Errors& mean, const Visit& visit) {
  switch (reading.sensor) {
    case Sensor::Gps: return visit(model.gps(ins, reading.fix, mean));
    case Sensor::Dvl: return visit(model.dvl(ins, rate_body, reading.velocity_body, mean));
    case Sensor::Depth: return visit(model.depth(ins, reading.fix.height, mean));
    case Sensor::Dpc: return visit(model.dpc(ins, rate_body, reading.array, mean));
  }
}

double sigmaOf(const ErrorModel& model, const Aiding& reading, int row) {
  if (reading.variance) return std::sqrt((*reading.variance)(row));
  double sigma = 0;
  withMeasurement(model, {}, reading, Vector<3>::Zero(), Errors::Zero(),
                  [&](const auto& z) { sigma = std::sqrt(z.R(row, row)); });
  return sigma;
}

/// By what its drift angle turns a DVL's velocity; the identity where it has none.
Matrix<3> driftTurn(const ErrorModel& model, const Node& node) {
  Matrix<3> turn = Matrix<3>::Identity();
  if (!model.parameters().dvl_drift) return turn;
  const Errors angle = node.wandering(6) * Errors::Unit(kDvlVelocity);
  for (int axis = 0; axis < 3; ++axis) turn.col(axis) += model.dvlError(Vector<3>::Unit(axis), angle);
  return turn;
}

gtsam::KeyVector keysOf(gtsam::Key node, const Aiding& reading, const Parameters& parameters) {
  gtsam::KeyVector keys{node};
  if (reading.sensor != Sensor::Dvl) return keys;
  const auto dvl = dvlKeys(parameters);
  keys.insert(keys.end(), dvl.begin(), dvl.end());
  return keys;
}

}  // namespace

gtsam::KeyVector dvlKeys(const Parameters& parameters) {
  gtsam::KeyVector keys;
  if (parameters.dvl_scale > 0) keys.push_back(kDvlScaleKey);
  if (parameters.dvl_misalignment > 0) keys.push_back(kDvlMisalignmentKey);
  if (parameters.dvl_lever_sigma > 0) keys.push_back(kDvlLeverKey);
  return keys;
}

InertialFactor::InertialFactor(gtsam::Key from, gtsam::Key to, const ModelPtr& model, const IntervalPtr& interval,
                               const Node& start, const Constants& constants)
    : NoiseModelFactor3(inertialNoise(*model, *interval, start, constants), from, to, kConstantsKey),
      model_(model),
      interval_(interval),
      decay_(part(model->transitionMatrix({start.state, Vector<3>::Zero(), Matrix<3>::Identity()}, interval->duration),
                  kNodeIndices, kNodeIndices)
                 .diagonal()
                 .tail<9>()) {}

gtsam::Vector InertialFactor::evaluateError(const Node& from, const Node& to, const Constants& constants,
                                            boost::optional<gtsam::Matrix&> H_from,
                                            boost::optional<gtsam::Matrix&> H_to,
                                            boost::optional<gtsam::Matrix&> H_constants) const {
  const Integrated way = integrate(*interval_, from, constants);
  if (H_from || H_constants) {
    const ErrorMatrix F = model_->transitionMatrix(way.motion, interval_->duration);
    if (H_from) *H_from = part(F, kNodeIndices, kNodeIndices) * signs().asDiagonal();
    if (H_constants) *H_constants = -part(F, kNodeIndices, kConstantIndices);
  }
  if (H_to) *H_to = -gtsam::Matrix(signs().asDiagonal());
  Vector<kNodeStates> error = to.localCoordinates({way.end, to.wandering});
  error.tail<9>() = to.wandering - decay_.cwiseProduct(from.wandering);
  return error;
}

AidingFactor::AidingFactor(gtsam::Key node, const ModelPtr& model, const Aiding& reading, const Vector<3>& rate_body,
                           int row, const Loss& loss)
    : NoiseModelFactor(robustNoise(loss, sigmaOf(*model, reading, row)), keysOf(node, reading, model->parameters())),
      model_(model),
      reading_(reading),
      rate_body_(rate_body),
      row_(row),
      sigma_(sigmaOf(*model, reading, row)) {}

gtsam::Vector AidingFactor::unwhitenedError(const gtsam::Values& values,
                                            boost::optional<std::vector<gtsam::Matrix>&> H) const {
  const Node node = values.at<Node>(keys()[0]);
  double error = 0;
  withMeasurement(*model_, node.state, reading_, rate_body_, errorsOf(node, Constants::Zero()), [&](const auto& z) {
    Matrix<1, kStates> row = -z.H.row(row_);
    error = -z.innovation(row_);
    if constexpr (std::decay_t<decltype(z)>::kRows == 3)
      if (keys().size() > 1) distort(values, z, error, row, H);
    if (!H) return;
    (*H)[0].resize(1, kNodeStates);
    for (int i = 0; i < kNodeStates; ++i) (*H)[0](0, i) = signs()(i) * row(kNodeIndices[static_cast<std::size_t>(i)]);
  });
  return gtsam::Vector1(error);
}

void AidingFactor::distort(const gtsam::Values& values, const LinearMeasurement<kStates, 3>& z, double& error,
                           Matrix<1, kStates>& row, boost::optional<std::vector<gtsam::Matrix>&> H) const {
  const auto estimated = [&](gtsam::Key key) { return std::find(keys().begin(), keys().end(), key) != keys().end(); };
  const auto vector_at = [&](gtsam::Key key) -> Vector<3> {
    return estimated(key) ? Vector<3>(values.at<gtsam::Vector3>(key)) : Vector<3>::Zero();
  };
  const double scale = estimated(kDvlScaleKey) ? values.at<double>(kDvlScaleKey) : 0;
  const Matrix<3> D = dvlDistortion(scale, vector_at(kDvlMisalignmentKey));
  // The velocity of the DVL at its configured place, which the innovation is of, and at its own.
  const NavigationState& state = values.at<Node>(keys()[0]).state;
  const Matrix<3> turning = skew(rateOverGround(state, rate_body_));
  const Vector<3> of_ins = state.q_nav_body.conjugate() * state.velocity_nav;
  const Vector<3> configured = of_ins - model_->velocityOfIns(state, rate_body_, Vector<3>::Zero());
  const Matrix<3> drift = driftTurn(*model_, values.at<Node>(keys()[0]));
  const Vector<3> velocity = configured + turning * vector_at(kDvlLeverKey), seen = drift * velocity;
  error += (D.row(row_) * seen)(0) - (configured - of_ins + drift * of_ins)(row_);
  row.head<9>() = D.row(row_) * z.H.leftCols<9>();
  row.head<9>() *= -1;  // the error is h(x) - z
  if (model_->parameters().dvl_drift)
    row(kDvlVelocity) = -(D.row(row_) * model_->dvlError(velocity, Errors::Unit(kDvlVelocity)))(0);
  if (!H) return;
  auto column = H->begin() + 1;
  if (estimated(kDvlScaleKey)) *column++ = gtsam::Matrix(D.row(row_) * seen / (1 + scale));
  if (estimated(kDvlMisalignmentKey)) *column++ = gtsam::Matrix((1 + scale) * skew(seen).row(row_));
  if (estimated(kDvlLeverKey)) *column = gtsam::Matrix(D.row(row_) * drift * turning);
}

BeliefFactor::BeliefFactor(gtsam::Key node, const NavigationState& fused, const Gaussian<kStates>& belief)
    : NoiseModelFactor2(
          [&] {
            gtsam::Matrix P(kNodeStates + kConstantStates, kNodeStates + kConstantStates);
            P << part(belief.covariance, kNodeIndices, kNodeIndices),
                part(belief.covariance, kNodeIndices, kConstantIndices),
                part(belief.covariance, kConstantIndices, kNodeIndices),
                part(belief.covariance, kConstantIndices, kConstantIndices);
            return gaussian(P);
          }(),
          node, kConstantsKey),
      node_(nodeOf(fused, belief.mean)),
      constants_(constantsOf(belief.mean)) {}

gtsam::Vector BeliefFactor::evaluateError(const Node& node, const Constants& constants,
                                          boost::optional<gtsam::Matrix&> H_node,
                                          boost::optional<gtsam::Matrix&> H_constants) const {
  constexpr int kRows = kNodeStates + kConstantStates;
  if (H_node) {
    *H_node = gtsam::Matrix::Zero(kRows, kNodeStates);
    H_node->topRows<kNodeStates>() = -gtsam::Matrix(signs().asDiagonal());
    H_node->block<3, 3>(kAttitude, kAttitude) =
        -attitudeErrorByTurn(attitudeError(node_.state.q_nav_body, node.state.q_nav_body));
  }
  if (H_constants) {
    *H_constants = gtsam::Matrix::Zero(kRows, kConstantStates);
    H_constants->bottomRows<kConstantStates>().setIdentity();
  }
  gtsam::Vector error(kRows);
  error << node.localCoordinates(node_).head<9>(), node.wandering - node_.wandering, constants - constants_;
  return error;
}

}  // namespace sas_motion::ins

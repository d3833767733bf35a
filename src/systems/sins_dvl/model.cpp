// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/sins_dvl/model.hpp"

#include <cmath>

#include "sas_motion/math/factorization.hpp"
#include "sas_motion/navigation/attitude.hpp"
#include "sas_motion/navigation/earth.hpp"
#include "sas_motion/systems/ins_gps_dvl/model.hpp"

namespace sas_motion::sins {
namespace {

/// Roughening of states that are constants, in a second. [Gordon1993]
constexpr double kRoughPosition = 1e-3;              // [m]
constexpr double kRoughQuaternion = 1e-7;            // along the quaternion, which has no noise there
constexpr double kRoughGyro = 1e-3 * kDegPerHour;    // [rad/s]
constexpr double kRoughAccelerometer = 1 * kMicroG;  // [m/s^2]
constexpr double kRoughScale = 1e-6;                 // [-]
constexpr double kLeastShare = 1e-12;                // of that of turns, which may be large: far above rounding
constexpr double kQuaternionRegulariser = 1e-6;      // of the start, likewise

double squared(double value) { return value * value; }

template <int N>
Vector<3> biasOf(const Vector<N>& x) {
  if constexpr (N > kAccelerometer)
    return x.template segment<3>(kAccelerometer);
  else
    return Vector<3>::Zero();
}

Eigen::Quaterniond quaternionFrom(const Vector<4>& c) { return {c(0), c(1), c(2), c(3)}; }

/// Latitude, longitude, height per metre north, east, up.
Vector<3> perMetre(const NavigationState& state) {
  const auto [M, N] = earth::radii(state.latitude, state.height);
  return {1 / M, 1 / (N * std::cos(state.latitude)), 1};
}

Vector<3> northFirst(const Vector<3>& enu) { return {enu.y(), enu.x(), enu.z()}; }

/// Covariance of a quaternion by a rotation vector's variances on nav axes.
Matrix<4> ofRotation(const Eigen::Quaterniond& q, const Vector<3>& variance) {
  const Matrix<4, 3> Y = leftTurn(q);
  return 0.25 * Y * variance.asDiagonal() * Y.transpose();
}

}  // namespace

ins::Parameters inSmallAngles(const Parameters& p) {
  ins::Parameters q;
  q.gyro_constant = p.gyro_constant;
  q.gyro_markov = 1e-3 * p.gyro_constant;  // there is none, but its model needs one
  q.angle_random_walk = p.angle_random_walk;
  q.accelerometer_constant = p.accelerometer_constant;
  q.velocity_random_walk = p.velocity_random_walk;
  q.dvl_drift = ins::DvlDrift{p.dvl_offset, p.dvl_offset_time, p.dvl_angle, p.dvl_angle_time};
  q.dvl_white = p.dvl_white;
  q.dvl_scale = p.dvl_scale;
  q.depth_white = p.depth_white;
  q.dvl_lever_sigma = p.dvl_lever_sigma;
  static_cast<ins::StartAndMounting&>(q) = p;
  return q;
}

Matrix<4, 3> leftTurn(const Eigen::Quaterniond& q) {
  Matrix<4, 3> Y;
  Y << -q.vec().transpose(), q.w() * Matrix<3>::Identity() - skew(q.vec());
  return Y;
}

Matrix<4, 3> rightTurn(const Eigen::Quaterniond& q) {
  Matrix<4, 3> U;
  U << -q.vec().transpose(), q.w() * Matrix<3>::Identity() + skew(q.vec());
  return U;
}

NavigationState moved(const NavigationState& state, const Preintegration& preintegrated, const Vector<3>& eps,
                      const Vector<3>& nabla) {
  const double T = preintegrated.duration(), s = std::sin(state.latitude), c = std::cos(state.latitude);
  const Matrix<3> C = state.q_nav_body.toRotationMatrix();
  Vector<3> velocity = C * preintegrated.velocity(eps, nabla), way = C * preintegrated.way(eps, nabla);
  const auto [M, N] = earth::radiiBySine(s, state.height);
  const double per_T = 1 / T, per_M = 1 / M, per_N = 1 / N, per_parallel = per_N / c;
  const Vector<3> gravity(0, 0, -earth::gravityBySine(s, state.height)),
      turning(0, earth::kRotationRate * c, earth::kRotationRate * s);
  const auto over_earth = [&](const Vector<3>& v) {
    return Vector<3>(-v.y() * per_M, v.x() * per_N, v.x() * s * per_parallel);
  };
  const auto pull = [&](const Vector<3>& v) -> Vector<3> { return gravity - (2 * turning + over_earth(v)).cross(v); };

  const Vector<3> v = state.velocity_nav;
  const Vector<3> middle_v = v + per_T * way + 0.5 * T * pull(v);
  const Vector<3> turn = turning + over_earth(middle_v), acceleration = pull(middle_v);
  velocity -= turn.cross(T * velocity - way);  // later readings are on axes that the Earth has turned
  way -= turn.cross(T / 3 * way);
  const Vector<3> mean_v = v + per_T * way + 0.5 * T * acceleration;

  NavigationState end;
  end.latitude = state.latitude + T * mean_v.y() * per_M;
  end.longitude = state.longitude + T * mean_v.x() * per_parallel;
  end.height = state.height + T * mean_v.z();
  end.velocity_nav = v + velocity + T * acceleration;
  end.q_nav_body = quaternionOf(-T * turn) * state.q_nav_body * preintegrated.rotation(eps);
  return end;
}

template <int N>
Motion<N>::Motion(const Parameters& p, const NavigationState& ins, const Preintegration& preintegrated)
    : ins_(ins),
      ins_moved_(moved(ins, preintegrated, Vector<3>::Zero(), Vector<3>::Zero())),
      preintegrated_(preintegrated),
      parameters_(p),
      offset_decay_(std::exp(-preintegrated.duration() / p.dvl_offset_time)),
      angle_decay_(std::exp(-preintegrated.duration() / p.dvl_angle_time)) {}

template <int N>
Matrix<N> Motion<N>::noiseRoot(const Vector<9>& besides) const {
  const Parameters& p = parameters_;
  const double T = preintegrated_.duration();
  Matrix<N> Q = Matrix<N>::Zero();
  const Vector<3> position_variance = Vector<3>::Constant(T * squared(kRoughPosition)) + besides.segment<3>(3);
  Q.diagonal().template segment<3>(kPosition) = northFirst(position_variance).cwiseProduct(perMetre(ins_).cwiseAbs2());
  Q.diagonal().template segment<3>(kVelocity) =
      Vector<3>::Constant(T * squared(p.velocity_random_walk)) + besides.head<3>();
  const Matrix<4, 3> U = rightTurn(ins_moved_.q_nav_body);
  Q.template block<4, 4>(kQuaternion, kQuaternion) = T * (0.25 * squared(p.angle_random_walk) * U * U.transpose() +
                                                          squared(kRoughQuaternion) * Matrix<4>::Identity()) +
                                                     ofRotation(ins_moved_.q_nav_body, besides.tail<3>());
  Q.diagonal().template segment<3>(kGyro).setConstant(T * squared(kRoughGyro));
  auto turns = Q.template block<4, 4>(kQuaternion, kQuaternion);
  turns.diagonal().array() += kLeastShare * turns.trace();
  Q(kDvlOffset, kDvlOffset) = squared(p.dvl_offset) * (1 - squared(offset_decay_));  // (0.5)
  Q(kDvlScale, kDvlScale) = T * squared(kRoughScale);
  Q(kDvlAngle, kDvlAngle) = squared(p.dvl_angle) * (1 - squared(angle_decay_));
  if constexpr (N > kAccelerometer)
    Q.diagonal().template segment<3>(kAccelerometer).setConstant(T * squared(kRoughAccelerometer));
  return choleskyLower<N>(Q).value_or(Matrix<N>::Zero());
}

template <int N>
Vector<N> Motion<N>::operator()(const Vector<N>& x) const {
  const NavigationState truth =
      moved(View<N>(ins_).corrected(x), preintegrated_, x.template segment<3>(kGyro), biasOf<N>(x));
  Vector<N> end = x;
  end(kPosition) = ins_moved_.latitude - truth.latitude;
  end(kPosition + 1) = ins_moved_.longitude - truth.longitude;
  end(kPosition + 2) = ins_moved_.height - truth.height;
  end.template segment<3>(kVelocity) = ins_moved_.velocity_nav - truth.velocity_nav;
  end.template segment<4>(kQuaternion) = coefficients(ins_moved_.q_nav_body) - coefficients(truth.q_nav_body);
  end(kDvlOffset) *= offset_decay_;
  end(kDvlAngle) *= angle_decay_;
  return end;
}

template <int N>
NavigationState View<N>::corrected(const Vector<N>& x) const {
  NavigationState truth;
  truth.latitude = ins_.latitude - x(kPosition);
  truth.longitude = ins_.longitude - x(kPosition + 1);
  truth.height = ins_.height - x(kPosition + 2);
  truth.velocity_nav = ins_.velocity_nav - x.template segment<3>(kVelocity);
  truth.q_nav_body = quaternionFrom(coefficients(ins_.q_nav_body) - x.template segment<4>(kQuaternion)).normalized();
  return truth;
}

template <int N>
Vector<3> View<N>::dvl(const Vector<N>& x, const Vector<3>& turning_body) const {
  const Vector<4> q = coefficients(ins_.q_nav_body) - x.template segment<4>(kQuaternion);
  const Vector<3> v =
      quaternionFrom(q).normalized().conjugate() * Vector<3>(ins_.velocity_nav - x.template segment<3>(kVelocity)) +
      turning_body;
  const double s = std::sin(x(kDvlAngle)), c = std::cos(x(kDvlAngle)), scale = 1 + x(kDvlScale);
  return {scale * (c * v.x() + s * v.y()), scale * (c * v.y() - s * v.x()) + x(kDvlOffset), scale * v.z()};
}

template <int N>
double View<N>::height(const Vector<N>& x, const Vector<3>& lever_body) const {
  const Vector<4> q = coefficients(ins_.q_nav_body) - x.template segment<4>(kQuaternion);
  return ins_.height - x(kPosition + 2) + (quaternionFrom(q).normalized() * lever_body).z();
}

template <int N>
Vector<N> View<N>::constrained(const Vector<N>& x) const {
  const Vector<4> q = coefficients(ins_.q_nav_body);
  Vector<N> on_sphere = x;
  on_sphere.template segment<4>(kQuaternion) = q - (q - x.template segment<4>(kQuaternion)).normalized();
  return on_sphere;
}

template <int N>
Matrix<9, N> View<N>::solutionByError(const Vector<N>& x) const {
  const NavigationState truth = corrected(x);
  const Vector<3> metres = perMetre(truth).cwiseInverse();
  Matrix<9, N> T = Matrix<9, N>::Zero();
  T.template block<3, 3>(0, kVelocity).setIdentity();
  T(3, kPosition + 1) = metres(1);
  T(4, kPosition) = metres(0);
  T(5, kPosition + 2) = 1;
  T.template block<3, 4>(6, kQuaternion) = -2 * leftTurn(truth.q_nav_body).transpose();
  return T;
}

template <int N>
Gaussian<N> startBelief(const Parameters& p, const NavigationState& ins) {
  Gaussian<N> belief{Vector<N>::Zero(), Matrix<N>::Zero()};
  auto P = belief.covariance.diagonal();
  P.template segment<3>(kPosition) = northFirst(p.start_position).cwiseProduct(perMetre(ins)).cwiseAbs2();
  P.template segment<3>(kVelocity).setConstant(squared(p.start_velocity));
  P.template segment<3>(kGyro).setConstant(squared(p.gyro_constant));
  P(kDvlOffset) = squared(p.dvl_offset);
  P(kDvlScale) = squared(p.dvl_scale);
  P(kDvlAngle) = squared(p.dvl_angle);
  if constexpr (N > kAccelerometer)
    P.template segment<3>(kAccelerometer).setConstant(squared(p.accelerometer_constant));
  const Vector<3> sigma(p.start_tilt, p.start_tilt, p.start_heading);
  belief.covariance.template block<4, 4>(kQuaternion,
                                         kQuaternion) =  // on the sphere of quaternions, and a little across it
      ofRotation(ins.q_nav_body, sigma.cwiseAbs2()) + squared(kQuaternionRegulariser) * Matrix<4>::Identity();
  return belief;
}

template <int N>
Matrix<N> turnRoot(const NavigationState& ins, const Vector<3>& variance) {
  Matrix<N> root = Matrix<N>::Zero();
  root.template block<4, 3>(kQuaternion, kQuaternion) =
      0.5 * leftTurn(ins.q_nav_body) * variance.cwiseSqrt().asDiagonal();
  return root;
}

#define SAS_MOTION_INSTANTIATE_SINS(N)                                            \
  template class Motion<N>;                                                       \
  template class View<N>;                                                         \
  template Gaussian<N> startBelief<N>(const Parameters&, const NavigationState&); \
  template Matrix<N> turnRoot<N>(const NavigationState&, const Vector<3>&);
SAS_MOTION_INSTANTIATE_SINS(kPaperStates)
SAS_MOTION_INSTANTIATE_SINS(kStates)
#undef SAS_MOTION_INSTANTIATE_SINS

}  // namespace sas_motion::sins

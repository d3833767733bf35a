// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The two cases that filter_answers solves: a linear and a bent one, both with six states and four channels.
#pragma once

#include <nlohmann/json.hpp>

#include "sas_motion/filters/linearized.hpp"
#include "sas_motion/math/gaussian.hpp"
#include "sas_motion/systems/towfish/model.hpp"

namespace sas_motion::benchmark {

using nlohmann::json;
using Belief = Gaussian<6>;
using State = Vector<6>;
using Reading = Vector<4>;

/// A vector as a list, a matrix as a list of its rows.
template <class Derived>
json rows(const Eigen::MatrixBase<Derived>& A) {
  json result = json::array();
  for (int row = 0; row < A.rows(); ++row) {
    json line = json::array();
    for (int col = 0; col < A.cols(); ++col) line.push_back(A(row, col));
    result.push_back(A.cols() == 1 ? line[0] : line);
  }
  return result;
}

inline json described(const Belief& belief) {
  return {{"mean", rows(belief.mean)}, {"covariance", rows(belief.covariance)}};
}

/// Constant velocity in three dimensions; the sensors see the position and, as a log does, a component of the velocity.
struct Linear {
  static constexpr double kDt = 0.1;
  Linear() {
    F.setIdentity();
    F.topRightCorner<3, 3>() = kDt * Matrix<3>::Identity();
    H.topLeftCorner<3, 3>().setIdentity();
    H.row(3) << 0, 0, 0, 0.8, 0.6, 0;
    const Matrix<3> I = Matrix<3>::Identity();
    Q << kDt * kDt * kDt / 3 * I, kDt * kDt / 2 * I, kDt * kDt / 2 * I, kDt * I;
    Q *= 0.01;
    start.mean << 1, -2, 3, 0.8, 0.6, 0;
    start.covariance.diagonal() << 1, 1, 1, 0.1, 0.1, 0.1;
  }
  State f(const State& x) const { return F * x; }
  Reading h(const State& x) const { return H * x; }
  Transition<6> transition(const State& x) const { return {f(x), F, Q}; }
  LinearMeasurement<6, 4> linearized(const Reading& z, const State& x) const { return {z - h(x), H, R}; }
  json description() const { return {{"name", "linear"}, {"F", rows(F)}, {"H", rows(H)}}; }

  Matrix<6> F, Q;
  Matrix<4, 6> H = Matrix<4, 6>::Zero();
  Matrix<4> R = Vector<4>(1, 1, 4, 0.0025).asDiagonal();
  Belief start;
};

/// The towfish in a turn with a GNSS antenna off its centre, all readings together. The heading stays far from +-pi.
struct Towfish {
  static constexpr double kDt = 0.1, kTurnRate = 0.02;
  Towfish() {
    arm.lever_arm_body << 5, 2;
    start.mean << 10, -20, 0.1, -0.1, -1, 2;
    start.covariance.diagonal() << 4, 4, 0.01, 0.01, 0.04, 0.04;
    Q = model.transition(start.mean, {kTurnRate}, kDt).Q;  // frozen, so that f and Q are given once
  }
  State f(const State& x) const { return model.predict(x, {kTurnRate}, kDt); }
  Reading h(const State& x) const {
    return (Reading() << towfish::Model::expected(arm, x), x(towfish::kHeading), x(towfish::kSpeed)).finished();
  }
  Transition<6> transition(const State& x) const { return {f(x), model.transition(x, {kTurnRate}, kDt).F, Q}; }
  LinearMeasurement<6, 4> linearized(const Reading& z, const State& x) const {
    LinearMeasurement<6, 4> linear{z - h(x), Matrix<4, 6>::Zero(), R};
    linear.H.topRows<2>() = model.position(arm, x).H;
    linear.H(2, towfish::kHeading) = linear.H(3, towfish::kSpeed) = 1;
    return linear;
  }
  json description() const {
    return {{"name", "towfish"},
            {"turn_rate", kTurnRate},
            {"dt", kDt},
            {"time_constant", model.parameters().current_time_constant},
            {"lever_arm", rows(arm.lever_arm_body)}};
  }

  towfish::Model model{towfish::MotionParameters{0.1, 300, 0.5 * kRadPerDeg, 0.05, 0.01}};
  towfish::Measurement arm;
  Matrix<6> Q;
  Matrix<4> R = Vector<4>(1, 1, 7.6e-5, 0.0025).asDiagonal();
  Belief start;
};

}  // namespace sas_motion::benchmark

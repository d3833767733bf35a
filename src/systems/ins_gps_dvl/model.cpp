// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/ins_gps_dvl/model.hpp"

#include <array>
#include <cmath>

#include "sas_motion/navigation/attitude.hpp"
#include "sas_motion/navigation/earth.hpp"

namespace sas_motion::ins {

Vector<3> rateOverGround(const NavigationState& ins, const Vector<3>& rate_body) {
  return rate_body - ins.q_nav_body.conjugate() * earth::rotationRate(ins.latitude);
}

namespace {

double markovDensity(double sigma, double time) { return 2 * sigma * sigma / time; }

constexpr double kLeastDvlError = 1e-6;  // of a DVL that drifts, upwards [m/s]

/// By which a drift angle makes a velocity error: that to starboard from forward, and the other way round; body.
Matrix<3> driftTurn() { return -skew(Vector<3>::UnitZ()); }

/// Velocity over the ground of a place on the body against the INS; body.
Vector<3> leverVelocity(const NavigationState& ins, const Vector<3>& rate_body, const Vector<3>& lever_body) {
  return rateOverGround(ins, rate_body).cross(lever_body);
}

Vector<3> positionOf(const NavigationState& state) { return {state.longitude, state.latitude, state.height}; }

}  // namespace

const char* sensorName(Sensor sensor) {
  constexpr std::array<const char*, kSensors> names{"gps", "dvl", "depth", "dpc"};
  return names[static_cast<std::size_t>(sensor)];
}

Vector<3>& leverOf(Parameters& parameters, Sensor sensor) {
  switch (sensor) {
    case Sensor::Gps: return parameters.gps_lever_body;
    case Sensor::Dvl: return parameters.dvl_lever_body;
    case Sensor::Depth: return parameters.depth_lever_body;
    case Sensor::Dpc: break;
  }
  return parameters.dpc_lever_body;
}

Matrix<9> inertialDynamics(const NavigationState& state, const Vector<3>& force_nav) {
  const auto [M, N] = earth::radii(state.latitude, state.height);
  const double s = std::sin(state.latitude), c = std::cos(state.latitude), t = s / c, w = earth::kRotationRate;
  const double vE = state.velocity_nav.x(), vN = state.velocity_nav.y(), vU = state.velocity_nav.z();
  const double fE = force_nav.x(), fN = force_nav.y(), fU = force_nav.z();
  Matrix<9> F;  // vE vN vU, longitude latitude height, phiE phiN phiU
  F << (vN * t - vU) / N, 2 * w * s + vE * t / N, -(2 * w * c + vE / N),  //
      0, 2 * w * (c * vN + s * vU) + vE * vN / (N * c * c), (vE * vU - vE * vN * t) / (N * N), 0, -fU, fN,
      //
      -2 * (w * s + vE * t / N), -vU / M, -vN / M,  //
      0, -(2 * w * c * vE + vE * vE / (N * c * c)), vN * vU / (M * M) + vE * vE * t / (N * N), fU, 0, -fE,
      //
      2 * (w * c + vE / N), 2 * vN / M, 0,  //
      0, -2 * w * s * vE - earth::gravityByLatitude(state.latitude),
      -(vN * vN / (M * M) + vE * vE / (N * N)) + earth::kGravityPerHeight, -fN, fE, 0,
      //
      1 / (N * c), 0, 0, 0, vE * t / (N * c), -vE / (N * N * c), 0, 0, 0,
      //
      0, 1 / M, 0, 0, 0, -vN / (M * M), 0, 0, 0,
      //
      0, 0, 1, 0, 0, 0, 0, 0, 0,
      //
      0, -1 / M, 0, 0, 0, vN / (M * M), 0, w * s + vE * t / N, -(w * c + vE / N),
      //
      1 / N, 0, 0, 0, -w * s, -vE / (N * N), -(w * s + vE * t / N), 0, -vN / M,
      //
      t / N, 0, 0, 0, w * c + vE / (N * c * c), -vE * t / (N * N), w * c + vE / N, vN / M, 0;
  return F;
}

ErrorModel::ErrorModel(const Parameters& parameters, const NavigationState& start)
    : parameters_(parameters),
      dvl_sigma_(Vector<3>::Constant(parameters.dvl_markov)),
      dvl_time_(Vector<3>::Constant(parameters.dvl_time)) {
  if (const auto& drift = parameters.dvl_drift) {
    dvl_sigma_ << drift->angle, drift->offset, kLeastDvlError;
    dvl_time_ << drift->angle_time, drift->offset_time, drift->offset_time;
  }
  const auto [M, N] = earth::radii(start.latitude, start.height);
  const Vector<3> position(1 / (N * std::cos(start.latitude)), 1 / M, 1), ones = Vector<3>::Ones();
  unit_ << ones, position, kMilliradian * ones, kDrift * ones, kDrift * ones, kBias * ones, position, ones, position;
  const Parameters& p = parameters_;
  const auto squared = [](double value) { return value * value; };
  density_.setZero();
  density_.segment<3>(kVelocity).setConstant(squared(p.velocity_random_walk));
  density_.segment<3>(kAttitude).setConstant(squared(p.angle_random_walk / kMilliradian));
  density_.segment<3>(kGyroMarkov).setConstant(markovDensity(p.gyro_markov / kDrift, p.gyro_time));
  for (int axis = 0; axis < 3; ++axis) density_(kGpsPosition + axis) = markovDensity(p.gps_markov(axis), p.gps_time);
  for (int axis = 0; axis < 3; ++axis) density_(kDvlVelocity + axis) = markovDensity(dvl_sigma_(axis), dvl_time_(axis));
  density_.segment<3>(kDvlPosition)
      .setConstant(p.dvl_white.cwiseAbs2().mean() / p.dvl_rate);  // white readings, each held for 1 / rate
}

ErrorMatrix ErrorModel::dynamics(const Motion& motion) const {
  ErrorMatrix F = ErrorMatrix::Zero();
  const Matrix<3> I = Matrix<3>::Identity();
  const Matrix<3>& C = motion.C_nav_body;
  F.topLeftCorner<9, 9>() = inertialDynamics(motion.state, motion.force_nav);  // (C.1), drifts on body axes
  F.block<3, 3>(kVelocity, kAccelerometer) = C;
  F.block<3, 3>(kAttitude, kGyroConstant) = F.block<3, 3>(kAttitude, kGyroMarkov) = -C;
  F.block<3, 3>(kGyroMarkov, kGyroMarkov) = -I / parameters_.gyro_time;
  F.block<3, 3>(kGpsPosition, kGpsPosition) = -I / parameters_.gps_time;                          // (C.3)
  F.block<3, 3>(kDvlVelocity, kDvlVelocity) = -Matrix<3>(dvl_time_.cwiseInverse().asDiagonal());  // (C.4)
  // Dead reckoning turns the reading by the computed attitude: C' v = C v + v x phi.
  const auto scale = unit_.segment<3>(kPosition).asDiagonal();
  F.block<3, 3>(kDvlPosition, kDvlVelocity) = scale * C * dvlErrorByState(C.transpose() * motion.state.velocity_nav);
  F.block<3, 3>(kDvlPosition, kAttitude) = scale * skew(motion.state.velocity_nav);
  return unit_.cwiseInverse().asDiagonal() * F * unit_.asDiagonal();
}

ErrorMatrix ErrorModel::transitionMatrix(const Motion& motion, double T) const {
  const ErrorMatrix FT = dynamics(motion) * T;
  ErrorMatrix Phi = ErrorMatrix::Identity() + FT;
  Phi.noalias() += 0.5 * FT * FT;
  return Phi;
}

Transition<kStates> ErrorModel::transition(const Motion& motion, double T, const Errors& mean) const {
  Transition<kStates> step;
  step.F = transitionMatrix(motion, T);
  step.Q.noalias() = 0.5 * T * (step.F * density_.asDiagonal() * step.F.transpose());
  step.Q.diagonal() += 0.5 * T * density_;
  step.mean.noalias() = step.F * mean;
  return step;
}

Gaussian<kStates> ErrorModel::start() const {
  const Parameters& p = parameters_;
  const Vector<3> ones = Vector<3>::Ones(), attitude(p.start_tilt, p.start_tilt, p.start_heading);
  Errors sigma;
  sigma << p.start_velocity * ones, p.start_position, attitude / kMilliradian, p.gyro_constant / kDrift * ones,
      p.gyro_markov / kDrift * ones, p.accelerometer_constant / kBias * ones, p.gps_markov, dvl_sigma_,
      p.start_position;
  Gaussian<kStates> belief;
  belief.covariance = sigma.cwiseAbs2().asDiagonal();
  // Dead reckoning starts from the position of the INS.
  belief.covariance.block<3, 3>(kPosition, kDvlPosition) = belief.covariance.block<3, 3>(kDvlPosition, kPosition) =
      p.start_position.cwiseAbs2().asDiagonal();
  belief.covariance.diagonal().segment<3>(kDvlPosition).array() += 1e-6;  // [m^2], so that it can be factorised
  return belief;
}

LinearMeasurement<kStates, 3> ErrorModel::gps(const NavigationState& ins, const NavigationState& fix,
                                              const Errors& mean) const {
  LinearMeasurement<kStates, 3> z;
  const Vector<3> lever = ins.q_nav_body * parameters_.gps_lever_body;
  Vector<3> difference = positionOf(fix) - positionOf(ins);
  difference.x() = wrapAngle(difference.x());
  z.H.setZero();
  z.H.block<3, 3>(0, kPosition) = -Matrix<3>::Identity();
  z.H.block<3, 3>(0, kAttitude) = -kMilliradian * skew(lever);
  z.H.block<3, 3>(0, kGpsPosition).setIdentity();
  z.R = parameters_.gps_white.cwiseAbs2().asDiagonal();
  z.innovation = difference.cwiseProduct(metresPerPosition()) - lever - z.H * mean;
  return z;
}

Vector<3> ErrorModel::velocityOfIns(const NavigationState& ins, const Vector<3>& rate_body,
                                    const Vector<3>& velocity_dvl_body) const {
  return velocity_dvl_body - leverVelocity(ins, rate_body, parameters_.dvl_lever_body);
}

LinearMeasurement<kStates, 3> ErrorModel::dvl(const NavigationState& ins, const Vector<3>& rate_body,
                                              const Vector<3>& velocity_body, const Errors& mean) const {
  LinearMeasurement<kStates, 3> z;
  const Matrix<3> C_body_nav = ins.q_nav_body.conjugate().toRotationMatrix();
  z.H.setZero();
  z.H.block<3, 3>(0, kVelocity) = -C_body_nav;
  z.H.block<3, 3>(0, kAttitude) = kMilliradian * C_body_nav * skew(ins.velocity_nav);
  z.H.block<3, 3>(0, kDvlVelocity) = dvlErrorByState(C_body_nav * ins.velocity_nav);
  z.R = parameters_.dvl_white.cwiseAbs2().asDiagonal();
  z.innovation = velocityOfIns(ins, rate_body, velocity_body) - C_body_nav * ins.velocity_nav - z.H * mean;
  if (parameters_.dvl_drift) z.H.leftCols<9>() += mean(kDvlVelocity) * driftTurn() * z.H.leftCols<9>().eval();
  return z;
}

Matrix<3> ErrorModel::dvlErrorByState(const Vector<3>& velocity_body) const {
  Matrix<3> E = Matrix<3>::Identity();
  if (parameters_.dvl_drift) E.col(0) = driftTurn() * velocity_body;
  return E;
}

Vector<3> ErrorModel::dvlError(const Vector<3>& velocity_body, const Errors& mean) const {
  return dvlErrorByState(velocity_body) * mean.segment<3>(kDvlVelocity);
}

LinearMeasurement<kStates, 1> ErrorModel::depth(const NavigationState& ins, double height, const Errors& mean) const {
  LinearMeasurement<kStates, 1> z;
  const Vector<3> lever = ins.q_nav_body * parameters_.depth_lever_body;
  z.H.setZero();
  z.H(0, kPosition + 2) = -1;
  z.H.block<1, 3>(0, kAttitude) = -kMilliradian * skew(lever).row(2);
  z.R(0, 0) = parameters_.depth_white * parameters_.depth_white;
  z.innovation = Vector<1>(height - (ins.height + lever.z())) - z.H * mean;
  return z;
}

LinearMeasurement<kStates, 2> ErrorModel::dpc(const NavigationState& ins, const Vector<3>& rate_body,
                                              const ArrayVelocity& array, const Errors& mean) const {
  LinearMeasurement<kStates, 2> z;
  const Matrix<3> C_body_nav = ins.q_nav_body.conjugate().toRotationMatrix();
  Matrix<2, 3> axes;
  axes << Vector<3>::UnitY().transpose(), array.sight_body.transpose();
  z.H.setZero();
  z.H.block<2, 3>(0, kVelocity) = -axes * C_body_nav;
  z.H.block<2, 3>(0, kAttitude) = kMilliradian * axes * C_body_nav * skew(ins.velocity_nav);
  z.R = array.variance.asDiagonal();
  z.innovation = array.velocity -
                 axes * (C_body_nav * ins.velocity_nav + leverVelocity(ins, rate_body, parameters_.dpc_lever_body)) -
                 z.H * mean;
  return z;
}

Matrix<3> dvlDistortion(double scale, const Vector<3>& misalignment) {
  return (1 + scale) * (Matrix<3>::Identity() - skew(misalignment));
}

NavigationState corrected(const NavigationState& ins, const Errors& errors, const Errors& unit) {
  NavigationState state = ins;
  const Errors e = errors.cwiseProduct(unit);
  state.velocity_nav -= e.segment<3>(kVelocity);
  state.longitude = wrapAngle(state.longitude - e(kPosition));
  state.latitude -= e(kPosition + 1);
  state.height -= e(kPosition + 2);
  const Vector<3> phi = e.segment<3>(kAttitude);
  state.q_nav_body = Eigen::Quaterniond(Eigen::AngleAxisd(phi.norm(), phi.stableNormalized())) * ins.q_nav_body;
  return state;
}

}  // namespace sas_motion::ins

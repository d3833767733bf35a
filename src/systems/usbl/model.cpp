// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/usbl/model.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sas_motion/math/angles.hpp"
#include "sas_motion/navigation/attitude.hpp"

namespace sas_motion::usbl {
namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

double arccos(double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); }

/// d acos(p_axis / r) / dp. Near the axis, where it has no direction, the distance from the axis is at least 1e-6 r.
Matrix<1, 3> directionAngleGradient(const Vector<3>& p, int axis) {
  const double r = p.norm(), across = std::max(std::sqrt(std::max(0.0, r * r - p(axis) * p(axis))), 1e-6 * r);
  Vector<3> gradient = p * (p(axis) / (r * r));
  gradient(axis) -= 1;
  return gradient.transpose() / across;
}

Matrix<1, 3> cosineGradient(const Vector<3>& p, int axis) {
  const double r = p.norm();
  Vector<3> gradient = -p * (p(axis) / (r * r * r));
  gradient(axis) += 1 / r;
  return gradient.transpose();
}

Matrix<1, 3> azimuthGradient(const Vector<3>& p) {
  const double square = std::max(p.head<2>().squaredNorm(), 1e-12 * p.squaredNorm());
  return Vector<3>(p(1) / square, -p(0) / square, 0).transpose();
}

Matrix<1, 3> elevationGradient(const Vector<3>& p) {
  const double r = p.norm(), across = std::max(p.head<2>().norm(), 1e-6 * r);
  Vector<3> gradient = -p * (p(2) / (r * r));
  gradient(2) += 1;
  return gradient.transpose() / across;
}

/// The factors of the mounting rotation C = Z X Y and their derivatives.
struct MountingFactors {
  Matrix<3> Z, X, Y, dZ, dX, dY;

  explicit MountingFactors(const Vector<3>& a) {
    const auto turn = [](double angle, int axis, double sign, Matrix<3>& R, Matrix<3>& dR) {
      const Vector<3> unit = Vector<3>::Unit(axis);
      R = Eigen::AngleAxisd(sign * angle, unit).toRotationMatrix();
      Matrix<3> cross;
      cross << 0, -unit(2), unit(1), unit(2), 0, -unit(0), -unit(1), unit(0), 0;
      dR = sign * cross * R;
    };
    turn(a(kMountingX), 0, 1, X, dX);
    turn(a(kMountingY), 1, 1, Y, dY);
    turn(a(kMountingZ), 2, -1, Z, dZ);
  }
};

/// From the array's centre to the transponder, in body axes.
Vector<3> transponderFromArrayBody(const Unknowns& x, const Ping& ping) {
  return ping.C_body_map * (ping.transponder_map + x.segment<3>(kTransponderX)) - x.segment<3>(kLeverX);
}

}  // namespace

const std::array<std::string, kUnknowns>& unknownNames() {
  static const std::array<std::string, kUnknowns> names{"mounting_x",    "mounting_y", "mounting_z",    "lever_x",
                                                        "lever_y",       "lever_z",    "transponder_x", "transponder_y",
                                                        "transponder_z", "range_scale"};
  return names;
}

const std::vector<std::string>& modeNames() {
  static const std::vector<std::string> names{"direction_angles", "direction_cosines", "azimuth_elevation", "azimuth"};
  return names;
}

Mode modeFromName(const std::string& name) {
  const auto& names = modeNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw std::invalid_argument("'" + name +
                                "' is no mode; take direction_angles, direction_cosines, azimuth_elevation or azimuth");
  return static_cast<Mode>(found - names.begin());
}

const std::string& modeName(Mode mode) { return modeNames()[static_cast<std::size_t>(mode)]; }

Matrix<3> mountingRotation(const Vector<3>& angles) {
  return rotationOf({angles(kMountingX), angles(kMountingY), angles(kMountingZ)});
}

Vector<3> transponderInArray(const Unknowns& x, const Ping& ping) {
  return mountingRotation(x.head<3>()).transpose() * transponderFromArrayBody(x, ping);
}

Vector<kChannels> Model::predict(const Unknowns& x, const Ping& ping) const {
  const Vector<3> p = transponderInArray(x, ping);
  const double r = p.norm(), range = (1 + x(kRangeScale)) * r;
  switch (mode_) {
    case Mode::DirectionAngles: return {range, arccos(p(0) / r), arccos(p(1) / r)};
    case Mode::DirectionCosines: return {range, p(0) / r, p(1) / r};
    case Mode::AzimuthElevation: return {range, std::atan2(p(0), p(1)), std::asin(std::clamp(p(2) / r, -1.0, 1.0))};
    case Mode::Azimuth: break;
  }
  return {range, std::atan2(p(0), p(1)), 0};
}

Matrix<kChannels, kUnknowns> Model::jacobian(const Unknowns& x, const Ping& ping) const {
  const MountingFactors f(x.head<3>());
  const Matrix<3> C = f.Z * f.X * f.Y;
  const Vector<3> d = transponderFromArrayBody(x, ping), p = C.transpose() * d;
  Matrix<3, kUnknowns> dp = Matrix<3, kUnknowns>::Zero();
  dp.col(kMountingX) = (f.Z * f.dX * f.Y).transpose() * d;
  dp.col(kMountingY) = (f.Z * f.X * f.dY).transpose() * d;
  dp.col(kMountingZ) = (f.dZ * f.X * f.Y).transpose() * d;
  dp.middleCols<3>(kLeverX) = -C.transpose();
  dp.middleCols<3>(kTransponderX) = C.transpose() * ping.C_body_map;

  Matrix<kChannels, 3> direction = Matrix<kChannels, 3>::Zero();
  direction.row(0) = (1 + x(kRangeScale)) * p.transpose() / p.norm();
  switch (mode_) {
    case Mode::DirectionAngles:
      direction.bottomRows<2>() << directionAngleGradient(p, 0), directionAngleGradient(p, 1);
      break;
    case Mode::DirectionCosines: direction.bottomRows<2>() << cosineGradient(p, 0), cosineGradient(p, 1); break;
    case Mode::AzimuthElevation: direction.bottomRows<2>() << azimuthGradient(p), elevationGradient(p); break;
    case Mode::Azimuth: direction.row(1) = azimuthGradient(p); break;
  }
  Matrix<kChannels, kUnknowns> H = direction * dp;
  H(0, kRangeScale) = p.norm();
  return H;
}

Reading Model::convert(const Reading& angles) const {
  if (mode_ == Mode::DirectionAngles) return angles;
  Reading result{{angles.value(0), kAbsent, kAbsent}, {angles.variance(0), kAbsent, kAbsent}};
  const double cx = std::cos(angles.value(1)), cy = std::cos(angles.value(2));
  const double vx = std::pow(std::sin(angles.value(1)), 2) * angles.variance(1),
               vy = std::pow(std::sin(angles.value(2)), 2) * angles.variance(2);
  if (mode_ == Mode::DirectionCosines) {
    result.value.tail<2>() << cx, cy;
    result.variance.tail<2>() << vx, vy;
    return result;
  }
  const double square = cx * cx + cy * cy;
  if (!angles.has(1) || !angles.has(2) || !(square > 0) || square > 1) return result;  // no direction has these angles
  result.value(1) = std::atan2(cx, cy);
  result.variance(1) = (cy * cy * vx + cx * cx * vy) / (square * square);
  if (mode_ == Mode::Azimuth) return result;
  result.value(2) = -std::acos(std::sqrt(square));
  result.variance(2) = (cx * cx * vx + cy * cy * vy) / (square * std::max(1 - square, 1e-12));
  return result;
}

Vector<kChannels> Model::difference(const Vector<kChannels>& y, const Vector<kChannels>& x) const {
  Vector<kChannels> d = y - x;
  if (mode_ != Mode::DirectionCosines) d.tail<2>() = d.tail<2>().unaryExpr(&wrapAngle);
  return d;
}

}  // namespace sas_motion::usbl

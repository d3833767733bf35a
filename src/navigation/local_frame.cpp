// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/navigation/local_frame.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace sas_motion {
namespace {

const Geodetic& checked(const Geodetic& datum) {
  constexpr double full_turn_deg = 360,
                   highest = 1e5;  // far beyond any vessel; a wrong unit is beyond it
  if (!(std::abs(datum.latitude_deg) <= 90) || !(std::abs(datum.longitude_deg) <= full_turn_deg) ||
      !(std::abs(datum.altitude) <= highest))
    throw std::invalid_argument(fmt::format("the datum {}, {}, {} is no place on Earth", datum.latitude_deg,
                                            datum.longitude_deg, datum.altitude));
  return datum;
}

}  // namespace

LocalFrame::LocalFrame(const Geodetic& datum)
    : datum_(checked(datum)), plane_(datum.latitude_deg, datum.longitude_deg, datum.altitude) {}

Vector<3> LocalFrame::position_enu(const Geodetic& point) const {
  Vector<3> position;
  plane_.Forward(point.latitude_deg, point.longitude_deg, point.altitude, position(0), position(1), position(2));
  return position;
}

Matrix<3> LocalFrame::C_map_nav(const Geodetic& point) const {
  std::vector<double> rows(9);
  Vector<3> position;
  plane_.Forward(point.latitude_deg, point.longitude_deg, point.altitude, position(0), position(1), position(2), rows);
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data());
}

Geodetic LocalFrame::geodetic(const Vector<3>& position_enu) const {
  Geodetic point;
  plane_.Reverse(position_enu(0), position_enu(1), position_enu(2), point.latitude_deg, point.longitude_deg,
                 point.altitude);
  return point;
}

}  // namespace sas_motion

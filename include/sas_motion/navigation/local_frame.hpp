// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <GeographicLib/LocalCartesian.hpp>

#include "sas_motion/math/types.hpp"

namespace sas_motion {

/// Geodetic coordinates on WGS 84, angles in degrees as messages carry them.
struct Geodetic {
  double latitude_deg = 0;
  double longitude_deg = 0;
  double altitude = 0;  ///< above the ellipsoid [m]
};

/// The local tangent plane at a datum, with coordinates in metres [Karney, GeographicLib::LocalCartesian].
class LocalFrame {
 public:
  /// Throws std::invalid_argument where the latitude is outside +-90 degrees or a coordinate is not finite.
  explicit LocalFrame(const Geodetic& datum);

  /// East, north and up of the datum [m].
  Vector<3> position_enu(const Geodetic& point) const;
  Geodetic geodetic(const Vector<3>& position_enu) const;
  /// Rotates from east, north, up at a point to those at the datum.
  Matrix<3> C_map_nav(const Geodetic& point) const;
  const Geodetic& datum() const { return datum_; }

 private:
  Geodetic datum_;
  GeographicLib::LocalCartesian plane_;
};

}  // namespace sas_motion

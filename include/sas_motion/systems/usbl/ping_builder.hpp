// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sas_motion/config/yaml_section.hpp"
#include "sas_motion/navigation/local_frame.hpp"
#include "sas_motion/systems/usbl/model.hpp"

namespace sas_motion::usbl {

struct PingBuilderOptions {
  double attitude_gap = 0.5;  ///< longest gap between attitudes that is interpolated over [s]
  double position_gap = 1.5;  ///< longest gap between positions that is interpolated over [s]
  double wait = 10;           ///< a ping waits for late poses until a ping this much later arrives [s]
};
/// Reads the section pings. Throws ConfigError.
void readConfig(YamlSection yaml, PingBuilderOptions& options);

/// The reason why a reading gave no ping.
enum class Omission { NoChannel, NoTransponder, BeforeFirstFix, PositionGap, AttitudeGap, Late };
constexpr int kOmissions = 6;
/// In plain words: "without a usable channel", ...
const std::string& omissionText(Omission omission);

/// Makes pings from the vessel's sensors: interpolates the pose at each reception. Poses and readings may come in any
/// order; pings leave in the order of their stamps. The reference point is computed at the GNSS stamps, with
/// interpolated attitude for the antenna's lever arm, and interpolated afterwards, since it swings less than the
/// antenna.
class PingBuilder {
 public:
  explicit PingBuilder(const PingBuilderOptions& options) : options_(options) {}

  /// Replaces the body by the nominal array in later pings, so that a calibration gives a correction of the mounting.
  void setNominal(const Mounting& nominal) { nominal_ = nominal; }
  /// Sets a surveyed transponder's position.
  void addTransponder(std::uint32_t id, const Geodetic& position) { transponders_[id] = position; }
  /// Adds a position of the GNSS antenna; `lever_arm_body` is its place from the reference point [m].
  void addPosition(Stamp stamp, const Geodetic& antenna, const Vector<3>& lever_arm_body);
  /// v_map = C v_body; the map's axes are east, north, up.
  void addAttitude(Stamp stamp, const Matrix<3>& C_map_body);
  /// Adds a reading of direction angles to the transponder with this id.
  void addReading(Stamp stamp, std::uint32_t transponder, const Reading& reading);

  /// The pings that need not wait.
  std::vector<Ping> take() { return build(false); }
  /// All further pings, at the end of the data.
  std::vector<Ping> finish() { return build(true); }

  std::uint64_t omitted(Omission omission) const { return omitted_[static_cast<std::size_t>(omission)]; }
  std::uint64_t readings() const { return readings_; }
  const Mounting& nominal() const { return nominal_; }
  const std::map<std::uint32_t, Geodetic>& transponders() const { return transponders_; }

 private:
  struct Fix {
    Vector<3> antenna_frame;  // in frame_
    Vector<3> lever_arm_body;
  };
  using Key = std::pair<Stamp, std::uint32_t>;  // stamp and transponder of a reading
  using Attitudes = std::map<Stamp, Eigen::Quaterniond>;
  using Fixes = std::map<Stamp, Fix>;

  std::vector<Ping> build(bool all);
  /// A ping, or the reason for none.
  std::optional<Ping> assemble(const Key& key, const Reading& reading, Omission& why) const;
  std::optional<Eigen::Quaterniond> attitudeAt(Stamp stamp) const;
  std::optional<Vector<3>> referenceAt(Stamp stamp, Omission& why) const;
  std::optional<Vector<3>> reference(Fixes::const_iterator fix) const;
  void omit(Omission omission) { ++omitted_[static_cast<std::size_t>(omission)]; }
  void forgetBefore(Stamp stamp);

  PingBuilderOptions options_;
  Mounting nominal_;
  std::optional<LocalFrame> frame_;  // at the first fix: positions are interpolated there
  std::map<std::uint32_t, Geodetic> transponders_;
  Attitudes attitudes_;
  Fixes fixes_;
  std::map<Key, Reading> waiting_;
  std::optional<Key> decided_;  // the last reading that left waiting_
  std::optional<Stamp> first_fix_;
  Stamp latest_ = 0;  // stamp of the reading that arrived last
  std::array<std::uint64_t, kOmissions> omitted_{};
  std::uint64_t readings_ = 0;
};

}  // namespace sas_motion::usbl

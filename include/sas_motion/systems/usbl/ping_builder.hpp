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

#include "sas_motion/navigation/local_frame.hpp"
#include "sas_motion/systems/usbl/mounting.hpp"

namespace sas_motion::usbl {

struct PingBuilderOptions {
  double attitude_gap = 0.5;  ///< attitudes further apart are not interpolated between [s]
  double position_gap = 1.5;  ///< nor positions [s]
  double wait = 10;           ///< a ping waits for late poses until a ping this much later has come [s]
};

/// Why a reading gave no ping.
enum class Omission { NoChannel, NoTransponder, BeforeFirstFix, PositionGap, AttitudeGap, Late };
constexpr int kOmissions = 6;
/// In plain words: "without a usable channel", ...
const std::string& omissionText(Omission omission);

/// Makes pings of what the vessel's sensors say: the pose at each reception, interpolated between its neighbours, and
/// the surveyed transponder from there. Poses and readings may come in any order; pings leave in the order of their
/// stamps.
///
/// The reference point is found at the antenna's stamps, where the attitude is interpolated to take its lever arm off,
/// and then interpolated itself: a mast's antenna swings with the waves, the reference point hardly does.
class PingBuilder {
 public:
  explicit PingBuilder(const PingBuilderOptions& options) : options_(options) {}

  /// The nominal mounting takes the body's place in the pings made from now on: what a calibration finds of them is a
  /// correction of it.
  void setNominal(const Mounting& nominal) { nominal_ = nominal; }
  /// A surveyed transponder; the last word counts.
  void addTransponder(std::uint32_t id, const Geodetic& position) { transponders_[id] = position; }
  /// Of the GNSS antenna, which is `lever_arm_body` from the reference point; starboard, forward, up [m].
  void addPosition(Stamp stamp, const Geodetic& antenna, const Vector<3>& lever_arm_body);
  /// v_map = C v_body, the map's axes being east, north, up.
  void addAttitude(Stamp stamp, const Matrix<3>& C_map_body);
  /// Direction angles by the transponder with this id.
  void addReading(Stamp stamp, std::uint32_t transponder, const Reading& reading);

  /// The pings that are ready.
  std::vector<Ping> take();
  /// The pings that can still be made of what is there: the data end here.
  std::vector<Ping> finish();

  std::uint64_t omitted(Omission omission) const { return omitted_[static_cast<std::size_t>(omission)]; }
  std::uint64_t readings() const { return readings_; }  ///< that came
  const Mounting& nominal() const { return nominal_; }

 private:
  struct Fix {
    Vector<3> antenna_frame;  // in frame_
    Vector<3> lever_arm_body;
  };
  struct Waiting {
    std::uint32_t transponder;
    Reading reading;
  };
  using Attitudes = std::map<Stamp, Eigen::Quaterniond>;
  using Fixes = std::map<Stamp, Fix>;

  std::vector<Ping> build(bool all);
  /// A ping, or why there is none.
  std::optional<Ping> assemble(Stamp stamp, const Waiting& waiting, Omission& why) const;
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
  std::map<std::pair<Stamp, std::uint32_t>, Waiting> waiting_;
  std::optional<std::pair<Stamp, std::uint32_t>> decided_;  // the last that was
  std::optional<Stamp> first_fix_;
  Stamp latest_ = 0;  // stamp of the reading that came last
  std::array<std::uint64_t, kOmissions> omitted_{};
  std::uint64_t readings_ = 0;
};

}  // namespace sas_motion::usbl

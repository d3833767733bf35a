// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/usbl/ping_builder.hpp"

#include <algorithm>
#include <cmath>

namespace sas_motion::usbl {
namespace {

constexpr std::size_t kMostPoses = 100'000;  // kept where no reading comes

bool onEarth(const Geodetic& p) {
  return std::abs(p.latitude_deg) <= 90 && std::isfinite(p.longitude_deg) && std::isfinite(p.altitude);
}

bool usable(const Reading& reading) { return reading.has(0) || reading.has(1) || reading.has(2); }

/// The neighbours of a stamp, the same twice where a sample has this stamp; nothing where they are further apart than
/// `gap` [s] or one is missing.
template <class Map, class Iterator = typename Map::const_iterator>
std::optional<std::pair<Iterator, Iterator>> neighbours(const Map& samples, Stamp stamp, double gap) {
  const auto after = samples.lower_bound(stamp);
  if (after == samples.end()) return std::nullopt;
  if (after->first == stamp) return std::pair(after, after);
  if (after == samples.begin()) return std::nullopt;
  const auto before = std::prev(after);
  if (secondsBetween(before->first, after->first) > gap) return std::nullopt;
  return std::pair(before, after);
}

/// The place of a stamp between two, 0 to 1.
double share(Stamp before, Stamp stamp, Stamp after) {
  return before == after ? 0 : secondsBetween(before, stamp) / secondsBetween(before, after);
}

template <class Map>
void keepRecent(Map& samples) {
  while (samples.size() > kMostPoses) samples.erase(samples.begin());
}

}  // namespace

const std::string& omissionText(Omission omission) {
  static const std::array<std::string, kOmissions> texts{
      "without a usable channel",          "of a transponder without a position", "before the first GNSS fix",
      "where GNSS positions pause or end", "where attitudes pause or end",        "late or twice"};
  return texts[static_cast<std::size_t>(omission)];
}

void PingBuilder::addPosition(Stamp stamp, const Geodetic& antenna, const Vector<3>& lever_arm_body) {
  if (!onEarth(antenna)) return;
  if (!frame_) frame_.emplace(antenna);
  first_fix_ = first_fix_ ? std::min(*first_fix_, stamp) : stamp;
  fixes_[stamp] = {frame_->position_enu(antenna), lever_arm_body};
  keepRecent(fixes_);
}

void PingBuilder::addAttitude(Stamp stamp, const Matrix<3>& C_map_body) {
  if (!C_map_body.allFinite()) return;
  attitudes_[stamp] = Eigen::Quaterniond(C_map_body).normalized();
  keepRecent(attitudes_);
}

void PingBuilder::addReading(Stamp stamp, std::uint32_t transponder, const Reading& reading) {
  ++readings_;
  latest_ = stamp;
  const Key key(stamp, transponder);
  if (!usable(reading))
    omit(Omission::NoChannel);
  else if ((decided_ && key <= *decided_) || !waiting_.emplace(key, reading).second)
    omit(Omission::Late);
}

/// Builds pings from the oldest reading to the first that has to wait.
std::vector<Ping> PingBuilder::build(bool all) {
  std::vector<Ping> pings;
  while (!waiting_.empty()) {
    const auto& [key, reading] = *waiting_.begin();
    Omission why{};
    const auto ping = assemble(key, reading, why);
    if (!ping && !all && secondsBetween(key.first, latest_) <= options_.wait) break;
    if (ping)
      pings.push_back(*ping);
    else
      omit(why);
    decided_ = key;
    forgetBefore(key.first - stampFromSeconds(options_.wait + options_.position_gap + options_.attitude_gap));
    waiting_.erase(waiting_.begin());
  }
  return pings;
}

std::optional<Ping> PingBuilder::assemble(const Key& key, const Reading& reading, Omission& why) const {
  const Stamp stamp = key.first;
  const auto transponder = transponders_.find(key.second);
  why = Omission::NoTransponder;
  if (transponder == transponders_.end() || !onEarth(transponder->second)) return std::nullopt;
  const auto position = referenceAt(stamp, why);
  if (!position) return std::nullopt;
  why = Omission::AttitudeGap;
  const auto attitude = attitudeAt(stamp);
  if (!attitude) return std::nullopt;

  const Matrix<3> C_map_body = attitude->toRotationMatrix();
  Ping ping;
  ping.stamp = stamp;
  ping.C_body_map = (C_map_body * nominal_.C_body_array).transpose();
  ping.transponder_map =
      LocalFrame(frame_->geodetic(*position)).position_enu(transponder->second) - C_map_body * nominal_.lever_arm_body;
  ping.reading = reading;
  return ping;
}

std::optional<Eigen::Quaterniond> PingBuilder::attitudeAt(Stamp stamp) const {
  const auto found = neighbours(attitudes_, stamp, options_.attitude_gap);
  if (!found) return std::nullopt;
  const auto& [before, after] = *found;
  return before->second.slerp(share(before->first, stamp, after->first), after->second);
}

std::optional<Vector<3>> PingBuilder::referenceAt(Stamp stamp, Omission& why) const {
  const bool early = !first_fix_ || stamp < *first_fix_;
  why = early ? Omission::BeforeFirstFix : Omission::PositionGap;
  const auto found = neighbours(fixes_, stamp, options_.position_gap);
  if (!found) return std::nullopt;
  why = Omission::AttitudeGap;
  const auto before = reference(found->first), after = reference(found->second);
  if (!before || !after) return std::nullopt;
  return *before + share(found->first->first, stamp, found->second->first) * (*after - *before);
}

/// The reference point at a fix, with the antenna's vertical, which differs by a millionth.
std::optional<Vector<3>> PingBuilder::reference(Fixes::const_iterator fix) const {
  const auto& [antenna, lever_arm] = fix->second;
  if (lever_arm.isZero(0)) return antenna;
  const auto attitude = attitudeAt(fix->first);
  if (!attitude) return std::nullopt;
  const LocalFrame here(frame_->geodetic(antenna));
  return frame_->position_enu(here.geodetic(-(*attitude * lever_arm)));
}

void PingBuilder::forgetBefore(Stamp stamp) {
  fixes_.erase(fixes_.begin(), fixes_.lower_bound(stamp));
  attitudes_.erase(attitudes_.begin(), attitudes_.lower_bound(stamp));
}

}  // namespace sas_motion::usbl

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/towfish/ros/system.hpp"

#include <fmt/format.h>
#include <geometry_msgs/TwistWithCovarianceStamped.h>

#include <algorithm>
#include <cmath>

#include "sas_motion/config/yaml_vector.hpp"
#include "sas_motion/estimate/source_name.hpp"
#include "sas_motion/systems/towfish/session.hpp"
#include "systems/towfish/graph/estimators.hpp"

namespace sas_motion::ros_side {
namespace {

using namespace towfish;  // the names of the states
using Twist = geometry_msgs::TwistWithCovarianceStamped;
using sensor_msgs::Imu;
using sensor_msgs::NavSatFix;

/// What of a source's messages is read.
struct Reader {
  Sensor sensor;
  SensorOptions options;
  int number = -1;             // of the source, see Measurement
  const char* name = nullptr;  // the same
};
using Readers = std::vector<Reader>;  // of one source

double usedFrom(double variance, const SensorOptions& options) {
  return usedVariance(variance, options.sigma, options.floor, options.override_message);
}

/// Clockwise from north, of a body whose x axis points forward.
double headingOf(const Eigen::Quaterniond& q_map_base) {
  const Eigen::Vector3d forward = q_map_base * Eigen::Vector3d::UnitX();
  return std::atan2(forward.x(), forward.y());
}

// Each function fills value, variance and lever arm of a measurement, and returns whether there is one. What is absent
// in a message (no fix, no orientation, covariance[0] = -1) is left out; what is wrong in it comes through and is
// refused by the estimators, which count it.

bool readPosition(const NavSatFix& fix, const LocalFrame& frame, const Transform& T_base_gnss,
                  const SensorOptions& options, Measurement& z) {
  if (fix.status.status < 0) return false;
  z.value.setConstant(NAN);
  if (hasPosition(fix)) {
    const Vector<3> enu = frame.position_enu(geodeticOf(fix));
    z.value << enu(1), enu(0);
  }
  const bool known = fix.position_covariance_type != NavSatFix::COVARIANCE_TYPE_UNKNOWN;
  z.variance << usedFrom(known ? fix.position_covariance[4] : -1, options),
      usedFrom(known ? fix.position_covariance[0] : -1, options);
  z.lever_arm_body << T_base_gnss.translation().x(), -T_base_gnss.translation().y();
  return true;
}

bool readHeading(const Imu& imu, const Transform& T_base_imu, const SensorOptions& options, Measurement& z) {
  if (imu.orientation_covariance[0] == -1) return false;
  const Eigen::Quaterniond q = quaternionOf(imu.orientation);
  const bool unit = std::abs(q.squaredNorm() - 1) < 0.1;
  z.value << (unit ? headingOf(q.normalized() * Eigen::Quaterniond(T_base_imu.linear()).conjugate()) : NAN), 0;
  if (options.offset != 0) z.value(0) = wrapAngle(z.value(0) + options.offset);
  z.variance.setConstant(usedFrom(imu.orientation_covariance[8], options));
  return true;
}

bool readTurnRate(const Imu& imu, const Transform& T_base_imu, const SensorOptions& options, Measurement& z) {
  if (imu.angular_velocity_covariance[0] == -1) return false;
  z.value << -(T_base_imu.linear() * vectorOf(imu.angular_velocity)).z(), 0;
  z.variance.setConstant(usedFrom(imu.angular_velocity_covariance[8], options));
  return true;
}

bool readSpeed(const Twist& twist, const Transform& T_base_dvl, const SensorOptions& options, Measurement& z) {
  const auto& v = twist.twist.twist.linear;
  const Eigen::Vector3d axis = T_base_dvl.linear().row(0);  // base x in the sensor's axes
  double speed = 0, variance = 0;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(axis(i)) < 1e-6) continue;  // an axis that the sensor may not measure does not matter then
    speed += axis(i) * (i == 0 ? v.x : i == 1 ? v.y : v.z);
    variance += axis(i) * axis(i) * twist.twist.covariance[7 * static_cast<std::size_t>(i)];
  }
  z.value << options.scale * speed, 0;
  z.variance.setConstant(usedFrom(variance, options));
  return true;
}

/// Over ground, of a DVL with bottom lock. Its lever arm is not applied: a towed body turns slowly.
bool readVelocity(const Twist& twist, const Transform& T_base_dvl, const SensorOptions& options, Measurement& z) {
  const Vector<3> velocity = options.scale * (T_base_dvl.linear() * vectorOf(twist.twist.twist.linear));
  const auto& P = twist.twist.covariance;
  const Vector<3> variance = T_base_dvl.linear().cwiseAbs2() * Vector<3>(P[0], P[7], P[14]);
  z.value << velocity.x(), -velocity.y();
  z.variance << usedFrom(variance.x(), options), usedFrom(variance.y(), options);
  return true;
}

/// Messages become measurements of the towfish.
class TowfishRun final : public SystemRun {
 public:
  TowfishRun(const System& system, const Config& config, const std::vector<Readers>& readers,
             const std::vector<std::string>& names, const tf2::BufferCore& transforms, bool live)
      : SystemRun(system.map, system.sources, transforms),
        readers_(readers),
        session_(config, names, makeAnyEstimator, live) {
    for (std::size_t i = 0; i < readers_.size(); ++i) listenTo(i);
  }

  Session& session() override { return session_; }
  std::string waitsFor() const override {
    for (const Sensor needed : {Sensor::Position, Sensor::Heading})
      if (std::string lack = lackOfSensor(needed); !lack.empty()) return lack;
    return "";
  }
  std::vector<std::string> warnings() const override {
    std::vector<std::string> warnings;
    for (std::size_t i = 0; i < sources().size(); ++i)
      if (sources()[i].must_speak && inbox().counts(i).messages == 0)
        warnings.push_back(fmt::format("{}: no message on {} has come", sources()[i].name, sources()[i].wanted_topic));
    return warnings;
  }

 private:
  void listenTo(std::size_t source) {
    switch (readers_[source].front().sensor) {
      case Sensor::Position:
        return listenAt<NavSatFix>(source, [this, source](const NavSatFix& fix, const Transform& T) {
          if (!frame_.map && hasPosition(fix)) setDatum(geodeticOf(fix));
          return frame_.map && pass(fix, T, source);
        });
      case Sensor::Heading:
      case Sensor::TurnRate:
        return listenAt<Imu>(source,
                             [this, source](const Imu& imu, const Transform& T) { return pass(imu, T, source); });
      case Sensor::Speed:
      case Sensor::Velocity:
        return listenAt<Twist>(
            source, [this, source](const Twist& twist, const Transform& T) { return pass(twist, T, source); });
    }
  }

  /// Returns whether there was any measurement.
  template <class Message>
  bool pass(const Message& message, const Transform& T_base_sensor, std::size_t source) {
    bool any = false;
    for (const auto& reader : readers_[source]) {
      if (!reader.options.enabled) continue;
      Measurement z;
      z.stamp = stampOf(message.header.stamp) + stampFromSeconds(reader.options.time_offset);
      z.sensor = reader.sensor;
      z.source = reader.number;
      z.source_name = reader.name;
      if (!read(message, T_base_sensor, reader, z)) continue;
      session_.process(z);
      any = true;
    }
    return any;
  }

  bool read(const NavSatFix& fix, const Transform& T, const Reader& reader, Measurement& z) const {
    return readPosition(fix, *frame_.map, T, reader.options, z);
  }
  bool read(const Imu& imu, const Transform& T, const Reader& reader, Measurement& z) const {
    const auto& take = reader.sensor == Sensor::Heading ? readHeading : readTurnRate;
    return take(imu, T, reader.options, z);
  }
  bool read(const Twist& twist, const Transform& T, const Reader& reader, Measurement& z) const {
    const auto& take = reader.sensor == Sensor::Speed ? readSpeed : readVelocity;
    return take(twist, T, reader.options, z);
  }

  /// Why no source of a sensor has a reading; empty where one has.
  std::string lackOfSensor(Sensor sensor) const {
    std::string lack;
    for (std::size_t i = 0; i < readers_.size(); ++i) {
      const auto reader =
          std::find_if(readers_[i].begin(), readers_[i].end(), [&](const Reader& r) { return r.sensor == sensor; });
      if (reader == readers_[i].end()) continue;
      const MessageCounts& counts = inbox().counts(i);
      if (counts.messages > counts.unusable + counts.unknown_frame + counts.disabled) return "";
      if (!lack.empty()) continue;
      lack = !reader->options.enabled     ? sources()[i].topic + " is disabled"
             : sensor == Sensor::Position ? lackOf(i, "has no message with a fix")
                                          : lackOf(i, "has no message with an orientation or a turn rate");
    }
    return lack;
  }

  std::vector<Readers> readers_;  // by source
  TowfishSession session_;
};

class TowfishSystem final : public System {
 public:
  explicit TowfishSystem(YamlSection& yaml) {
    estimators = estimatorNames();
    preferred = {"kf", "robust_kf"};
    smoothers = {"fixed_lag"};
    has_current = true;
    readSystem(yaml, "towfish");
    readConfig(yaml, config_);
    if (config_.sources.empty())
      takeDefaultSources(yaml);
    else
      for (const auto& source : config_.sources) takeSource(source);
    map.readMap(yaml);
    yaml.finish();
    tuning = tuningOf(config_);
  }

  /// A filter with another loss has a name that is not listed.
  bool knows(const std::string& name) const override { return makeAnyEstimator(name, config_) != nullptr; }
  std::unique_ptr<SystemRun> begin(const std::vector<std::string>& names, const tf2::BufferCore& transforms,
                                   bool live) const override {
    return std::make_unique<TowfishRun>(*this, config_, readers_, names, transforms, live);
  }

 private:
  void takeDefaultSources(YamlSection& yaml) {
    sources = {sourceOf<NavSatFix>("fix", "gnss/fix", "positions are needed"),
               sourceOf<Imu>("imu", "imu/data", "headings are needed"),
               sourceOf<Twist>("twist", "dvl/twist", "speeds help"),
               sourceOf<Twist>("velocity", "dvl/velocity", "velocities over ground help")};
    sources[0].need = sources[1].need = MessageSource::Need::Required;
    sources[3].need = MessageSource::Need::NamedAlone;
    const auto of = [this](Sensor sensor) { return Reader{sensor, config_.sensor(sensor)}; };
    readers_ = {{of(Sensor::Position)},
                {of(Sensor::Heading), of(Sensor::TurnRate)},
                {of(Sensor::Speed)},
                {of(Sensor::Velocity)}};
    readTopics(yaml, sources);
  }

  void takeSource(const SourceOptions& source) {
    Readers readers;
    for (const auto& kind : source.measures)
      readers.push_back(
          {*sensorFromName(kind), source.options, static_cast<int>(sources.size()), lastingName(source.name)});
    const auto add = [&](auto message) {
      sources.push_back(sourceOf<decltype(message)>(source.name, source.topic, ""));
      sources.back().need = MessageSource::Need::NamedAlone;
      sources.back().enabled = source.options.enabled;
      sources.back().must_speak = source.options.enabled;
    };
    const Sensor first = readers.front().sensor;
    if (first == Sensor::Position)
      add(NavSatFix());
    else if (first == Sensor::Speed || first == Sensor::Velocity)
      add(Twist());
    else
      add(Imu());
    readers_.push_back(std::move(readers));
  }

  Config config_;
  std::vector<Readers> readers_;  // by source
};

}  // namespace

std::unique_ptr<System> openTowfish(YamlSection& yaml) { return std::make_unique<TowfishSystem>(yaml); }

}  // namespace sas_motion::ros_side

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <geometry_msgs/TransformStamped.h>
#include <sas_motion/MeasurementLabel.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <stdexcept>

#include "bag/bag_reader.hpp"
#include "bag/topics.hpp"
#include "systems/usbl/ros/calibration_result.hpp"

namespace sas_motion::ros_side {
namespace {

/// The name of a topic as in the bag; throws where it is missing or has another type.
std::string topicOf(const BagReader& bag, const std::string& file, const std::string& wanted, const std::string& type,
                    const std::string& use) {
  for (const auto& connection : bag.connections()) {
    if (bareTopic(connection.topic) != bareTopic(wanted)) continue;
    if (connection.type == type) return connection.topic;
    throw std::runtime_error(
        fmt::format("{}: topic {} is of type {} but {} is needed", file, wanted, connection.type, type));
  }
  throw std::runtime_error(fmt::format(
      "{}: no topic {} ({}), {}; name another under topics: in the configuration, 'rosbag info' lists what there is",
      file, wanted, type, use));
}

/// Reads transforms and surveyed transponders, which hold for the whole bag.
void readFixed(const std::string& file, const UsblSettings& settings, tf2::BufferCore& transforms, UsblIngest& ingest) {
  BagReader bag(file);
  tf2_msgs::TFMessage tf;
  sensor_msgs::NavSatFix transponder;
  while (const BagMessage* m = bag.next()) {
    const std::string topic = bareTopic(m->connection->topic);
    if (m->connection->type == "tf2_msgs/TFMessage" && bag.get(*m, tf)) {
      for (const auto& T : tf.transforms) transforms.setTransform(T, "bag", topic == "tf_static");
    } else if (topic == bareTopic(settings.transponder_topic) && bag.get(*m, transponder)) {
      ingest.takeTransponder(transponder);
    }
  }
}

/// Takes truth and labels of a simulated bag.
void takeTruth(const BagReader& bag, const BagMessage& m, const std::string& topic, UsblRecording& recording) {
  geometry_msgs::TransformStamped mounting;
  sas_motion::MeasurementLabel label;
  if (topic == "truth/usbl_mounting" && bag.get(m, mounting))
    recording.truth = mountingOf(transformOf(mounting.transform));
  if (topic == "truth/label" && bag.get(m, label) && label.sensor == "usbl" && label.outlier.size() == usbl::kChannels)
    recording.outlier[stampOf(label.header.stamp)] = {label.outlier[0] != 0, label.outlier[2] != 0,
                                                      label.outlier[1] != 0};
}

void count(std::map<std::string, std::uint64_t>& counts, const std::string& reason, std::uint64_t number) {
  if (number > 0) counts[reason] = number;
}

/// The reason for a bag without a ping, with advice.
std::string whyNoPing(const std::string& file, const UsblSettings& settings, const UsblRecording& recording,
                      const UsblIngest& ingest) {
  if (recording.readings == 0 && !settings.array_frame.empty())
    return fmt::format("{}: no measurement of the array {}; check frames.array", file, settings.array_frame);
  if (recording.readings == 0)
    return fmt::format("{}: topic {} holds no measurement", file, settings.measurement_topic);
  if (ingest.builder().transponders().empty())
    return fmt::format(
        "{}: topic {} holds no transponder whose frame_id is a number, its id; without its surveyed position nothing "
        "can be calibrated",
        file, settings.transponder_topic);
  std::vector<std::string> reasons;
  for (const auto* counts : {&recording.left_out, &recording.refused})
    for (const auto& [reason, number] : *counts) reasons.push_back(fmt::format("{} {}", number, reason));
  std::string hint;
  if (ingest.builder().omitted(usbl::Omission::NoChannel) == recording.readings)
    hint =
        "; where the driver states no variance, set readings.range_sigma and readings.direction_sigma_deg in the "
        "configuration";
  return fmt::format("{}: none of {} measurements on {} is usable: {}{}", file, recording.readings,
                     settings.measurement_topic, fmt::join(reasons, ", "), hint);
}

}  // namespace

void UsblRecording::takeSummary(const UsblIngest& ingest) {
  nominal = ingest.builder().nominal();
  has_nominal = ingest.hasNominal();
  array_frame = ingest.arrayFrame();
  readings = ingest.builder().readings();
  const auto& transponders = ingest.builder().transponders();
  if (!transponders.empty()) transponder = transponders.begin()->second;
  for (int i = 0; i < usbl::kOmissions; ++i) {
    const auto omission = static_cast<usbl::Omission>(i);
    count(left_out, usbl::omissionText(omission), ingest.builder().omitted(omission));
  }
  const auto& counts = ingest.counts();
  count(refused, "GNSS messages without a fix", counts.no_fix);
  count(refused, "attitude messages without an orientation", counts.no_attitude);
  count(refused,
        fmt::format("messages of frames without a transform to the base frame ({})", fmt::join(counts.frames, ", ")),
        counts.unknown_frame);
  count(refused, "measurements of another array", counts.other_array);
  count(refused, "transponders whose frame_id is no number", counts.no_id);
}

UsblRecording UsblRecording::read(const std::string& file, const UsblSettings& settings,
                                  const std::function<void(double)>& progress) {
  BagReader bag(file);
  const std::string measurements =
      topicOf(bag, file, settings.measurement_topic, "sas_motion/UsblMeasurement", "the USBL's ranges and directions");
  const std::string fixes = topicOf(bag, file, settings.fix_topic, "sensor_msgs/NavSatFix", "the vessel's positions");
  const std::string attitudes = topicOf(bag, file, settings.imu_topic, "sensor_msgs/Imu", "the vessel's attitudes");
  topicOf(bag, file, settings.transponder_topic, "sensor_msgs/NavSatFix", "the transponder's surveyed position");

  tf2::BufferCore transforms;
  UsblIngest ingest(settings, transforms);
  readFixed(file, settings, transforms, ingest);
  UsblRecording recording;
  const auto add = [&](const std::vector<usbl::Ping>& pings) {
    recording.pings.insert(recording.pings.end(), pings.begin(), pings.end());
  };
  sensor_msgs::NavSatFix fix;
  sensor_msgs::Imu imu;
  sas_motion::UsblMeasurement measurement;
  double done = 0;
  while (const BagMessage* m = bag.next()) {
    const std::string& topic = m->connection->topic;
    if (topic == measurements && bag.get(*m, measurement)) {
      ingest.take(measurement);
      add(ingest.builder().take());
      progress((m->time - bag.begin()).toSec() - done);
      done = (m->time - bag.begin()).toSec();
    } else if (topic == fixes && bag.get(*m, fix)) {
      ingest.takeFix(fix);
    } else if (topic == attitudes && bag.get(*m, imu)) {
      ingest.take(imu);
    } else {
      takeTruth(bag, *m, bareTopic(topic), recording);
    }
  }
  add(ingest.builder().finish());
  recording.takeSummary(ingest);
  if (recording.pings.empty()) throw std::runtime_error(whyNoPing(file, settings, recording, ingest));
  return recording;
}

}  // namespace sas_motion::ros_side

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sas_motion/FilterUpdate.h>
#include <sensor_msgs/Imu.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "bag/bag_reader.hpp"

namespace sas_motion::ros_side {

/// A file of a test, removed after it.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / fmt::format("{}.{}", ::getpid(), name)) {}
  ~TemporaryFile() { std::filesystem::remove(path_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  std::string path() const { return path_; }

  std::string read() const {
    std::ifstream stream(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  void write(const std::string& bytes) const { std::ofstream(path_, std::ios::binary) << bytes; }

 private:
  std::filesystem::path path_;
};

struct BagSpec {
  rosbag::CompressionType compression = rosbag::compression::Uncompressed;
  int messages = 2000;
  int connections = 6;         ///< on half as many topics
  double longest_delay = 0.5;  ///< by which a message may be older than those before it [s]
  unsigned seed = 1;
};

/// A bag of rosbag's own writer in small chunks: stamps are multiples of 10 ms, so that many are equal.
inline void writeBag(const std::string& path, const BagSpec& spec) {
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  bag.setCompression(spec.compression);
  bag.setChunkThreshold(8192);
  std::mt19937 random(spec.seed);
  for (int i = 0; i < spec.messages; ++i) {
    const int connection = static_cast<int>(random() % static_cast<unsigned>(spec.connections));
    const double delay = spec.longest_delay * static_cast<double>(random() % 1000) / 1000;
    const ros::Time time(100 + std::round(100 * (0.01 * i - delay)) / 100);
    const auto header = boost::make_shared<ros::M_string>();
    (*header)["callerid"] = fmt::format("/node_{}", connection);
    (*header)["topic"] = fmt::format("/topic_{}", connection / 2);
    if (connection % 2 == 0) {
      sensor_msgs::Imu imu;
      imu.header.seq = static_cast<std::uint32_t>(i);
      imu.header.frame_id = "imu_link";
      (*header)["type"] = ros::message_traits::datatype(imu);
      (*header)["md5sum"] = ros::message_traits::md5sum(imu);
      (*header)["message_definition"] = ros::message_traits::definition(imu);
      bag.write((*header)["topic"], time, imu, header);
    } else {
      sas_motion::FilterUpdate update;
      update.header.seq = static_cast<std::uint32_t>(i);
      update.weights.assign(random() % 20, 0.5);
      (*header)["type"] = ros::message_traits::datatype(update);
      (*header)["md5sum"] = ros::message_traits::md5sum(update);
      (*header)["message_definition"] = ros::message_traits::definition(update);
      bag.write((*header)["topic"], time, update, header);
    }
  }
}

/// All that a reader says of one message.
struct Seen {
  std::string topic, caller, type;
  ros::Time time;
  std::string bytes;
  bool operator==(const Seen& o) const {
    return topic == o.topic && caller == o.caller && type == o.type && time == o.time && bytes == o.bytes;
  }
};

inline std::vector<Seen> seenByView(const std::string& path) {
  const rosbag::Bag bag(path);
  rosbag::View view(bag);
  std::vector<Seen> seen;
  for (const rosbag::MessageInstance& m : view) {
    std::string bytes(m.size(), '\0');
    ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()), m.size());
    m.write(stream);
    seen.push_back({m.getTopic(), m.getCallerId(), m.getDataType(), m.getTime(), bytes});
  }
  return seen;
}

inline std::vector<Seen> seenByReader(const std::string& path) {
  BagReader reader(path);
  std::vector<Seen> seen;
  while (const BagMessage* m = reader.next()) {
    const auto& c = *m->connection;
    seen.push_back({c.topic, c.header.count("callerid") ? c.header.at("callerid") : "", c.type, m->time,
                    std::string(m->bytes.text())});
  }
  return seen;
}

}  // namespace sas_motion::ros_side

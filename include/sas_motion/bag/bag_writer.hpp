// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/time.h>
#include <rosbag/message_instance.h>

#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

namespace sas_motion::ros_side {

/// Writes a rosbag, format 2.0, from front to back, without compression. rosbag::Bag seeks the end of the file for every message, which is
/// most of its time; this one only appends chunks. The bytes depend on what is written alone.
class BagWriter {
 public:
  /// All functions throw std::runtime_error where the file cannot be written.
  explicit BagWriter(const std::string& path);
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  template <class Message>
  void write(const std::string& topic, ros::Time time, const Message& message, bool latched = false) {
    const auto found = by_topic_.find(topic);
    const std::uint32_t connection = found != by_topic_.end() ? found->second : connect<Message>(topic, latched);
    const std::uint32_t size = ros::serialization::serializationLength(message);
    ros::serialization::OStream stream(beginMessage(connection, time, size), size);
    ros::serialization::serialize(stream, message);
    endMessage();
  }
  /// A message of another bag, as it is there.
  void copy(const rosbag::MessageInstance& message);
  /// Writes the index; nothing may be written after it.
  void close();

 private:
  using Fields = std::map<std::string, std::string>;
  struct IndexEntry {
    ros::Time time;
    std::uint32_t offset;
  };
  struct Connection {
    std::string topic;
    Fields header;
    std::vector<IndexEntry> in_chunk;
  };
  struct ChunkInfo {
    std::uint64_t position;
    ros::Time begin, end;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> counts;  // connection, messages
  };

  template <class Message>
  std::uint32_t connect(const std::string& topic, bool latched) {
    Fields header{{"topic", topic},
                  {"type", ros::message_traits::datatype<Message>()},
                  {"md5sum", ros::message_traits::md5sum<Message>()},
                  {"message_definition", ros::message_traits::definition<Message>()}};
    if (latched) header["latching"] = "1";
    return by_topic_[topic] = addConnection(topic, header);
  }
  std::uint32_t addConnection(const std::string& topic, const Fields& header);
  /// Where to put the message's bytes.
  std::uint8_t* beginMessage(std::uint32_t connection, ros::Time time, std::uint32_t size);
  void endMessage();
  void flushChunk();
  void put(const std::string& bytes);
  std::string connectionRecord(std::uint32_t id) const;
  std::string fileHeader(std::uint64_t index_position) const;

  std::FILE* file_;
  std::uint64_t position_ = 0;
  std::vector<std::uint8_t> chunk_;
  std::size_t chunk_size_ = 0;
  ros::Time chunk_begin_, chunk_end_;
  std::vector<Connection> connections_;
  std::unordered_map<std::string, std::uint32_t> by_topic_, by_source_;
  std::vector<ChunkInfo> chunks_;
};

}  // namespace sas_motion::ros_side

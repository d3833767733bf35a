// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "bag/chunk_file.hpp"
#include "sas_motion/io/background_file.hpp"

namespace sas_motion::ros_side {

/// Writes a rosbag, format 2.0, from front to back, without compression. rosbag::Bag seeks the end of the file for
/// every message, which is most of its time; this one only appends chunks. The bytes depend on what is written alone.
class BagWriter {
 public:
  /// All functions throw std::runtime_error where the file cannot be written.
  explicit BagWriter(const std::string& path);

  template <class Message>
  void write(const std::string& topic, ros::Time time, const Message& message, bool latched = false) {
    const auto found = by_topic_.find(topic);
    const std::uint32_t connection = found != by_topic_.end() ? found->second : connect<Message>(topic, latched);
    const std::uint32_t size = ros::serialization::serializationLength(message);
    ros::serialization::OStream stream(beginMessage(connection, time, size), size);
    ros::serialization::serialize(stream, message);
    endMessage();
  }
  /// The connection here of one in another bag: the same for all of its topic and publisher.
  std::uint32_t connect(const BagConnection& source);
  /// A message as it is, of a connection that connect() gave.
  void write(std::uint32_t connection, ros::Time time, bag_format::Bytes message);
  /// Writes the index; nothing may be written after it.
  void close();

 private:
  using Fields = std::map<std::string, std::string>;
  struct IndexEntry {  // as in the file
    ros::Time time;
    std::uint32_t offset;
  };
  struct Connection {
    std::string record;        // its record in the bag
    std::string message_head;  // of each of its messages; its time and size are filled in
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
  void beginChunk();
  std::size_t chunkSize() const { return block_.size - chunk_data_; }
  void flushChunk();
  void flushBlock();
  std::string fileHeader(std::uint64_t index_position) const;

  BackgroundFile file_;
  std::uint64_t position_ = 0;                       // in the file, of the block
  Block block_;                                      // what is not yet handed to the file
  std::size_t chunk_position_ = 0, chunk_data_ = 0;  // in the block
  ros::Time chunk_begin_, chunk_end_;
  std::vector<Connection> connections_;
  std::unordered_map<std::string, std::uint32_t> by_topic_, by_source_;
  std::vector<ChunkInfo> chunks_;
};

}  // namespace sas_motion::ros_side

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <map>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "bag/chunk_file.hpp"

namespace sas_motion::ros_side {

/// One message, where it lies in its chunk: valid until the next call of BagReader::next().
struct BagMessage {
  const BagConnection* connection = nullptr;
  ros::Time time;  ///< of its recording
  bag_format::Bytes bytes{nullptr, 0};
};

/// Reads a bag's messages in order of time, chunk by chunk. rosbag::Bag keeps an index of every message in memory; this
/// one holds the chunks that reach over the present moment, and 40 bytes for each chunk of the file.
///
/// Among messages of equal time the order is rosbag::View's with up to 16 connections: first the connection whose last
/// message was read last, then the highest id. (With more, View's order among them is that of an unstable sort.)
///
/// All functions throw std::runtime_error: one sentence that names the file and what to do.
class BagReader {
 public:
  explicit BagReader(const std::string& path);

  /// Those with messages, by id; their `index` is their place here.
  const std::vector<BagConnection>& connections() const { return connections_; }
  /// Of the first and of the last message; zero in an empty bag.
  ros::Time begin() const { return begin_; }
  ros::Time end() const { return end_; }

  /// The next message, or null at the end.
  const BagMessage* next();

  /// Deserialises a message of this reader; false where it is of another type.
  template <class Message>
  bool get(const BagMessage& message, Message& into) const {
    if (message.connection->md5sum != ros::message_traits::MD5Sum<Message>::value()) return false;
    read(message, [&](ros::serialization::IStream& stream) { ros::serialization::deserialize(stream, into); });
    return true;
  }
  /// Hands a message's bytes to `use(stream)`, which deserialises them.
  template <class Use>
  void read(const BagMessage& message, const Use& use) const {
    guarded([&] {
      ros::serialization::IStream stream(const_cast<std::uint8_t*>(message.bytes.data()),
                                         static_cast<std::uint32_t>(message.bytes.size()));
      use(stream);
    });
  }

  /// Memory taken for chunks and their messages now [byte].
  std::size_t bytesHeld() const;

 private:
  struct Chunk {
    std::vector<std::uint8_t> bytes;
    std::size_t unread = 0;  // messages
  };
  struct Entry {
    ros::Time time;
    std::uint32_t chunk_order;
    bag_format::Bytes bytes;
    Chunk* chunk;
  };
  /// What is loaded of one connection, in order from `next` on.
  struct Queue {
    std::vector<Entry> entries;
    std::size_t next = 0;
    std::uint64_t taken = 0;  // when its last message was, counted in messages of the bag
    bool empty() const { return next == entries.size(); }
    const Entry& front() const { return entries[next]; }
  };

  /// Runs an action; what it finds wrong in the bag becomes a sentence.
  template <class Action>
  void guarded(const Action& action) const {
    try {
      action();
    } catch (const bag_format::Error& error) {
      damaged(error.what());
    } catch (const ros::Exception& error) {
      damaged(error.what());
    } catch (const std::bad_alloc&) {
      damaged("a length that no memory has room for");
    } catch (const std::length_error&) {
      damaged("a length that no memory has room for");
    }
  }
  [[noreturn]] void damaged(const char* why) const;
  void load(const ChunkInfo& info);
  void addMessages(const ChunkInfo& info, Chunk& chunk);
  void release();
  /// Whether the front of one queue comes after that of another.
  bool isAfter(std::uint32_t a, std::uint32_t b) const;

  std::string path_;
  ChunkFile file_;
  std::vector<BagConnection> connections_;
  std::map<std::uint32_t, std::uint32_t> index_by_id_;
  ros::Time begin_, end_;
  std::vector<ChunkInfo> chunks_;  // by begin
  std::size_t next_chunk_ = 0;
  std::vector<std::unique_ptr<Chunk>> loaded_;
  std::unique_ptr<Chunk> idle_;
  std::vector<Queue> queues_;         // by index of connection
  std::vector<std::uint32_t> heads_;  // a heap of the queues that are not empty
  std::uint64_t count_ = 0;
  BagMessage message_;
  Chunk* chunk_of_message_ = nullptr;
};

}  // namespace sas_motion::ros_side

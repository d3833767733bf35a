// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "bag/bag_format.hpp"

namespace sas_motion::ros_side {

/// A topic of a bag, as one publisher wrote it.
struct BagConnection {
  std::uint32_t id = 0;
  std::uint32_t index = 0;  ///< its place among the connections of its reader
  std::string topic, type, md5sum;
  std::map<std::string, std::string> header;  ///< also message_definition, callerid and latching, where there
};

/// The entry of a chunk in a bag's index.
struct ChunkInfo {
  std::uint64_t position = 0;  ///< in the file [byte]
  ros::Time begin, end;        ///< of its first and last message
  std::uint32_t messages = 0;
  std::uint32_t order = 0;  ///< its place in the index
};

/// The file of a bag, as a list of chunks. Every length in it is checked against the file's before memory is taken for
/// it.
///
/// The constructor throws std::runtime_error, one sentence that names the file, where it cannot be read at all; all
/// functions throw bag_format::Error where its content does not follow the format.
class ChunkFile {
 public:
  explicit ChunkFile(const std::string& path);
  ~ChunkFile();
  ChunkFile(const ChunkFile&) = delete;
  ChunkFile& operator=(const ChunkFile&) = delete;

  /// Reads the index: connections with messages, by id, and chunks with messages, in order of the index.
  void readIndex(std::vector<BagConnection>& connections, std::vector<ChunkInfo>& chunks);
  /// The records of a chunk, unpacked. The buffer's memory is used again.
  void read(const ChunkInfo& chunk, std::vector<std::uint8_t>& records);

 private:
  using Buffer = std::vector<std::uint8_t>;
  /// Reads what is `size` long at position_, and moves on.
  void take(std::uint64_t size, Buffer& into);
  bag_format::Bytes takeBlock(Buffer& into);
  std::uint32_t takeLength();
  std::uint64_t readFileHeader();

  std::string path_;
  int descriptor_;
  std::uint64_t size_ = 0, position_ = 0;
  std::uint32_t connection_count_ = 0, chunk_count_ = 0;
  Buffer header_, data_;
};

}  // namespace sas_motion::ros_side

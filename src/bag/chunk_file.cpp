// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bag/chunk_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "bag/decompress.hpp"

namespace sas_motion::ros_side {

using namespace bag_format;

namespace {

void requireOp(Bytes header, Op op) {
  if (requiredNumber<std::uint8_t>(header, "op") != op) throw Error("a record of another kind than its place has");
}

BagConnection connectionFrom(Bytes header, Bytes data) {
  requireOp(header, kConnection);
  BagConnection connection;
  connection.id = requiredNumber<std::uint32_t>(header, "conn");
  connection.topic = required(header, "topic").text();
  connection.type = required(data, "type").text();
  connection.md5sum = required(data, "md5sum").text();
  forEachField(data, [&](std::string_view name, Bytes value) { connection.header.emplace(name, value.text()); });
  return connection;
}

/// Adds the chunk's messages to those of each connection.
ChunkInfo chunkInfoFrom(Bytes header, Bytes data, std::map<std::uint32_t, std::uint64_t>& messages) {
  requireOp(header, kChunkInfo);
  if (requiredNumber<std::uint32_t>(header, "ver") != 1) throw Error("an index of an unknown version");
  ChunkInfo info;
  info.position = requiredNumber<std::uint64_t>(header, "chunk_pos");
  info.begin = timeFrom(required(header, "start_time"));
  info.end = timeFrom(required(header, "end_time"));
  for (auto left = requiredNumber<std::uint32_t>(header, "count"); left > 0; --left) {
    const auto id = data.number<std::uint32_t>();
    const auto count = data.number<std::uint32_t>();
    messages[id] += count;
    info.messages += count;
  }
  return info;
}

}  // namespace

ChunkFile::ChunkFile(const std::string& path) : path_(path), descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
  if (descriptor_ < 0 && errno == ENOENT)
    throw std::runtime_error(fmt::format("{}: no such file; check the path", path));
  struct stat status {};
  if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0)
    throw std::runtime_error(fmt::format("{}: cannot be read as a rosbag: {}", path, std::strerror(errno)));
  if (S_ISREG(status.st_mode)) size_ = static_cast<std::uint64_t>(status.st_size);
}

ChunkFile::~ChunkFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void ChunkFile::take(std::uint64_t size, Buffer& into) {
  if (position_ > size_ || size > size_ - position_) throw Error("a length reaches beyond the end of the file");
  into.resize(size);
  for (std::uint64_t done = 0; done < size;) {
    const ssize_t got = ::pread(descriptor_, into.data() + done, size - done, static_cast<off_t>(position_ + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) throw Error(got < 0 ? std::strerror(errno) : "the file ends early");
    done += static_cast<std::uint64_t>(got);
  }
  position_ += size;
}

std::uint32_t ChunkFile::takeLength() {
  take(sizeof(std::uint32_t), data_);
  return Bytes(data_.data(), data_.size()).number<std::uint32_t>();
}

Bytes ChunkFile::takeBlock(Buffer& into) {
  take(takeLength(), into);
  return {into.data(), into.size()};
}

/// Returns where the index begins.
std::uint64_t ChunkFile::readFileHeader() {
  position_ = 0;
  take(kMagic.size(), data_);
  const std::string first(data_.begin(), data_.end());
  if (first.compare(0, 9, "#ROSBAG V") != 0 && first.compare(0, 8, "#ROSLOG ") != 0)
    throw Error("it does not begin as one");
  if (first != kMagic)
    throw std::runtime_error(
        fmt::format("{}: is a rosbag of an older format than 2.0; run 'rosbag fix' on it first", path_));
  const Bytes header = takeBlock(header_);
  requireOp(header, kFileHeader);
  if (const auto encryptor = find(header, "encryptor");
      encryptor && !encryptor->empty() && encryptor->text() != "rosbag/NoEncryptor")
    throw std::runtime_error(fmt::format("{}: is encrypted; run 'rosbag decrypt' on it first", path_));
  const auto index_position = requiredNumber<std::uint64_t>(header, "index_pos");
  if (index_position == 0)
    throw std::runtime_error(
        fmt::format("{}: has no index, as after a crash of the recorder; run 'rosbag reindex {}' first", path_, path_));
  connection_count_ = requiredNumber<std::uint32_t>(header, "conn_count");
  chunk_count_ = requiredNumber<std::uint32_t>(header, "chunk_count");
  return index_position;
}

void ChunkFile::readIndex(std::vector<BagConnection>& connections, std::vector<ChunkInfo>& chunks) {
  position_ = readFileHeader();
  std::map<std::uint32_t, BagConnection> by_id;
  for (std::uint32_t i = 0; i < connection_count_; ++i) {
    const Bytes header = takeBlock(header_);
    auto connection = connectionFrom(header, takeBlock(data_));
    by_id.emplace(connection.id, std::move(connection));
  }
  std::map<std::uint32_t, std::uint64_t> messages;
  for (std::uint32_t i = 0; i < chunk_count_; ++i) {
    const Bytes header = takeBlock(header_);
    auto info = chunkInfoFrom(header, takeBlock(data_), messages);
    info.order = i;
    if (info.messages > 0) chunks.push_back(info);
  }
  for (auto& [id, connection] : by_id) {
    if (messages[id] == 0) continue;
    connection.index = static_cast<std::uint32_t>(connections.size());
    connections.push_back(std::move(connection));
  }
}

void ChunkFile::read(const ChunkInfo& chunk, Buffer& records) {
  position_ = chunk.position;
  const Bytes header = takeBlock(header_);
  requireOp(header, kChunk);
  const std::string_view compression = required(header, "compression").text();
  const auto size = requiredNumber<std::uint32_t>(header, "size");
  const std::uint32_t packed_size = takeLength();
  if (compression == "none") {
    take(packed_size, records);
    if (packed_size != size) throw Error("a chunk of two sizes");
  } else {
    take(packed_size, data_);
    decompress(compression, Bytes(data_.data(), data_.size()), size, records);
  }
}

}  // namespace sas_motion::ros_side

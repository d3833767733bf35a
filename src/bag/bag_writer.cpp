// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Record layout: wiki.ros.org/Bags/Format/2.0.
#include "sas_motion/bag/bag_writer.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace sas_motion::ros_side {
namespace {

constexpr std::size_t kChunkSize = 768 * 1024;
constexpr std::size_t kFileHeaderSize = 4096;
enum Op : char { kMessage = 2, kFileHeader = 3, kIndex = 4, kChunk = 5, kChunkInfo = 6, kConnection = 7 };

template <class Number>
std::string bytes(Number value) {
  std::string text(sizeof value, '\0');
  std::memcpy(text.data(), &value, sizeof value);
  return text;
}

std::string bytes(ros::Time time) { return bytes(time.sec) + bytes(time.nsec); }

std::string field(const std::string& name, const std::string& value) {
  return bytes(static_cast<std::uint32_t>(name.size() + 1 + value.size())) + name + "=" + value;
}

std::string op(Op code) { return field("op", std::string(1, code)); }

/// The header's length and the header; the data's length and the data follow it.
std::string withLength(const std::string& text) { return bytes(static_cast<std::uint32_t>(text.size())) + text; }

}  // namespace

BagWriter::BagWriter(const std::string& path) : file_(std::fopen(path.c_str(), "wb")) {
  if (!file_) throw std::runtime_error(std::strerror(errno));
  chunk_.resize(2 * kChunkSize);
  put("#ROSBAG V2.0\n" + fileHeader(0));
}

BagWriter::~BagWriter() {
  if (file_) std::fclose(file_);
}

std::string BagWriter::fileHeader(std::uint64_t index_position) const {
  const std::string header = op(kFileHeader) + field("index_pos", bytes(index_position)) +
                             field("conn_count", bytes(static_cast<std::uint32_t>(connections_.size()))) +
                             field("chunk_count", bytes(static_cast<std::uint32_t>(chunks_.size())));
  return withLength(header) + withLength(std::string(kFileHeaderSize - header.size() - 8, ' '));
}

void BagWriter::put(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) throw std::runtime_error(std::strerror(errno));
  position_ += text.size();
}

std::uint32_t BagWriter::addConnection(const std::string& topic, const Fields& header) {
  const auto id = static_cast<std::uint32_t>(connections_.size());
  connections_.push_back({topic, header, {}});
  return id;
}

std::string BagWriter::connectionRecord(std::uint32_t id) const {
  std::string data;
  for (const auto& [name, value] : connections_[id].header) data += field(name, value);
  return withLength(op(kConnection) + field("conn", bytes(id)) + field("topic", connections_[id].topic)) + withLength(data);
}

std::uint8_t* BagWriter::beginMessage(std::uint32_t connection, ros::Time time, std::uint32_t size) {
  if (chunk_size_ > 0 && chunk_size_ + size > kChunkSize) flushChunk();
  Connection& c = connections_[connection];
  std::string head;
  if (c.in_chunk.empty()) head = connectionRecord(connection);  // once a chunk, so that a damaged bag can be indexed anew
  const std::size_t offset = chunk_size_ + head.size();
  head += withLength(op(kMessage) + field("conn", bytes(connection)) + field("time", bytes(time))) + bytes(size);
  chunk_.resize(std::max(chunk_.size(), chunk_size_ + head.size() + size));
  std::memcpy(chunk_.data() + chunk_size_, head.data(), head.size());
  if (chunk_size_ == 0 || time < chunk_begin_) chunk_begin_ = time;
  if (chunk_size_ == 0 || time > chunk_end_) chunk_end_ = time;
  c.in_chunk.push_back({time, static_cast<std::uint32_t>(offset)});
  std::uint8_t* place = chunk_.data() + chunk_size_ + head.size();
  chunk_size_ += head.size() + size;
  return place;
}

void BagWriter::endMessage() {
  if (chunk_size_ >= kChunkSize) flushChunk();
}

void BagWriter::copy(const rosbag::MessageInstance& message) {
  const auto& header = *message.getConnectionHeader();
  const auto caller = header.find("callerid");
  const std::string key = message.getTopic() + "\n" + (caller == header.end() ? "" : caller->second);
  auto found = by_source_.find(key);
  if (found == by_source_.end()) {
    Fields fields(header.begin(), header.end());
    fields["topic"] = message.getTopic();
    found = by_source_.emplace(key, addConnection(message.getTopic(), fields)).first;
  }
  const std::uint32_t size = message.size();
  ros::serialization::OStream stream(beginMessage(found->second, message.getTime(), size), size);
  message.write(stream);
  endMessage();
}

void BagWriter::flushChunk() {
  if (chunk_size_ == 0) return;
  ChunkInfo info{position_, chunk_begin_, chunk_end_, {}};
  const auto size = static_cast<std::uint32_t>(chunk_size_);
  put(withLength(op(kChunk) + field("compression", "none") + field("size", bytes(size))) + bytes(size));
  if (std::fwrite(chunk_.data(), 1, chunk_size_, file_) != chunk_size_) throw std::runtime_error(std::strerror(errno));
  position_ += chunk_size_;
  for (std::uint32_t id = 0; id < connections_.size(); ++id) {
    auto& entries = connections_[id].in_chunk;
    if (entries.empty()) continue;
    std::stable_sort(entries.begin(), entries.end(), [](const IndexEntry& a, const IndexEntry& b) { return a.time < b.time; });
    const auto count = static_cast<std::uint32_t>(entries.size());
    std::string data;
    for (const auto& entry : entries) data += bytes(entry.time) + bytes(entry.offset);
    put(withLength(op(kIndex) + field("ver", bytes(std::uint32_t{1})) + field("conn", bytes(id)) + field("count", bytes(count))) + withLength(data));
    info.counts.emplace_back(id, count);
    entries.clear();
  }
  chunks_.push_back(std::move(info));
  chunk_size_ = 0;
}

void BagWriter::close() {
  flushChunk();
  const std::uint64_t index_position = position_;
  for (std::uint32_t id = 0; id < connections_.size(); ++id) put(connectionRecord(id));
  for (const auto& chunk : chunks_) {
    std::string data;
    for (const auto& [id, count] : chunk.counts) data += bytes(id) + bytes(count);
    put(withLength(op(kChunkInfo) + field("ver", bytes(std::uint32_t{1})) + field("chunk_pos", bytes(chunk.position)) +
                   field("start_time", bytes(chunk.begin)) + field("end_time", bytes(chunk.end)) +
                   field("count", bytes(static_cast<std::uint32_t>(chunk.counts.size())))) +
        withLength(data));
  }
  const bool positioned = std::fseek(file_, std::strlen("#ROSBAG V2.0\n"), SEEK_SET) == 0;
  if (!positioned) throw std::runtime_error(std::strerror(errno));
  put(fileHeader(index_position));
  const int status = std::fclose(file_);
  file_ = nullptr;
  if (status != 0) throw std::runtime_error(std::strerror(errno));
}

}  // namespace sas_motion::ros_side

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bag/bag_writer.hpp"

#include <algorithm>
#include <cstring>

namespace sas_motion::ros_side {

using namespace bag_format;

namespace {

constexpr std::size_t kChunkSize = 786'432;

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

std::string op(Op code) { return field("op", std::string(1, static_cast<char>(code))); }

/// The header's length and the header; the data's length and the data follow it.
std::string withLength(const std::string& text) { return bytes(static_cast<std::uint32_t>(text.size())) + text; }

/// The chunk's size is a part of its head, and its data's length.
std::string chunkHead(std::uint32_t size) {
  return withLength(op(kChunk) + field("compression", "none") + field("size", bytes(size))) + bytes(size);
}

}  // namespace

BagWriter::BagWriter(const std::string& path) : file_(path) {
  block_.append(kMagic);
  block_.append(fileHeader(0));
  beginChunk();
}

std::string BagWriter::fileHeader(std::uint64_t index_position) const {
  const std::string header = op(kFileHeader) + field("index_pos", bytes(index_position)) +
                             field("conn_count", bytes(static_cast<std::uint32_t>(connections_.size()))) +
                             field("chunk_count", bytes(static_cast<std::uint32_t>(chunks_.size())));
  return withLength(header) + withLength(std::string(kFileHeaderSize - header.size() - 8, ' '));
}

std::uint32_t BagWriter::addConnection(const std::string& topic, const Fields& header) {
  const auto id = static_cast<std::uint32_t>(connections_.size());
  std::string data;
  for (const auto& [name, value] : header) data += field(name, value);
  connections_.push_back(
      {withLength(op(kConnection) + field("conn", bytes(id)) + field("topic", topic)) + withLength(data),
       withLength(op(kMessage) + field("conn", bytes(id)) + field("time", bytes(ros::Time()))) +
           bytes(std::uint32_t{0}),
       {}});
  return id;
}

std::uint32_t BagWriter::connect(const BagConnection& source) {
  const auto caller = source.header.find("callerid");
  const std::string publisher = source.topic + "\n" + (caller == source.header.end() ? "" : caller->second);
  const auto found = by_source_.find(publisher);
  if (found != by_source_.end()) return found->second;
  Fields fields = source.header;
  fields["topic"] = source.topic;
  return by_source_[publisher] = addConnection(source.topic, fields);
}

void BagWriter::write(std::uint32_t connection, ros::Time time, Bytes message) {
  std::memcpy(beginMessage(connection, time, static_cast<std::uint32_t>(message.size())), message.data(),
              message.size());
  endMessage();
}

std::uint8_t* BagWriter::beginMessage(std::uint32_t connection, ros::Time time, std::uint32_t size) {
  if (chunkSize() > 0 && chunkSize() + size > kChunkSize) flushChunk();
  Connection& c = connections_[connection];
  const bool first = chunkSize() == 0;
  if (first || key(time) < key(chunk_begin_)) chunk_begin_ = time;
  if (first || key(time) > key(chunk_end_)) chunk_end_ = time;
  if (c.in_chunk.empty()) block_.append(c.record);  // once a chunk, so that a damaged bag can be indexed anew
  c.in_chunk.push_back({time, static_cast<std::uint32_t>(chunkSize())});
  const std::size_t head_size = c.message_head.size();
  std::uint8_t* head = block_.extend(head_size + size);
  std::copy(c.message_head.begin(), c.message_head.end(), head);
  std::memcpy(head + head_size - 12, &time.sec, 4);  // the head ends with time and size
  std::memcpy(head + head_size - 8, &time.nsec, 4);
  std::memcpy(head + head_size - 4, &size, 4);
  return head + head_size;
}

void BagWriter::endMessage() {
  if (chunkSize() >= kChunkSize) flushChunk();
}

void BagWriter::beginChunk() {
  chunk_position_ = block_.size;
  block_.append(chunkHead(0));
  chunk_data_ = block_.size;
}

void BagWriter::flushChunk() {
  ChunkInfo info{position_ + chunk_position_, chunk_begin_, chunk_end_, {}};
  const std::string head = chunkHead(static_cast<std::uint32_t>(chunkSize()));
  std::copy(head.begin(), head.end(), block_.bytes.begin() + static_cast<std::ptrdiff_t>(chunk_position_));
  for (std::uint32_t id = 0; id < connections_.size(); ++id) {
    auto& entries = connections_[id].in_chunk;
    if (entries.empty()) continue;
    const auto earlier = [](const IndexEntry& a, const IndexEntry& b) { return key(a.time) < key(b.time); };
    if (!std::is_sorted(entries.begin(), entries.end(), earlier))
      std::stable_sort(entries.begin(), entries.end(), earlier);
    const auto count = static_cast<std::uint32_t>(entries.size());
    block_.append(withLength(op(kIndex) + field("ver", bytes(std::uint32_t{1})) + field("conn", bytes(id)) +
                             field("count", bytes(count))));
    const auto size = static_cast<std::uint32_t>(entries.size() * sizeof(IndexEntry));
    block_.append(bytes(size));
    std::memcpy(block_.extend(size), entries.data(), size);
    info.counts.emplace_back(id, count);
    entries.clear();
  }
  chunks_.push_back(std::move(info));
  flushBlock();
  beginChunk();
}

void BagWriter::flushBlock() {
  position_ += block_.size;
  file_.write(block_);
}

void BagWriter::close() {
  if (chunkSize() > 0) flushChunk();
  block_.size = chunk_position_;  // no empty chunk
  const std::uint64_t index_position = position_ + block_.size;
  for (const auto& connection : connections_) block_.append(connection.record);
  for (const auto& chunk : chunks_) {
    std::string data;
    for (const auto& [id, count] : chunk.counts) data += bytes(id) + bytes(count);
    block_.append(withLength(op(kChunkInfo) + field("ver", bytes(std::uint32_t{1})) +
                             field("chunk_pos", bytes(chunk.position)) + field("start_time", bytes(chunk.begin)) +
                             field("end_time", bytes(chunk.end)) +
                             field("count", bytes(static_cast<std::uint32_t>(chunk.counts.size())))) +
                  withLength(data));
  }
  flushBlock();
  file_.close(kMagic.size(), fileHeader(index_position));
}

}  // namespace sas_motion::ros_side

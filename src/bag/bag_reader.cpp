// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bag/bag_reader.hpp"

#include <algorithm>
#include <utility>

namespace sas_motion::ros_side {

using bag_format::Bytes;
using bag_format::Error;
using bag_format::key;

BagReader::BagReader(const std::string& path) : path_(path), file_(path) {
  try {
    file_.readIndex(connections_, chunks_);
  } catch (const Error& error) {
    throw std::runtime_error(
        fmt::format("{}: is no whole rosbag ({}); if it was cut short, 'rosbag reindex' may save what is there", path,
                    error.what()));
  }
  const auto earlier = [](const ChunkInfo& a, const ChunkInfo& b) { return key(a.begin) < key(b.begin); };
  std::stable_sort(chunks_.begin(), chunks_.end(), earlier);
  for (const auto& chunk : chunks_) end_ = key(chunk.end) > key(end_) ? chunk.end : end_;
  if (!chunks_.empty()) begin_ = chunks_.front().begin;
  for (const auto& connection : connections_) index_by_id_[connection.id] = connection.index;
  queues_.resize(connections_.size());
}

void BagReader::damaged(const char* why) const {
  throw std::runtime_error(fmt::format("{}: is damaged ({}); 'rosbag reindex' may save what is whole", path_, why));
}

const BagMessage* BagReader::next() {
  release();
  while (next_chunk_ < chunks_.size() &&
         (heads_.empty() || key(chunks_[next_chunk_].begin) <= key(queues_[heads_.front()].front().time)))
    guarded([&] { load(chunks_[next_chunk_++]); });
  if (heads_.empty()) return nullptr;

  const auto after = [this](std::uint32_t a, std::uint32_t b) { return isAfter(a, b); };
  std::pop_heap(heads_.begin(), heads_.end(), after);
  const std::uint32_t index = heads_.back();
  Queue& queue = queues_[index];
  const Entry& entry = queue.entries[queue.next++];
  message_ = {&connections_[index], entry.time, entry.bytes};
  chunk_of_message_ = entry.chunk;
  queue.taken = ++count_;
  if (queue.empty())
    heads_.pop_back();
  else
    std::push_heap(heads_.begin(), heads_.end(), after);
  return &message_;
}

bool BagReader::isAfter(std::uint32_t a, std::uint32_t b) const {
  const Queue &qa = queues_[a], &qb = queues_[b];
  const auto ta = key(qa.front().time), tb = key(qb.front().time);
  if (ta != tb) return ta > tb;
  return qa.taken != qb.taken ? qa.taken < qb.taken : a < b;
}

/// Gives up the message that was handed out, and its chunk with its last message.
void BagReader::release() {
  const Chunk* left = std::exchange(chunk_of_message_, nullptr);
  if (!left) return;
  const auto place =
      std::find_if(loaded_.begin(), loaded_.end(), [left](const auto& chunk) { return chunk.get() == left; });
  if (--(*place)->unread > 0) return;
  idle_ = std::move(*place);
  loaded_.erase(place);
}

void BagReader::load(const ChunkInfo& info) {
  loaded_.push_back(idle_ ? std::move(idle_) : std::make_unique<Chunk>());
  Chunk& chunk = *loaded_.back();
  file_.read(info, chunk.bytes);
  for (auto& queue : queues_) {
    queue.entries.erase(queue.entries.begin(), queue.entries.begin() + static_cast<std::ptrdiff_t>(queue.next));
    queue.next = 0;
  }
  addMessages(info, chunk);
  heads_.clear();
  for (std::uint32_t i = 0; i < queues_.size(); ++i) {
    auto& entries = queues_[i].entries;
    const auto before = [](const Entry& a, const Entry& b) {
      return key(a.time) != key(b.time) ? key(a.time) < key(b.time) : a.chunk_order < b.chunk_order;
    };
    if (!std::is_sorted(entries.begin(), entries.end(), before))
      std::stable_sort(entries.begin(), entries.end(), before);
    if (!entries.empty()) heads_.push_back(i);
  }
  std::make_heap(heads_.begin(), heads_.end(), [this](std::uint32_t a, std::uint32_t b) { return isAfter(a, b); });
}

void BagReader::addMessages(const ChunkInfo& info, Chunk& chunk) {
  Bytes records(chunk.bytes.data(), chunk.bytes.size());
  chunk.unread = 0;
  while (!records.empty()) {
    const Bytes header = records.block(), data = records.block();
    const auto head = bag_format::messageHead(header);
    if (!head) continue;
    const auto found = index_by_id_.find(head->connection);
    if (found == index_by_id_.end()) throw Error("a message of an unknown connection");
    if (key(head->time) < key(info.begin) || key(head->time) > key(info.end))
      throw Error("a chunk with messages outside the times in the index");
    queues_[found->second].entries.push_back({head->time, info.order, data, &chunk});
    ++chunk.unread;
  }
  if (chunk.unread != info.messages) throw Error("a chunk with another number of messages than the index has");
}

std::size_t BagReader::bytesHeld() const {
  std::size_t held = idle_ ? idle_->bytes.capacity() : 0;
  for (const auto& chunk : loaded_) held += chunk->bytes.capacity();
  for (const auto& queue : queues_) held += queue.entries.capacity() * sizeof(Entry);
  return held;
}

}  // namespace sas_motion::ros_side

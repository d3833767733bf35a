// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/time.h>

#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

/// The record layout of rosbag's format 2.0 (wiki.ros.org/Bags/Format/2.0), little-endian: a header of named fields,
/// then data, each behind its length.
namespace sas_motion::ros_side::bag_format {

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
constexpr std::size_t kFileHeaderSize = 4096;
enum Op : std::uint8_t { kMessage = 2, kFileHeader = 3, kIndex = 4, kChunk = 5, kChunkInfo = 6, kConnection = 7 };

/// What does not follow the format. The message is the part of a sentence that the reader puts the file's name before.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Bytes that are taken from the front; never more than there are, whatever a length among them states.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  explicit Bytes(std::string_view text) : Bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()) {}

  const std::uint8_t* data() const { return data_; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  std::string_view text() const { return {reinterpret_cast<const char*>(data_), size_}; }

  Bytes take(std::size_t size) {
    if (size > size_) throw Error("a length reaches beyond what is there");
    const Bytes front(data_, size);
    data_ += size;
    size_ -= size;
    return front;
  }
  template <class Number>
  Number number() {
    Number value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  /// What stands behind a length.
  Bytes block() { return take(number<std::uint32_t>()); }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

/// Hands each field of a record's header to `visit(name, value)`.
template <class Visit>
void forEachField(Bytes header, const Visit& visit) {
  while (!header.empty()) {
    const Bytes field = header.block();
    const auto equals = field.text().find('=');
    if (equals == std::string_view::npos) throw Error("a field without '='");
    visit(field.text().substr(0, equals), Bytes(field.text().substr(equals + 1)));
  }
}

inline std::optional<Bytes> find(Bytes header, std::string_view wanted) {
  std::optional<Bytes> found;
  forEachField(header, [&](std::string_view name, Bytes value) {
    if (name == wanted) found = value;
  });
  return found;
}

inline Bytes required(Bytes header, std::string_view wanted) {
  const auto found = find(header, wanted);
  if (!found) throw Error("a record without its field '" + std::string(wanted) + "'");
  return *found;
}

template <class Number>
Number requiredNumber(Bytes header, std::string_view wanted) {
  return required(header, wanted).number<Number>();
}

inline ros::Time timeFrom(Bytes bytes) {
  ros::Time time;  // its constructor would carry a second over, and throw
  time.sec = bytes.number<std::uint32_t>();
  time.nsec = bytes.number<std::uint32_t>();
  if (time.nsec >= 1'000'000'000) throw Error("a time with more than a second of nanoseconds");
  return time;
}

/// Orders as the time does; ros::Time's own comparisons are calls into a library.
inline std::uint64_t key(ros::Time time) { return std::uint64_t{time.sec} << 32U | time.nsec; }

struct MessageHead {
  std::uint32_t connection = 0;
  ros::Time time;
};

/// The header of a record in a chunk; nothing where it is a connection's.
inline std::optional<MessageHead> messageHead(Bytes header) {
  std::optional<Bytes> op, connection, time;
  forEachField(header, [&](std::string_view name, Bytes value) {
    if (name == "op") op = value;
    if (name == "conn") connection = value;
    if (name == "time") time = value;
  });
  if (!op) throw Error("a record without its field 'op'");
  const auto code = op->number<std::uint8_t>();
  if (code == kConnection) return std::nullopt;
  if (code != kMessage || !connection || !time) throw Error("a chunk with a record that is no message");
  return MessageHead{connection->number<std::uint32_t>(), timeFrom(*time)};
}

}  // namespace sas_motion::ros_side::bag_format

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>

#include "bag/bag_writer.hpp"
#include "sas_motion/io/atomic_file.hpp"

namespace sas_motion::ros_side {

/// A bag that appears under its name only when it is whole.
class BagOutput {
 public:
  /// Its functions throw std::runtime_error naming the file where it cannot be written.
  explicit BagOutput(const std::string& path);

  template <class Message>
  void write(const std::string& topic, ros::Time time, const Message& message) {
    guarded([&] { writer_.write(topic, time, message); });
  }
  /// As a latched topic, so that late subscribers to a played bag still get it.
  template <class Message>
  void writeLatched(const std::string& topic, ros::Time time, const Message& message) {
    guarded([&] { writer_.write(topic, time, message, true); });
  }
  /// The connection here of one in another bag.
  std::uint32_t connect(const BagConnection& source) { return writer_.connect(source); }
  /// A message as it is, of a connection that connect() gave.
  void write(std::uint32_t connection, ros::Time time, bag_format::Bytes message) {
    guarded([&] { writer_.write(connection, time, message); });
  }
  /// No more is written.
  void close();
  /// Closes and puts in place.
  void commit();

 private:
  template <class Action>
  auto guarded(const Action& action) -> decltype(action()) {
    try {
      return action();
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(fmt::format("{}: could not be written ({}); is the disk full?", path_, error.what()));
    }
  }

  std::string path_;
  AtomicFile file_;
  BagWriter writer_;
};

}  // namespace sas_motion::ros_side

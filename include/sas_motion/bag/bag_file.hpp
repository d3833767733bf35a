// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "sas_motion/bag/bag_writer.hpp"
#include "sas_motion/io/atomic_file.hpp"

namespace sas_motion::ros_side {

/// Opens a bag for reading. Throws std::runtime_error: one sentence that names the file and says what to do (missing, not a bag, without
/// an index, cut short).
std::unique_ptr<rosbag::Bag> openBag(const std::string& path);

/// Runs `read`; what rosbag throws halfway through a damaged bag becomes a std::runtime_error that names the file.
template <class Read>
auto readBag(const std::string& path, const Read& read) {
  try {
    return read();
  } catch (const ros::Exception& error) {
    throw std::runtime_error(fmt::format("{}: is damaged ({}); 'rosbag reindex' may save what is whole", path, error.what()));
  }
}

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
  /// A message of another bag, as it is there.
  void copy(const rosbag::MessageInstance& message);
  /// No more is written.
  void close();
  /// Closes and puts in place.
  void commit();

 private:
  template <class Action>
  auto guarded(const Action& action) {
    try {
      return action();
    } catch (const ros::Exception&) {
      throw;  // of the bag that is read
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(fmt::format("{}: could not be written ({}); is the disk full?", path_, error.what()));
    }
  }

  std::string path_;
  AtomicFile file_;
  BagWriter writer_;
};

/// A topic's name without its leading slash: bags recorded live have one, bags written by tools often not.
inline std::string bareTopic(const std::string& topic) { return !topic.empty() && topic[0] == '/' ? topic.substr(1) : topic; }

}  // namespace sas_motion::ros_side

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>
#include <geometry_msgs/Pose.h>

#include <cstdio>
#include <string>

#include "sas_motion/io/atomic_file.hpp"
#include "sas_motion/systems/towfish/estimator.hpp"

namespace sas_motion::ros_side {

/// A trajectory in the TUM format that evo reads: stamp x y z qx qy qz qw, east, north and up of the datum [m].
class TumFile {
 public:
  explicit TumFile(const std::string& path);
  ~TumFile();
  TumFile(const TumFile&) = delete;
  TumFile& operator=(const TumFile&) = delete;

  void write(const towfish::Estimate& estimate);
  void write(Stamp stamp, const geometry_msgs::Pose& pose);
  /// No more is written. Throws std::runtime_error naming the file where the disk is full.
  void close();
  /// Closes and puts in place.
  void commit();

 private:
  void beginLine(Stamp stamp, double x, double y);
  void endLine();

  std::string path_;
  AtomicFile file_;
  std::FILE* stream_;
  fmt::memory_buffer line_;
};

}  // namespace sas_motion::ros_side

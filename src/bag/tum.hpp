// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>

#include "sas_motion/estimate/solution.hpp"
#include "sas_motion/io/atomic_file.hpp"

namespace sas_motion::ros_side {

/// A trajectory in the TUM format that evo reads: stamp x y z qx qy qz qw, east, north and up of the datum [m].
class TumFile {
 public:
  explicit TumFile(const std::string& path);
  ~TumFile();
  TumFile(const TumFile&) = delete;
  TumFile& operator=(const TumFile&) = delete;

  void write(const Solution& solution);
  /// No more is written. Throws std::runtime_error naming the file where the disk is full.
  void close();
  /// Closes and puts in place.
  void commit();

 private:
  std::string path_;
  AtomicFile file_;
  std::FILE* stream_;
  fmt::memory_buffer line_;
};

}  // namespace sas_motion::ros_side

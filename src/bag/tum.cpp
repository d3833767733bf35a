// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bag/tum.hpp"

#include <fmt/format.h>

#include <iterator>
#include <stdexcept>

#include "sas_motion/io/fixed_decimals.hpp"

namespace sas_motion::ros_side {

TumFile::TumFile(const std::string& path)
    : path_(path), file_(path), stream_(std::fopen(file_.temporary().c_str(), "wb")) {
  if (!stream_) throw std::runtime_error(fmt::format("{}: could not be created", path));
}

TumFile::~TumFile() {
  if (stream_) std::fclose(stream_);
}

void TumFile::write(const Solution& solution) {
  line_.clear();
  fmt::format_to(std::back_inserter(line_), "{}.{:09d}", solution.stamp / kNanosecondsPerSecond,
                 solution.stamp % kNanosecondsPerSecond);
  const auto append = [this](double value, int decimals, bool in_plane) {
    line_.push_back(' ');
    if (value == 0 && !in_plane)
      line_.push_back('0');  // what a system in the plane does not have
    else
      appendFixed(value, decimals, line_);
  };
  const Vector<3>& p = solution.position_map;
  const Eigen::Quaterniond& q = solution.q_map_base;
  for (const double part : {p.x(), p.y()}) append(part, 9, true);
  append(p.z(), 9, false);
  for (const double part : {q.x(), q.y()}) append(part, 12, false);
  for (const double part : {q.z(), q.w()}) append(part, 12, true);
  line_.push_back('\n');
  std::fwrite(line_.data(), 1, line_.size(), stream_);  // commit() looks for failures
}

void TumFile::close() {
  const bool failed = std::ferror(stream_) != 0;
  const bool not_closed = std::fclose(stream_) != 0;
  stream_ = nullptr;
  if (failed || not_closed) throw std::runtime_error(fmt::format("{}: could not be written; is the disk full?", path_));
}

void TumFile::commit() {
  if (stream_) close();
  file_.commit();
}

}  // namespace sas_motion::ros_side

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bag/tum.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string_view>

#include "sas_motion/io/fixed_decimals.hpp"

namespace sas_motion::ros_side {

TumFile::TumFile(const std::string& path)
    : path_(path), file_(path), stream_(std::fopen(file_.temporary().c_str(), "wb")) {
  if (!stream_) throw std::runtime_error(fmt::format("{}: could not be created", path));
}

TumFile::~TumFile() {
  if (stream_) std::fclose(stream_);
}

void TumFile::beginLine(Stamp stamp, double x, double y) {
  line_.clear();
  fmt::format_to(std::back_inserter(line_), "{}.{:09d} ", stamp / kNanosecondsPerSecond, stamp % kNanosecondsPerSecond);
  appendFixed(x, 9, line_);
  line_.push_back(' ');
  appendFixed(y, 9, line_);
}

void TumFile::endLine() {
  line_.push_back('\n');
  std::fwrite(line_.data(), 1, line_.size(), stream_);  // commit() looks for failures
}

void TumFile::write(const towfish::Estimate& estimate) {
  const auto& x = estimate.belief.mean;
  const double yaw = kPi / 2 - x(towfish::kHeading);
  beginLine(estimate.stamp, x(towfish::kEast), x(towfish::kNorth));
  line_.append(std::string_view(" 0 0 0 "));
  appendFixed(std::sin(yaw / 2), 12, line_);
  line_.push_back(' ');
  appendFixed(std::cos(yaw / 2), 12, line_);
  endLine();
}

void TumFile::write(Stamp stamp, const geometry_msgs::Pose& pose) {
  beginLine(stamp, pose.position.x, pose.position.y);
  line_.push_back(' ');
  appendFixed(pose.position.z, 9, line_);
  for (const double part : {pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w}) {
    line_.push_back(' ');
    appendFixed(part, 12, line_);
  }
  endLine();
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

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace sas_motion {

Progress::Progress(std::string title, double total, double data_seconds)
    : title_(std::move(title)),
      total_(total),
      data_seconds_(data_seconds),
      terminal_(::isatty(STDERR_FILENO) == 1),
      begin_(std::chrono::steady_clock::now()) {}

Progress::~Progress() {
  if (terminal_ && drawn_ >= 0) std::fputs("\n", stderr);
}

void Progress::advance(double amount) {
  const std::lock_guard<std::mutex> lock(mutex_);
  done_ += amount;
  if (!terminal_) return;
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  if (elapsed - drawn_ < 0.1 && done_ < total_) return;
  drawn_ = elapsed;
  draw(elapsed);
}

void Progress::draw(double elapsed) {
  const double share = total_ > 0 ? std::clamp(done_ / total_, 0.0, 1.0) : 1;
  const int width = 30, filled = static_cast<int>(share * width);
  std::string line =
      fmt::format("\r{} [{:=<{}}{: <{}}] {:3.0f} %", title_, "", filled, "", width - filled, 100 * share);
  if (data_seconds_ > 0 && elapsed > 0) line += fmt::format(", {:.0f} x real time", share * data_seconds_ / elapsed);
  if (share > 0.01) line += fmt::format(", {:.0f} s left  ", elapsed * (1 - share) / share);
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace sas_motion

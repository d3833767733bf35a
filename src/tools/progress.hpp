// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

namespace sas_motion {

/// A progress bar on standard error: share done, real-time factor (seconds of data a second) and time left. Silent
/// where standard error is no terminal. Thread-safe.
class Progress {
 public:
  /// `total` in any unit; `data_seconds`, the duration of all the data, or 0 where that means nothing.
  Progress(std::string title, double total, double data_seconds);
  ~Progress();
  void advance(double amount);

 private:
  void draw(double elapsed);

  std::string title_;
  double total_, data_seconds_, done_ = 0, drawn_ = -1;
  bool terminal_;
  std::chrono::steady_clock::time_point begin_;
  std::mutex mutex_;
};

}  // namespace sas_motion

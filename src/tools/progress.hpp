// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <mutex>
#include <string>

namespace sas_motion {

/// A progress bar on standard error, if that is a terminal: share done, real-time factor (seconds of data a second) and
/// time left. Thread-safe.
class Progress {
 public:
  /// `total` has any unit; `data_seconds` is the duration of all data, or 0 without a real-time factor.
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

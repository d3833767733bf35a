// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "evaluation/report.hpp"

namespace sas_motion {

/// Whether a filter was ever sure of a wrong position: an error beyond five of its own standard deviations for more
/// than five epochs.
class LockOut {
 public:
  explicit LockOut(double epoch) : longest_(5 * epoch) {}

  /// `ratio`: the largest error of an axis over its standard deviation. Times rise [s].
  void add(double time, double ratio) {
    const bool wrong = ratio > 5;
    if (wrong && !wrong_) since_ = time;
    wrong_ = wrong;
    locked_out_ |= wrong && time - since_ > longest_ - 1e-9;
  }
  bool lockedOut() const { return locked_out_; }

 private:
  double longest_;
  double since_ = 0;
  bool wrong_ = false;
  bool locked_out_ = false;
};

/// Watches an estimate come near the truth. It has converged where it stays near without a break for so long up to the
/// end of the run: one that just passes by has not.
class ConvergenceWatch {
 public:
  /// `hold`: the least time that it has to stay [s].
  explicit ConvergenceWatch(double hold) : hold_(hold) {}

  /// Times rise [s].
  void add(double time, bool near) {
    last_ = time;
    if (!near)
      since_.reset();
    else if (!since_)
      since_ = time;
  }
  Convergence result() const { return {since_ && last_ - *since_ >= hold_ - 1e-9 ? since_ : std::nullopt}; }

 private:
  double hold_;
  double last_ = 0;
  std::optional<double> since_;
};

}  // namespace sas_motion

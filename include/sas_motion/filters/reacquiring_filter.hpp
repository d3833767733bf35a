// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <stdexcept>
#include <string>

#include "sas_motion/filters/conditioning.hpp"
#include "sas_motion/filters/kalman_filter.hpp"

namespace sas_motion {

/// How long a row of a sensor has been rejected, and whether its readings agree with each other.
struct RejectionRecord {
  int count = 0;       ///< consecutive readings that were down-weighted or rejected
  int agreements = 0;  ///< number of them that agreed with the one before
  double since = 0;    ///< time of the first [s]
  double last_innovation = 0;
};

/// A belief and the rejections in each row of each sensor.
template <class Belief>
struct WatchedBelief {
  static constexpr int kMaxRows = 4;
  Belief state;
  std::array<std::array<RejectionRecord, kMaxRows>, kMaxSources> rejections{};
};

template <class Belief>
const auto& gaussian(const WatchedBelief<Belief>& belief) {
  return gaussian(belief.state);
}

/// A rule that lets any filter accept measurements again.
///
/// After a jump, or an outage with more drift than its covariance states, a robust filter takes every good measurement
/// for an outlier. The rule: once a row of a sensor has been down-weighted or rejected for longer than `reset_after`
/// while its readings agree with each other, as outliers rarely do, the covariance is increased in that row until the
/// latest innovation is one standard deviation, and the measurement is fused again.
template <class Filter, int N>
class ReacquiringFilter {
 public:
  using Belief = WatchedBelief<typename Filter::Belief>;

  /// `reset_after` in seconds; throws std::invalid_argument where it is not positive.
  ReacquiringFilter(const Filter& filter, double reset_after) : filter_(filter), reset_after_(reset_after) {
    if (!(reset_after > 0))
      throw std::invalid_argument("reset_after is " + std::to_string(reset_after) + " but must be positive");
  }

  Belief predict(const Belief& belief, const Transition<N>& transition) const {
    return {filter_.predict(belief.state, transition), belief.rejections};
  }

  template <int M>
  Update<Belief, M> update(const Belief& prior, const LinearMeasurement<N, M>& z) const {
    static_assert(M <= Belief::kMaxRows);
    auto inner = filter_.update(prior.state, z);
    auto rejections = prior.rejections;
    auto widened = prior.state;
    bool reacquire = false;
    for (int row = 0; row < M && inner.verdict != Verdict::Invalid; ++row) {
      auto& record = rejections[static_cast<std::size_t>(z.source)][static_cast<std::size_t>(row)];
      if (!lockedOut(record, inner.weights(row), inner.innovation(row), z.R(row, row), z.time)) continue;
      record = {};
      const double variance = inner.innovation(row) * inner.innovation(row) - inner.S(row, row);
      addCovariance<N>(widened, widening<N>(ownCovariance(widened), z.H.row(row).transpose(), variance));
      reacquire = true;
    }
    if (reacquire) inner = filter_.update(widened, z);
    return {{inner.belief, rejections}, inner.innovation, inner.S,      inner.nis, inner.weights,
            inner.iterations,           inner.converged,  inner.verdict};
  }

 private:
  /// Updates the record of one row. Returns true where its readings are to be accepted again.
  bool lockedOut(RejectionRecord& record, double weight, double innovation, double R, double time) const {
    if (weight >= kDownWeighted) {
      record = {};
      return false;
    }
    if (record.count == 0) record.since = time;
    const double step = innovation - record.last_innovation;
    const bool agrees = record.count > 0 && step * step < 2 * kAgreement * kAgreement * R;
    ++record.count;
    record.agreements += agrees;
    record.last_innovation = innovation;
    return agrees && time - record.since > reset_after_ && record.count >= kFewest &&
           record.agreements >= kFewestAgreements;
  }

  Filter filter_;
  double reset_after_;

  static constexpr double kAgreement = 3;  // largest difference of readings that agree, in standard deviations
  static constexpr int kFewest = 10;
  static constexpr int kFewestAgreements = 5;
};

}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <type_traits>

#include "sas_motion/filters/particles/lane_matrix.hpp"
#include "sas_motion/filters/particles/one_by_one.hpp"
#include "sas_motion/filters/square_root_filter.hpp"

namespace sas_motion {

/// OneByOne<SimplexFilter<N>> by vector instructions, with one lane for each particle; f and h are called for each
/// particle and point. The results are the same to rounding. OneByOne itself runs for a block of one, and for a
/// particle whose root cannot be downdated.
///
/// A step allocates nothing.
template <int N>
class SimplexBlocks {
 public:
  using Belief = RootGaussian<N>;
  static constexpr int kTogether = blocks::kLanes;

  explicit SimplexBlocks(const SimplexPoints<N>& points, bool vectorised = true)
      : points_(points),
        shared_(-points.offsets.col(1)),
        root_weights_(points.covariance_weights.cwiseSqrt()),
        each_(SimplexFilter<N>(points)),
        vectorised_(vectorised) {}

  const SimplexFilter<N>& one() const { return each_.one(); }

  /// See OneByOne.
  template <class Beliefs, class Function, class Lost>
  void predict(int count, const Beliefs& belief, const Function& f, const Matrix<N>& Q_root, const Lost& lost) const {
    if (!together(count)) return each_.predict(count, belief, f, Q_root, lost);
    Room room;
    load(count, belief, room);
    land<N>(count, room, f, room.offsets);
    blocks::average(points_.mean_weights.data(), root_weights_.data(), N, kPoints, room.offsets.data(),
                    room.mean.data());
    room.root.setAll(Q_root);
    blocks::addSquares(room.root.data(), N, room.offsets.data(), kPoints);
    for (int k = 0; k < count; ++k)
      if (room.mean.finite(k) && room.root.finite(k))
        store(room, k, belief(k));
      else
        lost(k);
  }

  /// See OneByOne.
  template <int M, class Beliefs, class Function, class Difference, class Weigh>
  void update(int count, const Beliefs& belief, const Vector<M>& z, const Function& h, const Matrix<M>& R_root,
              const Difference& difference, const Weigh& weigh) const {
    static_assert(M <= blocks::kMostRows);
    if (!together(count)) return each_.template update<M>(count, belief, z, h, R_root, difference, weigh);
    Room room;
    Reading<M> reading;
    load(count, belief, room);
    land<M>(count, room, h, reading.deviations);
    compare<M>(count, z, difference, reading);
    reading.S_root.setAll(R_root);
    condition<M>(room, reading);
    for (int k = 0; k < count; ++k) {
      if (reading.done(0, k) == 1) {
        store(room, k, belief(k));
        weigh(k, -0.5 * reading.nis(0, k) - reading.S_root.logDeterminant(k));
      } else {
        const auto it = [&](int) -> Belief& { return belief(k); };
        each_.template update<M>(1, it, z, h, R_root, difference,
                                 [&](int, double log_likelihood) { weigh(k, log_likelihood); });
      }
    }
  }

  /// See OneByOne.
  template <class Beliefs, class Weights>
  void addMoments(int count, const Beliefs& belief, const Weights& weight, const Vector<N>& mean,
                  Matrix<N>& sum) const {
    if (!together(count)) return each_.addMoments(count, belief, weight, mean, sum);
    LaneRoot<N> root, sums;
    LaneMatrix<N> offset;
    LaneMatrix<1> weights;
    sums.setAll(Matrix<N>::Zero());
    for (int first = 0; first < count; first += blocks::kLanes) {
      const auto of = [&](int lane) -> const Belief& { return belief(std::min(first + lane, count - 1)); };
      root.set([&](int lane) -> const Matrix<N>& { return of(lane).root; });
      for (int lane = 0; lane < blocks::kLanes; ++lane) {
        offset.setColumn(0, lane, of(lane).mean - mean);
        weights(0, lane) = first + lane < count ? weight(first + lane) : 0;
      }
      blocks::addSecondMoments(root.data(), offset.data(), weights.data(), N, sums.data());
    }
    Matrix<N> lane_sum = Matrix<N>::Zero();
    for (int lane = 0; lane < blocks::kLanes; ++lane) {
      sums.get(lane, lane_sum);
      sum += lane_sum;
    }
    sum.template triangularView<Eigen::StrictlyUpper>() = sum.transpose();
  }

 private:
  static constexpr int kPoints = N + 2;

  struct Room {
    LaneMatrix<N> mean;
    LaneRoot<N> root;
    LaneMatrix<N, kPoints> offsets;  // of the points from the mean; in a prediction then their images
  };

  template <int M>
  struct Reading {
    LaneMatrix<M, kPoints> deviations;  // images of the points by h, then their deviations from the mean
    LaneMatrix<M> mean, innovation;
    LaneRoot<M> S_root;
    LaneMatrix<M, N> gain;
    LaneMatrix<1> nis, done;
  };

  bool together(int count) const { return vectorised_ && count > 1; }

  template <class Beliefs>
  void load(int count, const Beliefs& belief, Room& room) const {
    const auto of = [&](int lane) -> const Belief& { return belief(std::min(lane, count - 1)); };
    for (int lane = 0; lane < blocks::kLanes; ++lane) room.mean.setColumn(0, lane, of(lane).mean);
    room.root.set([&](int lane) -> const Matrix<N>& { return of(lane).root; });
    blocks::spread(room.root.data(), shared_.data(), N, room.offsets.data());
  }

  static void store(const Room& room, int lane, Belief& belief) {
    belief.mean = room.mean.column(0, lane);
    room.root.get(lane, belief.root);
  }

  /// Maps the points by a function; `landed` may be the room's offsets. The points of all lanes are written before the
  /// function is called, so that it need not wait for these writes.
  template <int M, class Function>
  void land(int count, const Room& room, const Function& function, LaneMatrix<M, kPoints>& landed) const {
    Vector<N> x[blocks::kLanes];
    Vector<M> y[blocks::kLanes];
    for (int point = 0; point < kPoints; ++point) {
      for (int row = 0; row < N; ++row)
        for (int lane = 0; lane < blocks::kLanes; ++lane)
          x[lane](row) = room.mean(row, lane) + room.offsets(row * kPoints + point, lane);
      for (int lane = 0; lane < blocks::kLanes; ++lane) y[lane] = lane < count ? function(x[lane]) : y[count - 1];
      for (int row = 0; row < M; ++row)
        for (int lane = 0; lane < blocks::kLanes; ++lane) landed(row * kPoints + point, lane) = y[lane](row);
    }
  }

  /// Computes means, weighted deviations and innovations of the images by h.
  template <int M, class Difference>
  void compare(int count, const Vector<M>& z, const Difference& difference, Reading<M>& reading) const {
    if constexpr (std::is_same_v<Difference, PlainDifference>) {
      blocks::average(points_.mean_weights.data(), root_weights_.data(), M, kPoints, reading.deviations.data(),
                      reading.mean.data());
    } else {
      for (int k = 0; k < count; ++k) {
        Matrix<M, kPoints> landed = reading.deviations.matrix(k);
        reading.mean.setColumn(0, k, average<M>(points_, Vector<M>(landed.col(0)), landed, difference));
        for (int point = 0; point < kPoints; ++point)
          reading.deviations.setColumn(point, k, root_weights_(point) * landed.col(point));
      }
      reading.deviations.fillFrom(count);
    }
    for (int k = 0; k < count; ++k) reading.innovation.setColumn(0, k, difference(z, reading.mean.column(0, k)));
    reading.innovation.fillFrom(count);
  }

  template <int M>
  void condition(Room& room, Reading<M>& reading) const {
    blocks::Conditioning task;
    task.states = N;
    task.rows = M;
    task.points = kPoints;
    task.root_weights = root_weights_.data();
    task.offsets = room.offsets.data();
    task.innovation = reading.innovation.data();
    task.deviations = reading.deviations.data();
    task.S_root = reading.S_root.data();
    task.gain = reading.gain.data();
    task.mean = room.mean.data();
    task.root = room.root.data();
    task.nis = reading.nis.data();
    task.done = reading.done.data();
    blocks::condition(task);
  }

  SimplexPoints<N> points_;
  Vector<N> shared_;
  Vector<kPoints> root_weights_;
  OneByOne<SimplexFilter<N>> each_;
  bool vectorised_;
};

}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include "sas_motion/filters/particles/belief_form.hpp"
#include "sas_motion/filters/particles/gaussian_density.hpp"
#include "sas_motion/filters/update.hpp"

namespace sas_motion {

/// Runs the filters of a block of particles one after the other.
///
/// `belief(k)` is the k-th of `count` beliefs. The noise is given by its root.
template <class Filter>
class OneByOne {
 public:
  using Belief = typename Filter::Belief;
  static constexpr int N = decltype(Belief::mean)::RowsAtCompileTime;
  static constexpr int kTogether = 24;  ///< particles in a block

  explicit OneByOne(const Filter& filter) : filter_(filter) {}
  const Filter& one() const { return filter_; }

  /// Predicts by x' = f(x) + w. Calls `lost(k)` where that is not finite; that belief stays.
  template <class Beliefs, class Function, class Lost>
  void predict(int count, const Beliefs& belief, const Function& f, const Matrix<N>& Q_root, const Lost& lost) const {
    const Matrix<N> noise = Form::noise(Q_root);
    for (int k = 0; k < count; ++k)
      if (const auto prior = filter_.predict(belief(k), f, noise))
        belief(k) = *prior;
      else
        lost(k);
  }

  /// Updates with z = h(x) + v. Calls `weigh(k, log_likelihood)`, without the constant in 2 pi; the likelihood is NaN
  /// where the update fails and the belief stays.
  template <int M, class Beliefs, class Function, class Difference, class Weigh>
  void update(int count, const Beliefs& belief, const Vector<M>& z, const Function& h, const Matrix<M>& R_root,
              const Difference& difference, const Weigh& weigh) const {
    const Matrix<M> noise = Form::noise(R_root);
    for (int k = 0; k < count; ++k) weigh(k, updateOne<M>(belief(k), z, h, noise, difference));
  }

  /// Adds `weight(k)` times the belief's covariance and the square of its mean's distance from `mean`.
  template <class Beliefs, class Weights>
  void addMoments(int count, const Beliefs& belief, const Weights& weight, const Vector<N>& mean,
                  Matrix<N>& sum) const {
    for (int k = 0; k < count; ++k) {
      const Vector<N> offset = belief(k).mean - mean;
      sum.noalias() += weight(k) * (gaussian(belief(k)).covariance + offset * offset.transpose());
    }
  }

 private:
  using Form = BeliefForm<Belief>;

  template <int M, class Function, class Difference>
  double updateOne(Belief& belief, const Vector<M>& z, const Function& h, const Matrix<M>& noise,
                   const Difference& difference) const {
    const auto result = filter_.update(belief, z, h, noise, difference);
    const auto S_root = result.verdict == Verdict::Invalid ? std::nullopt : choleskyLower<M>(result.S);
    if (!S_root) return std::numeric_limits<double>::quiet_NaN();
    belief = result.belief;
    return logDensity<M>(result.innovation, *S_root);
  }

  Filter filter_;
};

}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/calibrated_filter.hpp"

#include <algorithm>

#include "filters/instantiate.hpp"
#include "sas_motion/filters/conditioning.hpp"
#include "sas_motion/filters/filter_by_name.hpp"

namespace sas_motion {
namespace {

constexpr double kPriorCount = 20;     // readings that the initial values count as
constexpr double kMemory = 300;        // readings in an average at most
constexpr double kLargest = 1;         // variance of a prediction over R that the averages apply to
constexpr double kLeastSlope = 1e-12;  // of a redescending loss the slope can be negative

/// Adds a reading to a row's averages. `t` is the variance of its prediction over R by the filter's own covariance.
void learn(LearnedInfluence& row, const Influence& influence, double t) {
  if (row.readings == 0) row.readings = kPriorCount;
  row.readings = std::min(row.readings + 1, kMemory);
  const auto average = [&row](double& sum, double value) { sum += (value - sum) / row.readings; };
  const double square = (1 + t) * influence.psi * influence.psi;
  const double gain = (1 + t) * influence.slope / (1 + t * influence.slope);
  average(row.weighted, influence.weight * square);
  average(row.clipped, (1 - influence.weight) * square);
  average(row.gain, gain * gain);
}

/// The noise over R with which a Kalman filter's gain has the same effect as the row's influence. `s` is `t` by the
/// calibrated covariance. After an outage t is large, but the averages are of readings at a smaller one, so t is
/// limited.
double noiseThrough(const LearnedInfluence& row, double t, double s) {
  if (t > kLargest) {
    s *= kLargest / t;
    t = kLargest;
  }
  const double square = std::min(row.weighted, (1 + s) / (1 + t)) + row.clipped;  // accepted readings do not increase R
  return std::max(row.gain * row.gain, (1 + t) * square - s * row.gain);  // and no reading is better than a good one
}

}  // namespace

template <class Filter, int N>
CalibratedBelief<N> CalibratedFilter<Filter, N>::predict(const Belief& belief, const Transition<N>& transition) const {
  Belief prior = belief;
  prior.state = filter_.predict(belief.state, transition);
  if (belief.started) prior.own = filter_.predict(own(belief), transition).covariance;
  return prior;
}

template <class Filter, int N>
template <int M>
Update<CalibratedBelief<N>, M> CalibratedFilter<Filter, N>::update(const Belief& prior,
                                                                   const LinearMeasurement<N, M>& z) const {
  static_assert(M <= Belief::kMaxRows);
  const Gaussian<N> own_prior = own(prior);
  const auto inner = filter_.update(own_prior, z);
  Update<Belief, M> result{prior,         inner.innovation, inner.S,         inner.nis,
                           inner.weights, inner.iterations, inner.converged, inner.verdict};
  if (inner.verdict == Verdict::Invalid) return result;
  Belief& belief = result.belief;
  if (!filter_.calibrates()) {
    belief.state = inner.belief;
    return result;
  }
  belief.state.mean = inner.belief.mean;
  belief.own = inner.belief.covariance;
  belief.started = true;
  const Projection<N, M> own_rows(own_prior.covariance, z.H), rows(prior.state.covariance, z.H);
  const Vector<M> t = own_rows.HPHt.diagonal().cwiseQuotient(z.R.diagonal()),
                  s = rows.HPHt.diagonal().cwiseQuotient(z.R.diagonal());
  const Vector<M> residual = z.innovation - z.H * (inner.belief.mean - own_prior.mean);
  Matrix<M> S = own_rows.HPHt;
  Vector<M> noise;
  for (int row = 0; row < M; ++row) {
    const double R = z.R(row, row),
                 after = t(row) / (1 + t(row) * inner.weights(row));  // variance of the predicted residual, over R
    Influence influence = filter_.influence(residual(row) / std::sqrt(R), after);
    influence.slope = std::max(kLeastSlope, influence.slope);
    auto& learned = belief.learned[static_cast<std::size_t>(z.source)][static_cast<std::size_t>(row)];
    learn(learned, influence, t(row));
    noise(row) = R * noiseThrough(learned, t(row), s(row));
    S(row, row) += R / influence.slope;
  }
  // (I - K H) P (I - K H)^T + G noise G^T, with K the gain on a change of the reading and G a Kalman filter's
  const Matrix<M> J = S.inverse(),
                  J_kalman = inner.S.inverse();  // the filter has factorized the second, and the first is larger
  const Matrix<M> back = J * rows.HPHt * J + J_kalman * noise.asDiagonal() * J_kalman;
  const Matrix<M, N> half = J * rows.PHt.transpose() - 0.5 * back * own_rows.PHt.transpose();
  const Matrix<N> less = own_rows.PHt * half;
  belief.state.covariance -= less + less.transpose();
  symmetrize(belief.state.covariance);
  return result;
}

#define SAS_MOTION_INSTANTIATE_CALIBRATED_UPDATE(Filter, N, M)                       \
  template Update<CalibratedBelief<N>, M> CalibratedFilter<Filter<N>, N>::update<M>( \
      const CalibratedBelief<N>&, const LinearMeasurement<N, M>&) const;
#define SAS_MOTION_INSTANTIATE_CALIBRATED(Filter)        \
  template class CalibratedFilter<Filter<2>, 2>;         \
  template class CalibratedFilter<Filter<6>, 6>;         \
  SAS_MOTION_INSTANTIATE_CALIBRATED_UPDATE(Filter, 2, 1) \
  SAS_MOTION_INSTANTIATE_CALIBRATED_UPDATE(Filter, 6, 1) \
  SAS_MOTION_INSTANTIATE_CALIBRATED_UPDATE(Filter, 6, 2) \
  SAS_MOTION_INSTANTIATE_CALIBRATED_UPDATE(Filter, 6, 4)
SAS_MOTION_FOR_CALIBRATED_FILTERS(SAS_MOTION_INSTANTIATE_CALIBRATED)

}  // namespace sas_motion

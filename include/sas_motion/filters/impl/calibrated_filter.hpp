// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "sas_motion/filters/calibrated_filter.hpp"
#include "sas_motion/filters/conditioning.hpp"
#include "sas_motion/robust/loss.hpp"

namespace sas_motion {

/// Adds a reading to a row's averages. `t` is the variance of its prediction over R by the filter's own covariance.
void learn(LearnedInfluence& row, const Influence& influence, double t);

/// The noise over R with which a Kalman filter's gain has the same effect as the row's influence. `s` is `t` by the
/// calibrated covariance. After an outage t is large, but the averages are of readings at a smaller one, so t is
/// limited.
double noiseThrough(const LearnedInfluence& row, double t, double s);

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
  constexpr double kLeastSlope = 1e-12;  // of a redescending loss the slope can be negative
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

// Which filters are compiled inside a CalibratedFilter, filter_by_name.hpp says.
#define SAS_MOTION_INSTANTIATE_CALIBRATED_UPDATE(KIND, Filter, N, M)                      \
  KIND template Update<CalibratedBelief<N>, M> CalibratedFilter<Filter<N>, N>::update<M>( \
      const CalibratedBelief<N>&, const LinearMeasurement<N, M>&) const;
#define SAS_MOTION_INSTANTIATE_CALIBRATED(KIND, Filter)        \
  KIND template class CalibratedFilter<Filter<2>, 2>;          \
  KIND template class CalibratedFilter<Filter<6>, 6>;          \
  SAS_MOTION_INSTANTIATE_CALIBRATED_UPDATE(KIND, Filter, 2, 1) \
  SAS_MOTION_INSTANTIATE_CALIBRATED_UPDATE(KIND, Filter, 6, 1) \
  SAS_MOTION_INSTANTIATE_CALIBRATED_UPDATE(KIND, Filter, 6, 2) \
  SAS_MOTION_INSTANTIATE_CALIBRATED_UPDATE(KIND, Filter, 6, 4)

}  // namespace sas_motion

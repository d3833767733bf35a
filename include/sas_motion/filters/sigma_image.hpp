// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sas_motion/filters/sigma_points.hpp"
#include "sas_motion/filters/update.hpp"

namespace sas_motion {

/// y - x for values that do not wrap.
struct PlainDifference {
  template <class V>
  V operator()(const V& y, const V& x) const {
    return y - x;
  }
};

/// The images of a belief's points by a function.
template <int N, int M, int Count>
struct SigmaImage {
  Matrix<N, Count> dX;          ///< the points less the belief's mean
  Vector<M> mean;               ///< of the function
  Matrix<M, Count> deviations;  ///< of the function at each point from it
};

/// Returns the mean of the images and replaces them by their deviations from it. The mean is formed from differences to
/// a reference near them, so that images on both sides of +-pi are averaged correctly.
template <int M, int N, int Count, class Difference>
Vector<M> average(const SigmaPoints<N, Count>& points, const Vector<M>& reference, Matrix<M, Count>& landed,
                  const Difference& difference) {
  Matrix<M, Count> offsets;
  for (int i = 0; i < Count; ++i) offsets.col(i) = difference(Vector<M>(landed.col(i)), reference);
  Vector<M> mean = reference + offsets * points.mean_weights;
  for (int i = 0; i < Count; ++i) landed.col(i) = difference(Vector<M>(landed.col(i)), mean);
  return mean;
}

/// Applies `function` to x + dX. The reference of the mean is the image of x.
template <int M, int N, int Count, class Function, class Difference>
SigmaImage<N, M, Count> imageOf(const SigmaPoints<N, Count>& points, const Vector<N>& x, const Matrix<N, Count>& dX,
                                const Function& function, const Difference& difference) {
  SigmaImage<N, M, Count> image{dX, {}, {}};
  for (int i = 0; i < Count; ++i) image.deviations.col(i) = function(Vector<N>(x + dX.col(i)));
  const bool centred = points.offsets.col(0).isZero(0);
  const Vector<M> reference = centred ? Vector<M>(image.deviations.col(0)) : Vector<M>(function(x));
  image.mean = average<M>(points, reference, image.deviations, difference);
  return image;
}

/// Updates a belief with z = h(x) + v by a filter that projects the prior's points and conditions on their images. The
/// innovation is z less the mean of h over the prior, not h of its mean. `noise` is passed to the filter's condition().
template <int M, class Filter, class Function, class Difference>
Update<typename Filter::Belief, M> projectAndCondition(const Filter& filter, const typename Filter::Belief& prior,
                                                       const Vector<M>& z, const Function& h, const Matrix<M>& noise,
                                                       const Difference& difference) {
  if (const auto image = filter.template project<M>(prior, h, difference))
    return filter.template condition<M>(prior, *image, difference(z, image->mean), noise);
  Update<typename Filter::Belief, M> result;
  result.belief = prior;
  result.verdict = Verdict::Invalid;
  return result;
}

}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "imaging/micronavigation_steps.hpp"

namespace sas_motion::imaging {
namespace {

/// Channels at one place for a lag of elements: element i + lag of the first ping and i of the second.
std::vector<std::pair<std::size_t, std::size_t>> pairsAtLag(int receivers, int lag) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (int i = std::max(0, -lag); i < std::min(receivers, receivers - lag); ++i)
    pairs.emplace_back(static_cast<std::size_t>(i + lag), static_cast<std::size_t>(receivers + i));
  return pairs;
}

/// |sum of products| over pairs and a block of range, the second ping read `shift` samples later.
double correlation(const AlignedLines& lines, int lag, int begin, int shift) {
  Complex sum = 0;
  for (const auto& [a, b] : pairsAtLag(static_cast<int>(lines.channels.size() / 2), lag)) {
    const Complex *x = lines.channels[a].data(), *y = lines.channels[b].data() + shift;
    for (int n = begin; n < begin + kCoherentSamples; ++n) sum += x[n] * std::conj(y[n]);
  }
  return std::abs(sum);
}

double power(const AlignedLines& lines, std::size_t channel) {
  double sum = 0;
  for (const auto& value : lines.channels[channel]) sum += std::norm(value);
  return sum / static_cast<double>(lines.samples);
}

/// Coherence at this lag of elements and shift of samples, summed over blocks of range without their phases. The blocks
/// leave a margin for shifts.
double coherence(const AlignedLines& lines, int lag, int shift, int margin) {
  double sum = 0, x = 0, y = 0;
  int samples = 0;
  for (int begin = margin; begin + kCoherentSamples + margin <= lines.samples;
       begin += kCoherentSamples, samples += kCoherentSamples)
    sum += correlation(lines, lag, begin, shift);
  for (const auto& [a, b] : pairsAtLag(static_cast<int>(lines.channels.size() / 2), lag)) {
    x += power(lines, a);
    y += power(lines, b);
  }
  return x > 0 && y > 0 ? sum / (std::sqrt(x * y) * samples) : 0;
}

/// Place of the peak of the parabola through values at -1, 0, 1; 0 where it has none.
double parabolaPeak(double before, double middle, double after) {
  const double curvature = before - 2 * middle + after;
  return curvature < 0 ? std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5) : 0;
}

}  // namespace

CoarseDisplacement searchDisplacement(const AlignedLines& lines, const PingPair& pair, const SonarDescription& sonar,
                                      const MicronavigationOptions& options) {
  const int reach = sonar.receivers - options.min_overlap,
            shifts = static_cast<int>(std::ceil(options.search / lines.range_step));
  const int margin = shifts + 1;
  CoarseDisplacement best;
  int best_shift = 0;
  for (int lag = -reach; lag <= reach; ++lag)
    for (int shift = -shifts; shift <= shifts; ++shift) {
      const double value = coherence(lines, lag, shift, margin);
      if (value > best.coherence) best.coherence = value, best.lag = lag, best_shift = shift;
    }
  const auto beside = [&](int lag, int shift) {
    return std::abs(lag) < sonar.receivers ? coherence(lines, lag, shift, margin) : 0;
  };
  const double lag =
      best.lag + parabolaPeak(beside(best.lag - 1, best_shift), best.coherence, beside(best.lag + 1, best_shift));
  const double shift =
      best_shift + parabolaPeak(beside(best.lag, best_shift - 1), best.coherence, beside(best.lag, best_shift + 1));
  best.along = lag * sonar.spacing / 2 - pair.displacement(lines.range(0.5 * lines.samples)).x();
  best.sight = -shift * lines.range_step;
  return best;
}

Eigen::Vector3d envelopeDisplacement(const AlignedLines& lines, const PingPair& pair, int lag) {
  constexpr double kRidge = 1e-3;  // where the sights are alike, the smallest displacement
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (int begin = 1; begin + kCoherentSamples + 1 <= lines.samples; begin += kCoherentSamples) {
    const double shift = parabolaPeak(correlation(lines, lag, begin, -1), correlation(lines, lag, begin, 0),
                                      correlation(lines, lag, begin, 1));
    const Eigen::Vector3d sight = pair.sight(lines.range(begin + 0.5 * kCoherentSamples), 0);
    const Eigen::Vector2d u(sight.dot(pair.across), sight.dot(pair.down));
    normal += u * u.transpose() + kRidge * Eigen::Matrix2d::Identity();
    right -= u * shift * lines.range_step;
  }
  const Eigen::Vector2d solution = normal.ldlt().solve(right);
  return {0, solution.x(), solution.y()};
}

}  // namespace sas_motion::imaging

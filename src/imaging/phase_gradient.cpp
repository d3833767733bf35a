// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numeric>

#include "imaging/fourier.hpp"
#include "sas_motion/imaging/motion_compensation.hpp"
#include "sas_motion/math/angles.hpp"

namespace sas_motion::imaging {
namespace {

using Rows = std::vector<Spectrum>;

/// The share of brightest rows, brightest first, rotated so that the brightest pixel is in the middle.
Rows centredRows(const Rows& rows, double share) {
  const auto dimmer = [](const std::complex<double>& a, const std::complex<double>& b) {
    return std::norm(a) < std::norm(b);
  };
  Rows centred = rows;
  for (auto& row : centred) {
    const auto peak = std::max_element(row.begin(), row.end(), dimmer) - row.begin();
    const auto n = static_cast<std::ptrdiff_t>(row.size());
    std::rotate(row.begin(), row.begin() + (peak - n / 2 + n) % n, row.end());
  }
  std::sort(centred.begin(), centred.end(), [](const Spectrum& a, const Spectrum& b) {
    return std::norm(a[a.size() / 2]) > std::norm(b[b.size() / 2]);
  });
  centred.resize(std::max<std::size_t>(1, static_cast<std::size_t>(share * static_cast<double>(rows.size()))));
  return centred;
}

/// Half width of the power summed over the rows at -10 dB of its peak, and half as much again [samples].
std::size_t blurHalfWidth(const Rows& rows) {
  const std::size_t n = rows[0].size(), middle = n / 2;
  std::vector<double> power(n, 0.0);
  for (const auto& row : rows)
    for (std::size_t i = 0; i < n; ++i) power[i] += std::norm(row[i]);
  std::size_t half = 1;
  for (std::size_t i = 0; i < n; ++i)
    if (power[i] > 0.1 * power[middle]) half = std::max(half, i > middle ? i - middle : middle - i);
  return std::min(middle, half + half / 2 + 2);
}

/// Spectra of the rows' middles, shifted to sample 0, where a point without error has no phase slope.
void windowAndTransform(Rows& rows, std::size_t half, Fourier& fourier) {
  for (auto& row : rows) {
    const std::size_t middle = row.size() / 2;
    for (std::size_t i = 0; i < row.size(); ++i)
      if ((i > middle ? i - middle : middle - i) > half) row[i] = 0;
    std::rotate(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(middle), row.end());
    fourier.forward(row);
  }
}

/// The bins that hold the aperture, counted from the gap: from the first to the last within 15 dB of the strongest.
std::vector<std::size_t> apertureBins(const Rows& spectra, std::size_t gap) {
  const std::size_t n = spectra[0].size();
  std::vector<double> power(n, 0.0);
  for (const auto& spectrum : spectra)
    for (std::size_t k = 0; k < n; ++k) power[k] += std::norm(spectrum[(gap + k) % n]);
  const double threshold = std::pow(10, -1.5) * *std::max_element(power.begin(), power.end());
  std::size_t first = 0, last = n - 1;
  while (power[first] < threshold) ++first;
  while (power[last] < threshold) --last;
  std::vector<std::size_t> bins(last - first + 1);
  std::iota(bins.begin(), bins.end(), first);
  return bins;
}

/// Removes mean and trend from the phase at these bins.
void detrend(std::vector<double>& phase, const std::vector<std::size_t>& bins) {
  const auto count = static_cast<double>(bins.size());
  double mean = 0, slope = 0, squares = 0;
  for (const std::size_t k : bins) mean += phase[k] / count;
  const double middle = 0.5 * static_cast<double>(bins.front() + bins.back());
  for (const std::size_t k : bins) {
    slope += (static_cast<double>(k) - middle) * phase[k];
    squares += std::pow(static_cast<double>(k) - middle, 2);
  }
  if (squares > 0) slope /= squares;
  for (const std::size_t k : bins) phase[k] -= mean + slope * (static_cast<double>(k) - middle);
}

/// Sums the maximum-likelihood gradient of the phase, arg sum conj(G_k) G_{k+1} over the rows. [Wahl1994]
std::vector<double> commonPhase(const Rows& spectra, std::size_t gap, const std::vector<std::size_t>& bins) {
  const std::size_t n = spectra[0].size();
  std::vector<double> phase(n, 0.0);
  for (std::size_t i = 1; i < bins.size(); ++i) {
    std::complex<double> product = 0;
    for (const auto& spectrum : spectra)
      product += std::conj(spectrum[(gap + bins[i - 1]) % n]) * spectrum[(gap + bins[i]) % n];
    phase[bins[i]] = phase[bins[i - 1]] + std::arg(product);
  }
  detrend(phase, bins);
  return phase;
}

double rootMeanSquare(const std::vector<double>& phase, const std::vector<std::size_t>& bins) {
  double sum = 0;
  for (const std::size_t k : bins) sum += phase[k] * phase[k];
  return std::sqrt(sum / static_cast<double>(bins.size()));
}

/// The gap of all rows together, which is the same in each iteration.
std::size_t commonGap(Rows rows, Fourier& fourier) {
  Spectrum magnitudes(rows[0].size());
  for (auto& row : rows) {
    fourier.forward(row);
    for (std::size_t k = 0; k < row.size(); ++k) magnitudes[k] += std::norm(row[k]);
  }
  for (auto& value : magnitudes) value = std::sqrt(value);
  return spectralGap(magnitudes);
}

void removePhase(Rows& rows, const std::vector<double>& phase, std::size_t gap, Fourier& fourier) {
  const std::size_t n = rows[0].size();
  for (auto& row : rows) {
    fourier.forward(row);
    for (std::size_t k = 0; k < n; ++k) row[(gap + k) % n] *= std::polar(1.0, -phase[k]);
    fourier.inverse(row);
  }
}

}  // namespace

Autofocus phaseGradientAutofocus(const Image& image, const AutofocusOptions& options) {
  checkGrid(image.grid);
  const auto columns = static_cast<std::size_t>(image.grid.columns);
  Autofocus result{image, std::vector<double>(columns, 0.0)};
  Rows rows;
  for (int row = 0; row < image.grid.rows; ++row) rows.emplace_back(&image.at(row, 0), &image.at(row, 0) + columns);
  Fourier fourier(columns);
  const std::size_t gap = commonGap(rows, fourier);
  while (result.iterations < options.max_iterations && !result.converged) {
    Rows bright = centredRows(rows, options.strongest_share);
    windowAndTransform(bright, blurHalfWidth(bright), fourier);
    const auto bins = apertureBins(bright, gap);
    const std::vector<double> phase = commonPhase(bright, gap, bins);
    removePhase(rows, phase, gap, fourier);
    for (std::size_t k = 0; k < columns; ++k) result.phase[k] += phase[k];
    ++result.iterations;
    result.converged = rootMeanSquare(phase, bins) < options.tolerance;
  }
  for (std::size_t i = 0; i < result.image.pixels.size(); ++i)
    result.image.pixels[i] = std::complex<float>(rows[i / columns][i % columns]);
  return result;
}

}  // namespace sas_motion::imaging

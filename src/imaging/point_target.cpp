// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/point_target.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "imaging/fourier.hpp"

namespace sas_motion::imaging {
namespace {

struct Pixel {
  int row = 0, column = 0;
};

/// The brightest pixel within `radius` [m] of the true position.
Pixel brightest(const Image& image, const Eigen::Vector3d& truth, double radius) {
  const ImageGrid& grid = image.grid;
  const Eigen::Vector3d way = truth - grid.origin;
  const double row = way.dot(grid.range_axis) / grid.range_step, column = way.dot(grid.along_axis) / grid.along_step;
  const double rows = radius / grid.range_step, columns = radius / grid.along_step;
  const auto bounded = [](double value, int size) { return static_cast<int>(std::clamp(value, 0.0, size - 1.0)); };
  Pixel best{bounded(row, grid.rows), bounded(column, grid.columns)};
  for (int r = bounded(row - rows, grid.rows); r <= bounded(row + rows, grid.rows); ++r)
    for (int c = bounded(column - columns, grid.columns); c <= bounded(column + columns, grid.columns); ++c)
      if (std::norm(image.at(r, c)) > std::norm(image.at(best.row, best.column))) best = {r, c};
  return best;
}

double energy(const Spectrum& spectrum) {
  return std::accumulate(spectrum.begin(), spectrum.end(), 0.0,
                         [](double sum, const std::complex<double>& value) { return sum + std::norm(value); });
}

/// A square part of the image, with cuts through it between pixels.
class Chip {
 public:
  Chip(const Image& image, Pixel first, int size)
      : size_(size), rows_(size, Spectrum(size)), columns_(size, Spectrum(size)) {
    Fourier fourier(static_cast<std::size_t>(size));
    for (int r = 0; r < size; ++r)
      for (int c = 0; c < size; ++c) rows_[r][c] = columns_[c][r] = image.at(first.row + r, first.column + c);
    for (int i = 0; i < size; ++i) {
      fourier.forward(rows_[i]);
      fourier.forward(columns_[i]);
    }
  }
  /// The cut along range at this column.
  Spectrum rangeCut(double column) const { return cut(rows_, column); }
  /// The cut along track at this row.
  Spectrum alongCut(double row) const { return cut(columns_, row); }

 private:
  Spectrum cut(const std::vector<Spectrum>& lines, double position) const {
    const auto strongest = std::max_element(lines.begin(), lines.end(),
                                            [](const Spectrum& a, const Spectrum& b) { return energy(a) < energy(b); });
    const std::size_t gap = spectralGap(*strongest);
    Spectrum result(size_);
    for (int i = 0; i < size_; ++i) result[i] = valueAt(lines[i], gap, position);
    return result;
  }
  int size_;
  std::vector<Spectrum> rows_, columns_;  // spectra
};

}  // namespace

PointTargetMeasures measurePointTarget(const Image& image, const Eigen::Vector3d& truth, const ChipOptions& options) {
  PointTargetMeasures measures;
  const ImageGrid& grid = image.grid;
  const int size = 2 * options.half_size;
  const Pixel peak = brightest(image, truth, options.search_radius),
              first{peak.row - options.half_size, peak.column - options.half_size};
  measures.complete =
      first.row >= 0 && first.column >= 0 && first.row + size <= grid.rows && first.column + size <= grid.columns;
  if (!measures.complete) return measures;
  const Chip chip(image, first, size);
  double row = options.half_size, column = options.half_size;
  for (int i = 0; i < 4; ++i) {  // each cut moves the other to the peak
    measures.range = measureCut(chip.rangeCut(column), grid.range_step);
    row = measures.range.peak_position / grid.range_step;
    measures.along = measureCut(chip.alongCut(row), grid.along_step);
    column = measures.along.peak_position / grid.along_step;
  }
  measures.peak_position = grid.point(first.row + row, first.column + column);
  const Eigen::Vector3d error = measures.peak_position - truth;
  measures.peak_error = std::hypot(error.dot(grid.range_axis), error.dot(grid.along_axis));
  measures.peak_loss =
      10 * std::log10(options.reference_power / std::max(measures.range.peak_power, measures.along.peak_power));
  return measures;
}

double wholeImageIslr(const Image& image, const PointTargetMeasures& target) {
  const ImageGrid& grid = image.grid;
  double inside = 0, all = 0;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const double power = std::norm(std::complex<double>(image.at(row, column)));
      const Eigen::Vector3d way = grid.point(row, column) - target.peak_position;
      all += power;
      if (std::abs(way.dot(grid.range_axis)) <= target.range.main_lobe / 2 &&
          std::abs(way.dot(grid.along_axis)) <= target.along.main_lobe / 2)
        inside += power;
    }
  return 10 * std::log10((all - inside) / inside);
}

double imageEntropy(const Image& image) {
  double sum = 0, weighted = 0;  // -sum p ln p = ln S - (sum P ln P) / S
  for (const auto& pixel : image.pixels) {
    const double power = std::norm(std::complex<double>(pixel));
    if (!(power > 0)) continue;
    sum += power;
    weighted += power * std::log(power);
  }
  return sum > 0 ? std::log(sum) - weighted / sum : 0;
}

}  // namespace sas_motion::imaging

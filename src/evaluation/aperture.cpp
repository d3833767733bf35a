// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/evaluation/aperture.hpp"

#include <cmath>

namespace sas_motion {
namespace {

/// Sum of squares of y[begin, end) about its least-squares line over t.
double squaresAboutLine(const std::vector<double>& t, const std::vector<double>& y, std::size_t begin,
                        std::size_t end) {
  const auto n = static_cast<double>(end - begin);
  double t_mean = 0, y_mean = 0, tt = 0, ty = 0, yy = 0;
  for (std::size_t i = begin; i < end; ++i) {
    t_mean += (t[i] - t[begin]) / n;
    y_mean += y[i] / n;
  }
  for (std::size_t i = begin; i < end; ++i) {
    const double dt = t[i] - t[begin] - t_mean, dy = y[i] - y_mean;
    tt += dt * dt;
    ty += dt * dy;
    yy += dy * dy;
  }
  return tt > 0 ? std::max(0.0, yy - ty * ty / tt) : yy;
}

}  // namespace

ApertureError apertureError(const std::vector<double>& time, const std::vector<double>& along,
                            const std::vector<double>& across, double speed, const ApertureOptions& options) {
  ApertureError result;
  result.wavelength = options.wavelength;
  if (!(speed > 1e-3)) return result;
  result.time = options.range * options.wavelength / (options.element * speed);
  double along_squares = 0, across_squares = 0;
  std::size_t samples = 0;
  for (std::size_t begin = 0, end = 0; begin < time.size(); begin = end) {
    while (end < time.size() && time[end] < time[begin] + result.time) ++end;
    if (end == time.size() || end - begin < 4) continue;  // the last, cut window, and windows too short for a line
    along_squares += squaresAboutLine(time, along, begin, end);
    across_squares += squaresAboutLine(time, across, begin, end);
    samples += end - begin;
    ++result.windows;
  }
  if (samples > 0) {
    result.along = std::sqrt(along_squares / static_cast<double>(samples));
    result.across = std::sqrt(across_squares / static_cast<double>(samples));
  }
  return result;
}

}  // namespace sas_motion

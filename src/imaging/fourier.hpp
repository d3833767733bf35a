// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <complex>
#include <kissfft/kissfft.hh>
#include <vector>

namespace sas_motion::imaging {

using Spectrum = std::vector<std::complex<double>>;

/// The smallest length of at least n with factors 2, 3 and 5 only.
inline std::size_t fastLength(std::size_t n) {
  for (;; ++n) {
    std::size_t rest = n;
    for (const std::size_t factor : {2, 3, 5})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) return n;
  }
}

/// Discrete Fourier transforms of one length n: X_k = sum x_i exp(-j 2 pi i k / n); the inverse divides by n.
/// For one thread at a time.
class Fourier {
 public:
  explicit Fourier(std::size_t n) : n_(n), forward_(n, false), inverse_(n, true), scratch_(n) {}
  std::size_t size() const { return n_; }

  void forward(Spectrum& x) {
    forward_.transform(x.data(), scratch_.data());
    x.swap(scratch_);
  }
  void inverse(Spectrum& x) {
    inverse_.transform(x.data(), scratch_.data());
    x.swap(scratch_);
    for (auto& value : x) value /= static_cast<double>(n_);
  }
  /// Frequency of bin k in cycles a sample, in [-1/2, 1/2).
  double frequency(std::size_t k) const {
    return (static_cast<double>(k) - (2 * k >= n_ ? static_cast<double>(n_) : 0.0)) / static_cast<double>(n_);
  }

 private:
  std::size_t n_;
  kissfft<double> forward_, inverse_;
  Spectrum scratch_;
};

/// The bin in the middle of a spectrum's gap: opposite to the circular centre of its energy.
std::size_t spectralGap(const Spectrum& spectrum);

/// A periodic line `factor` times as dense, by zeros in the gap of its spectrum; the carrier is removed.
Spectrum oversample(const Spectrum& line, int factor);

/// A periodic line at this position [samples]; the carrier is removed. Lines that are compared need the same gap.
std::complex<double> valueAt(const Spectrum& spectrum, std::size_t gap, double position);

}  // namespace sas_motion::imaging

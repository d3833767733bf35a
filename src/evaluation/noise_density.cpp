// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/noise_density.hpp"

#include <algorithm>
#include <cmath>

#include "sas_motion/math/angles.hpp"

namespace sas_motion {
namespace {

constexpr double kStep =
    0.01;  // of the quadratures, in the asinh or logarithm of the variable: trapezoids converge exponentially there
constexpr double kNothing = 1e-200;  // density below which nothing is left to count

/// exp(z^2) erfc(z) for z >= 0.
double scaledErfc(double z) {
  if (z < 20) return std::exp(z * z) * std::erfc(z);
  const double w = 1 / (2 * z * z);
  return (1 - w * (1 - 3 * w * (1 - 5 * w))) / (z * std::sqrt(kPi));
}

/// Where the log-density nu / 2 (u - e^u + 1) of u = log lambda has fallen to e^-45, on the side that `direction` says.
double edge(double nu, double direction) {
  double u = 0;
  for (double stride = 64; stride > 1e-6; stride /= 2)
    while (0.5 * nu * (u + direction * stride - std::expm1(u + direction * stride)) > -45 && std::abs(u) < 60)
      u += direction * stride;
  return u;
}

}  // namespace

void NoiseDensity::scale(double sigma) {
  for (auto& part : parts_) {
    part.variance *= sigma * sigma;
    part.mean *= sigma;
  }
}

void NoiseDensity::contaminate(double epsilon, double K) {
  NoiseDensity bad = *this;
  bad.scale(K);
  for (auto& part : parts_) part.probability *= 1 - epsilon;
  for (auto& part : bad.parts_) part.probability *= epsilon;
  parts_.insert(parts_.end(), bad.parts_.begin(), bad.parts_.end());
}

void NoiseDensity::studentise(double nu) {
  constexpr int kNodes = 200;
  const double low = edge(nu, -1), high = edge(nu, 1);
  std::vector<double> u, weight;
  double total = 0;
  for (int i = 0; i < kNodes; ++i) {
    u.push_back(low + (high - low) * i / (kNodes - 1));
    weight.push_back(std::exp(0.5 * nu * (u.back() - std::expm1(u.back()))));
    total += weight.back();
  }
  std::vector<Part> parts;
  for (int i = 0; i < kNodes; ++i)
    for (const auto& part : parts_) {
      const double wide = std::exp(-u[static_cast<std::size_t>(i)]);
      parts.push_back({part.variance * wide, part.probability * weight[static_cast<std::size_t>(i)] / total,
                       part.mean * std::sqrt(wide)});
    }
  parts_ = parts;
}

bool NoiseDensity::delay(double probability, double mean) {
  const auto before = parts_;
  for (const auto& part : before)
    if (part.mean > 0) return false;
  for (auto& part : parts_) part.probability *= 1 - probability;
  for (const auto& part : before) parts_.push_back({part.variance, probability * part.probability, mean});
  return true;
}

double NoiseDensity::widest() const {
  double sigma = 0;
  for (const auto& part : parts_)
    if (part.probability > 1e-16) sigma = std::max(sigma, std::sqrt(part.variance) + part.mean);
  return sigma;
}

NoiseDensity::Value NoiseDensity::at(double x) const {
  Value sum;
  for (const auto& [v, probability, m] : parts_) {
    const double s = std::sqrt(v), phi = std::exp(-0.5 * x * x / v) / (s * std::sqrt(2 * kPi));
    double f = phi, slope = -x / v * phi, below = 0.5 * std::erfc(-x / (s * std::sqrt(2.0))),
           above = 0.5 * std::erfc(x / (s * std::sqrt(2.0)));
    if (m > 0) {  // a Gaussian and an exponential
      const double z = (s / m - x / s) / std::sqrt(2.0);
      f = z < 0 ? std::exp(0.5 * v / (m * m) - x / m) * std::erfc(z) / (2 * m)
                : std::exp(-0.5 * x * x / v) * scaledErfc(z) / (2 * m);
      slope = (phi - f) / m;
      below -= m * f;
      above += m * f;
    }
    sum.f += probability * f;
    sum.slope += probability * slope;
    sum.below += probability * below;
    sum.above += probability * above;
  }
  return sum;
}

double NoiseDensity::information(double quantum) const {
  const double end = std::asinh(40 * widest() + quantum);
  double sum = 0;
  for (double t = -end; t <= end; t += kStep) {
    const double x = std::sinh(t);
    const Value here = at(x);
    double integrand = here.f > kNothing ? here.slope * here.slope / here.f : 0;
    if (quantum > 0) {
      const Value there = at(x + quantum);
      const double inside = x + 0.5 * quantum > 0 ? here.above - there.above : there.below - here.below,
                   change = there.f - here.f;
      integrand = inside > kNothing ? change * change / inside / quantum : 0;
    }
    sum += integrand * std::cosh(t) * kStep;
  }
  return sum;
}

double NoiseDensity::radialInformation(int n) const {
  const double end = std::log(40 * widest() + 10 * std::sqrt(n)),
               constant = 2 / (std::pow(2.0, 0.5 * n) * std::tgamma(0.5 * n));
  double sum = 0;
  for (double t = -40; t <= end; t += kStep) {
    const double square = std::exp(2 * t);
    double density = 0, score = 0;  // both times r^n
    for (const auto& part : parts_) {
      const double f =
          part.probability * std::exp(0.5 * n * (2 * t - std::log(part.variance)) - 0.5 * square / part.variance);
      density += f;
      score += f / part.variance;
    }
    if (density > kNothing) sum += constant * score * score / density * square * kStep;
  }
  return sum / n;
}

}  // namespace sas_motion

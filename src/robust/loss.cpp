// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/robust/loss.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sas_motion {

Loss::Loss(LossKind kind, double tuning) : kind_(kind), tuning_(tuning) {
  if (!(tuning > 0) || !std::isfinite(tuning))
    throw std::invalid_argument(
        fmt::format("the tuning of loss {} is {} but must be positive and finite", lossName(kind), tuning));
}

double Loss::rho(double residual) const {
  const double c = tuning_, c2 = c * c, r = std::abs(residual), r2 = r * r, u = r2 / c2;
  switch (kind_) {
    case LossKind::L2: return 0.5 * r2;
    case LossKind::Huber: return r <= c ? 0.5 * r2 : c * r - 0.5 * c2;
    case LossKind::PseudoHuber: return r2 / (1 + std::sqrt(1 + u));
    case LossKind::Cauchy: return 0.5 * c2 * std::log1p(u);
    case LossKind::Tukey: return r <= c ? r2 * (0.5 - u / 2 + u * u / 6) : c2 / 6;
    case LossKind::GemanMcClure: return 0.5 * r2 / (1 + u);
    case LossKind::Welsch: return -0.5 * c2 * std::expm1(-u);
    case LossKind::Dcs:
      return r2 <= c ? 0.5 * r2 : c * (1.5 * r2 - 0.5 * c) / (c + r2);  // (Phi = c) [Agarwal2013, MacTavish2015]
  }
  return 0;
}

double Loss::weight(double residual) const {
  const double c = tuning_, r = std::abs(residual), r2 = r * r, u = r2 / (c * c);
  switch (kind_) {
    case LossKind::L2: return 1;
    case LossKind::Huber: return r <= c ? 1 : c / r;
    case LossKind::PseudoHuber: return 1 / std::sqrt(1 + u);
    case LossKind::Cauchy: return 1 / (1 + u);
    case LossKind::Tukey: return r <= c ? (1 - u) * (1 - u) : 0;
    case LossKind::GemanMcClure: return 1 / ((1 + u) * (1 + u));
    case LossKind::Welsch: return std::exp(-u);
    case LossKind::Dcs: return r2 <= c ? 1 : 4 * c * c / ((c + r2) * (c + r2));
  }
  return 1;
}

double Loss::slope(double residual) const {
  const double c = tuning_, r = std::abs(residual), r2 = r * r, u = r2 / (c * c), w = weight(r);
  switch (kind_) {
    case LossKind::L2: return 1;
    case LossKind::Huber: return r <= c ? 1 : 0;
    case LossKind::PseudoHuber: return w * w * w;
    case LossKind::Cauchy: return (1 - u) * w * w;
    case LossKind::Tukey: return r <= c ? (1 - u) * (1 - 5 * u) : 0;
    case LossKind::GemanMcClure: return (1 - 3 * u) / (1 + u) * w;
    case LossKind::Welsch: return (1 - 2 * u) * w;
    case LossKind::Dcs: return r2 <= c ? 1 : (c - 3 * r2) / (c + r2) * w;
  }
  return 1;
}

double Loss::defaultTuning(LossKind kind) {
  switch (kind) {
    case LossKind::L2: return 1;
    case LossKind::Huber:
    case LossKind::PseudoHuber: return 1.345;
    case LossKind::Cauchy: return 2.3849;
    case LossKind::Tukey: return 4.6851;
    case LossKind::GemanMcClure: return 3.6;
    case LossKind::Welsch: return 2.9846;
    case LossKind::Dcs: return 3.0;
  }
  return 1;
}

bool Loss::redescending(LossKind kind) {
  return kind != LossKind::L2 && kind != LossKind::Huber && kind != LossKind::PseudoHuber;
}

const std::vector<std::string>& lossNames() {
  static const std::vector<std::string> names{"l2",    "huber",         "pseudo_huber", "cauchy",
                                              "tukey", "geman_mcclure", "welsch",       "dcs"};
  return names;
}

LossKind lossFromName(const std::string& name) {
  const auto& names = lossNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw std::invalid_argument(fmt::format("'{}' is no loss; choose one of {}", name, fmt::join(names, ", ")));
  return static_cast<LossKind>(found - names.begin());
}

const std::string& lossName(LossKind kind) { return lossNames()[static_cast<std::size_t>(kind)]; }

}  // namespace sas_motion

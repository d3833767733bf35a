// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace sas_motion {

/// The influence of a whitened residual r on a robust estimate: psi(r), its slope, and the weight psi / r in [0, 1].
struct Influence {
  double psi, slope, weight;
};

enum class LossKind { L2, Huber, PseudoHuber, Cauchy, Tukey, GemanMcClure, Welsch, Dcs };

/// A loss rho(r) of a whitened residual r (unit variance for good data), as M-estimation uses it [Huber1981,
/// Zhang1997].
///
/// A loss is scaled so that rho(r) = r^2 / 2 and weight(r) = 1 near r = 0. The tuning c has the unit of r (for dcs, of
/// r^2); the customary values (95 % efficiency on Gaussian data for most) are the defaults. As c grows every loss
/// becomes L2.
class Loss {
 public:
  /// Throws std::invalid_argument where `tuning` is not positive and finite.
  Loss(LossKind kind, double tuning);
  explicit Loss(LossKind kind) : Loss(kind, defaultTuning(kind)) {}

  double rho(double residual) const;
  /// psi(r) / r with psi = rho', in [0, 1]; 1 at r = 0.
  double weight(double residual) const;
  /// psi'(r), at most 1. At the bend of huber and dcs it is the limit from the inside.
  double slope(double residual) const;
  /// True where rho is not convex, so that an iteration's answer depends on its start.
  bool redescending() const { return redescending(kind_); }

  LossKind kind() const { return kind_; }
  double tuning() const { return tuning_; }

  static double defaultTuning(LossKind kind);
  static bool redescending(LossKind kind);

 private:
  LossKind kind_;
  double tuning_;
};

/// The names a configuration uses: l2, huber, pseudo_huber, cauchy, tukey, geman_mcclure, welsch, dcs.
const std::vector<std::string>& lossNames();
/// Throws std::invalid_argument that lists the names where `name` is none of them.
LossKind lossFromName(const std::string& name);
const std::string& lossName(LossKind kind);

}  // namespace sas_motion

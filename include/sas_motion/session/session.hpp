// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sas_motion/estimate/output.hpp"
#include "sas_motion/robust/loss.hpp"

namespace sas_motion {

/// Where answers are given: the map, once its datum is known, and the base on the body.
struct OutputFrame {
  std::optional<LocalFrame> map;
  Vector<3> base_lever_body = Vector<3>::Zero();  ///< from the point that the estimators are of [m]
};

/// A state that a user sets, in the axes of a message: x, y in the map [m], the current's x, y [m/s], yaw
/// counter-clockwise from x [rad], speed through the water [m/s].
struct StateRequest {
  Stamp stamp = 0;  ///< 0: that of the newest answer
  Vector<6> state = Vector<6>::Zero();
  Matrix<6> covariance = Matrix<6>::Identity();
};

/// What may be changed while estimators run, for measurements that come from then on.
struct Tuning {
  Loss robust_kf{LossKind::Huber};
  Loss fixed_lag{LossKind::Huber};
  double gated_kf_probability = 0.99;
};

/// The tuning that a system's configuration has.
template <class Config>
Tuning tuningOf(const Config& config) {
  return {config.filters.robust_kf.loss, config.fixed_lag.loss, config.filters.gated_kf.probability};
}

/// Puts a tuning into a system's configuration.
template <class Config>
void tune(Config& config, const Tuning& tuning) {
  config.filters.robust_kf.loss = tuning.robust_kf;
  config.fixed_lag.loss = tuning.fixed_lag;
  config.filters.gated_kf.probability = tuning.gated_kf_probability;
}

/// What became of one estimator of a session.
struct LaneReport {
  std::uint64_t measurements = 0;  ///< that it was given
  double seconds = 0;              ///< CPU time of the estimator alone
  std::string failure;             ///< why a smoother has no answer, in plain words; empty where all is well
};

/// The estimators of one system, side by side, over readings that come in any order inside the lag, live or from a bag
/// alike. What has settled depends on the readings alone and not on their order; the present answer is the best one
/// now. Readings go in by the function `process` of the system's own session. Data never throws.
class Session {
 public:
  explicit Session(std::vector<std::string> names) : names_(std::move(names)) {}
  virtual ~Session() = default;
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// The estimators' names, by lane.
  const std::vector<std::string>& names() const { return names_; }

  /// Runs the estimators over the readings that were taken since; few of them live, many at once from a bag.
  virtual void feed() = 0;
  virtual std::size_t unfed() const = 0;
  /// The end of the data, or a pause: settles everything that is still open.
  virtual void finish() = 0;
  /// Forgets everything.
  virtual void reset() = 0;

  /// Moves what has settled in a lane to `output`.
  virtual void takeSettled(std::size_t lane, const OutputFrame& frame, Output& output) = 0;
  /// The newest answer, or nothing before the start or where the estimator keeps none.
  virtual std::optional<Solution> current(std::size_t lane, const OutputFrame& frame) const = 0;
  /// The answer at any stamp inside the lag or a little ahead, or nothing.
  virtual std::optional<Solution> at(std::size_t lane, const OutputFrame& frame, Stamp stamp) const = 0;
  /// Sets the state of one estimator: what was measured after the stamp is fused again. Returns why not, or nothing.
  virtual std::string setState(std::size_t lane, const OutputFrame& frame, const StateRequest& request) = 0;
  virtual void configure(const Tuning& tuning) = 0;
  virtual LaneReport report(std::size_t lane) const = 0;
  /// Whether the estimators' positions are of the map, so that a new datum starts them anew.
  virtual bool positionsAreOfMap() const = 0;

 private:
  std::vector<std::string> names_;
};

}  // namespace sas_motion

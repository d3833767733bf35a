// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sas_motion/estimate/output.hpp"
#include "sas_motion/estimate/smoother_options.hpp"
#include "sas_motion/filters/filter_by_name.hpp"
#include "sas_motion/systems/ins_gps_dvl/navigator.hpp"

namespace sas_motion::ins {

/// A smoother over a sliding window.
struct FixedLag {
  Loss loss{LossKind::Huber};
  double lag = 60;            ///< the window's length [s]
  double solve_interval = 5;  ///< between two solutions [s]
};

/// The settings of every estimator of this system.
struct Config {
  Parameters parameters;
  Mechanisation::Options imu;
  FilterOptions filters;
  SmootherOptions batch{Loss(LossKind::Huber), 100, 1e-7};
  FixedLag fixed_lag;
};

/// Where and how the body is at a stamp.
struct NavigationSolution {
  Stamp stamp = 0;
  NavigationState state;
  bool has_velocity = true;
  bool has_attitude = true;
  std::optional<Matrix<9>>
      covariance;  ///< of velocity, position and attitude errors [m/s, m, rad], where the solution has one
  std::optional<Vector<3>> rate_body =
      std::nullopt;  ///< of the body over the ground [rad/s], where the solution has one
};

/// The same solution of another point of the body, at a lever arm from the one it is of [m].
NavigationSolution movedBy(const NavigationSolution& solution, const Vector<3>& lever_body);

using Output = OutputOf<NavigationSolution>;  ///< solutions at the stamps of the IMU

/// One estimator fed with readings as they come.
class Estimator {
 public:
  virtual ~Estimator() = default;

  /// Begins at a stamp with a state, and forgets everything before.
  virtual void start(const NavigationState& state, Stamp stamp) = 0;
  /// Takes one reading of a sensor that aids. Data never throws.
  virtual void process(const Aiding& reading, Output& output) = 0;
  /// Takes one reading of the IMU, and returns what became of it.
  virtual ImuVerdict process(const ImuReading& reading, Output& output) = 0;
  /// The end of the data, or a pause: settles everything that is still open.
  virtual void finish(Output&) {}
  /// Other losses, for readings that come from now on.
  virtual void configure(const Config&) {}
  /// How often a smoother has corrected its present; a filter never does.
  virtual std::uint64_t corrections() const { return 0; }
  /// Why the last finish() has no answer, in plain words; empty where all is well.
  virtual std::string failure() const { return ""; }
  /// Another that goes on from here; null where the estimator keeps no present state.
  virtual std::unique_ptr<Estimator> clone() const { return nullptr; }
};

/// Makes one of estimatorNames(); null for any other name. For each filter FILTER of 27 states, e.g. kf or robust_kf:
/// FILTER27 is the fused solution, gnss_FILTER27 and dvl_FILTER27 are that sensor less its estimated errors, and
/// steady_FILTER27 is a track for imaging. open_loop_kf27 does not correct the INS. ins, gnss_alone and dvl are the
/// sensors alone.
std::unique_ptr<Estimator> makeEstimator(const std::string& name, const Config& config);

/// The names that makeEstimator accepts.
const std::vector<std::string>& estimatorNames();

using EstimatorFactory = std::function<std::unique_ptr<Estimator>(const std::string&, const Config&)>;

}  // namespace sas_motion::ins

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "sas_motion/estimate/audit.hpp"
#include "sas_motion/filters/kalman_filter.hpp"
#include "sas_motion/filters/robust_kalman_filter.hpp"
#include "sas_motion/navigation/bridged_gap.hpp"
#include "sas_motion/navigation/steady_track.hpp"
#include "sas_motion/systems/ins_gps_dvl/model.hpp"

namespace sas_motion::ins {

/// Fuses nothing: gives each sensor's own answer.
struct Unaided {
  Gaussian<kStates> predict(const Gaussian<kStates>& belief, const Transition<kStates>&) const { return belief; }
  template <int M>
  Update<Gaussian<kStates>, M> update(const Gaussian<kStates>& prior, const LinearMeasurement<kStates, M>& z) const;
};

/// The audit of a reading that was not fused.
inline Audit refusal(const Aiding& reading, Verdict verdict, std::string_view reason) {
  return sas_motion::refusal(reading.stamp, sensorName(reading.sensor), rowsOf(reading.sensor), verdict, reason);
}

struct NavigatorOptions {
  bool feedback = true;
  double step = 0.2;  ///< longest time of one prediction of the filter [s]
  SteadyTrack::Options steady;
  Mechanisation::Options imu;
  BridgedGap bridge;
};

/// The variance by a part of a gap of the IMU in the model's units, see BridgedGap.
Errors gapVariance(const BridgedGap& bridge, double gap, double part);

/// Mechanises the IMU, estimates its errors and those of GPS and DVL with a filter, and takes them out: of
/// the INS itself (feedback) or of its output (open loop). (C.4)
///
/// Readings that aid are held until the IMU has come to their stamp; those before its last stamp are stale.
template <class Filter>
class Navigator {
 public:
  using Options = NavigatorOptions;

  Navigator(const Filter& filter, const Parameters& parameters, const NavigationState& start, Stamp stamp,
            const Options& options);

  /// Another tuning of the filter, from now on.
  void use(const Filter& filter) { filter_ = filter; }
  void add(const Aiding& reading) { waiting_.push_back(reading); }
  /// Returns what became of the reading; audits() then are those of what it let be fused.
  ImuStep add(const ImuReading& reading);
  const std::vector<Audit>& audits() const { return audits_; }

  Stamp stamp() const { return ins_.stamp(); }
  NavigationState fused() const { return corrected(ins_.state(), belief_.mean, model_.unit()); }
  /// Of the body over the ground; body [rad/s].
  Vector<3> rate_body() const { return rateOverGround(ins_.state(), ins_.rate_body()); }
  /// The position of the INS by the fix that the last reading of the IMU let be fused, at the fix's own stamp; nothing
  /// where there was none. Its estimated errors are taken out; the attitude is the fused one.
  struct Fix {
    Stamp stamp = 0;
    NavigationState state;
  };
  const std::optional<Fix>& gps() const { return gps_; }
  /// The position by dead reckoning with the DVL, likewise.
  NavigationState dvl() const;
  /// For imaging: without the jumps of readings.
  NavigationState steady() const { return steady_.state(); }
  const Gaussian<kStates>& belief() const { return belief_; }  ///< errors of the INS as it stands
  const ErrorModel& model() const { return model_; }

 private:
  void advance(const ImuReading& reading, Stamp stamp);
  void predict();
  void fuse(const Aiding& reading);
  void widenForGap(double part);
  void feedBack();

  Filter filter_;
  ErrorModel model_;
  Options options_;
  Mechanisation ins_;
  Gaussian<kStates> belief_;
  std::deque<Aiding> waiting_;
  std::vector<Audit> audits_;
  // Sums over the time that the filter has not predicted yet.
  double since_ = 0;
  double gap_ = 0;  // of the reading that is integrated, where it bridges one [s]
  Vector<3> force_sum_ = Vector<3>::Zero(), velocity_sum_ = Vector<3>::Zero();
  Matrix<3> C_sum_ = Matrix<3>::Zero();
  NavigationState reckoned_;  // by the DVL, with its errors
  SteadyTrack steady_;
  std::optional<Vector<3>> velocity_body_;  // of the INS, by the DVL's last reading
  std::optional<Fix> gps_;
};

using Kf27 = Navigator<KalmanFilter<kStates>>;
using RobustKf27 = Navigator<RobustKalmanFilter<kStates>>;

}  // namespace sas_motion::ins

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/pipeline/estimator.hpp"

#include <algorithm>
#include <cmath>

#include "sas_motion/filters/reacquiring_filter.hpp"
#include "sas_motion/pipeline/filter_timeline.hpp"
#include "sas_motion/pipeline/smoother_recorder.hpp"
#include "sas_motion/smoothers/rts.hpp"

namespace sas_motion::towfish {
namespace {

template <class Filter>
std::unique_ptr<Estimator> timeline(const Filter& filter, const Config& config) {
  return std::make_unique<FilterTimeline<Filter>>(filter, config);
}

/// A filter that may disbelieve measurements, and so must be able to come back.
template <class Filter>
std::unique_ptr<Estimator> reacquiring(const Filter& filter, const Config& config) {
  return timeline(ReacquiringFilter<Filter, kStates>(filter, config.reset_after), config);
}

const std::string kRobustPrefix = "robust_kf_";

/// robust_kf with another loss at its customary tuning; null where there is no such loss.
std::unique_ptr<Estimator> robustWithLoss(const std::string& loss, const Config& config) {
  const auto& names = lossNames();
  if (std::find(names.begin(), names.end(), loss) == names.end()) return nullptr;
  auto options = config.robust_kf;
  options.loss = Loss(lossFromName(loss));
  return reacquiring(RobustKalmanFilter<kStates>(options), config);
}

}  // namespace

std::unique_ptr<Estimator> makeEstimator(const std::string& name, const Config& config) {
  if (name == "kf") return timeline(KalmanFilter<kStates>(), config);
  if (name == "gated_kf") return reacquiring(GatedKalmanFilter<kStates>(config.gated_kf), config);
  if (name == "robust_kf") return reacquiring(RobustKalmanFilter<kStates>(config.robust_kf), config);
  if (name == "mckf") return reacquiring(RobustKalmanFilter<kStates>(config.mckf), config);
  if (name == "mixture_kf") return reacquiring(MixtureKalmanFilter<kStates>(config.mixture_kf), config);
  if (name == "student_t_kf") return reacquiring(StudentTKalmanFilter<kStates>(config.student_t_kf), config);
  if (name.rfind(kRobustPrefix, 0) == 0) return robustWithLoss(name.substr(kRobustPrefix.size()), config);
  if (name == "rts")
    return std::make_unique<SmootherRecorder>(config, [options = config.rts](const SmoothingProblem& problem) { return smoothRts(problem, options); });
  return nullptr;
}

const char* invalidity(const Measurement& z, const Config& config) {
  if (z.stamp <= 0) return "no stamp";
  if (!z.value.allFinite() || !z.lever_arm_body.allFinite()) return "not finite";
  for (int row = 0; row < rowsOf(z.sensor); ++row)
    if (!(z.variance(row) > 1e-30) || !(z.variance(row) < 1e12)) return "no usable covariance";
  if (z.sensor == Sensor::Position && z.value.norm() > 1e6) return "more than 1000 km from the datum";
  if (z.sensor == Sensor::Speed && std::abs(z.value(0)) > 100) return "faster than 100 m/s";
  if (z.sensor == Sensor::TurnRate && std::abs(z.value(0)) > config.turn_rate_limit) return "turn rate beyond its limit";
  return nullptr;
}

Audit refusal(const Measurement& z, Verdict verdict, const char* reason) {
  Audit audit;
  audit.stamp = z.stamp;
  audit.sensor = z.sensor;
  audit.rows = rowsOf(z.sensor);
  audit.verdict = verdict;
  audit.reason = reason;
  if (verdict != Verdict::Accepted) audit.weights.setZero();
  return audit;
}

}  // namespace sas_motion::towfish

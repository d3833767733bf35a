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

/// `make` builds the filter from a configuration: once here, and again for other settings.
template <class Make>
std::unique_ptr<Estimator> timeline(const Make& make, const Config& config) {
  return std::make_unique<FilterTimeline<decltype(make(config))>>(make, config);
}

/// A filter that may disbelieve measurements, and so must be able to come back.
template <class Make>
std::unique_ptr<Estimator> reacquiring(const Make& make, const Config& config) {
  return timeline([make](const Config& c) { return ReacquiringFilter<decltype(make(c)), kStates>(make(c), c.reset_after); }, config);
}

const std::string kRobustPrefix = "robust_kf_";

/// robust_kf with another loss at its customary tuning; null where there is no such loss.
std::unique_ptr<Estimator> robustWithLoss(const std::string& loss, const Config& config) {
  const auto& names = lossNames();
  if (std::find(names.begin(), names.end(), loss) == names.end()) return nullptr;
  const auto make = [kind = lossFromName(loss)](const Config& c) {
    auto options = c.robust_kf;
    options.loss = Loss(kind);
    return RobustKalmanFilter<kStates>(options);
  };
  return reacquiring(make, config);
}

}  // namespace

std::unique_ptr<Estimator> makeEstimator(const std::string& name, const Config& config) {
  if (name == "kf") return timeline([](const Config&) { return KalmanFilter<kStates>(); }, config);
  if (name == "gated_kf") return reacquiring([](const Config& c) { return GatedKalmanFilter<kStates>(c.gated_kf); }, config);
  if (name == "robust_kf") return reacquiring([](const Config& c) { return RobustKalmanFilter<kStates>(c.robust_kf); }, config);
  if (name == "mckf") return reacquiring([](const Config& c) { return RobustKalmanFilter<kStates>(c.mckf); }, config);
  if (name == "mixture_kf") return reacquiring([](const Config& c) { return MixtureKalmanFilter<kStates>(c.mixture_kf); }, config);
  if (name == "student_t_kf") return reacquiring([](const Config& c) { return StudentTKalmanFilter<kStates>(c.student_t_kf); }, config);
  if (name.rfind(kRobustPrefix, 0) == 0) return robustWithLoss(name.substr(kRobustPrefix.size()), config);
  if (name == "rts")
    return std::make_unique<SmootherRecorder>(config, [options = config.rts](const SmoothingProblem& problem) { return smoothRts(problem, options); });
  return nullptr;
}

const char* Estimator::setState(const Estimate&, Output&) { return "it keeps no present state"; }

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

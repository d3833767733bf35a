// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the tests of the pipeline share: feeding an estimator and comparing what it puts out.
#pragma once

#include "sas_motion/systems/towfish/estimator.hpp"
#include "support.hpp"

namespace sas_motion::testing {

inline const std::vector<std::string>& filterNames() {
  static const std::vector<std::string> names{"kf",   "gated_kf",   "robust_kf", "student_t_kf",
                                              "mckf", "mixture_kf", "bank_kf",   "robust_kf_tukey"};
  return names;
}

using TowfishTimeline = Timeline<towfish::Estimator>;

/// An estimator over measurements in any order.
inline std::unique_ptr<TowfishTimeline> timelineOf(std::unique_ptr<towfish::Estimator> estimator,
                                                   const towfish::Config& config) {
  return std::make_unique<TowfishTimeline>(std::move(estimator), config, config.max_gap);
}
inline std::unique_ptr<TowfishTimeline> timelineOf(const std::string& name, const towfish::Config& config) {
  return timelineOf(towfish::makeEstimator(name, config), config);
}

/// All that an estimator puts out for measurements in this order.
inline towfish::Output feed(TowfishTimeline& timeline, const std::vector<towfish::Measurement>& measurements) {
  towfish::Output output;
  for (const auto& z : measurements) timeline.process(z, output);
  timeline.finish(output);
  return output;
}

inline towfish::Output feed(const std::string& name, const towfish::Config& config,
                            const std::vector<towfish::Measurement>& measurements) {
  return feed(*timelineOf(name, config), measurements);
}

inline std::size_t count(const towfish::Output& output, Verdict verdict) {
  return static_cast<std::size_t>(std::count_if(output.audits.begin(), output.audits.end(),
                                                [&](const auto& audit) { return audit.verdict == verdict; }));
}

/// Equal to the last bit.
inline void expectSameEstimates(const towfish::Output& a, const towfish::Output& b, const std::string& what) {
  ASSERT_EQ(a.solutions.size(), b.solutions.size()) << what;
  for (std::size_t i = 0; i < a.solutions.size(); ++i) {
    ASSERT_EQ(a.solutions[i].stamp, b.solutions[i].stamp) << what << ", estimate " << i;
    ASSERT_EQ(a.solutions[i].belief.mean, b.solutions[i].belief.mean) << what << ", estimate " << i;
    ASSERT_EQ(a.solutions[i].belief.covariance, b.solutions[i].belief.covariance) << what << ", estimate " << i;
  }
}

inline void expectRisingStamps(const towfish::Output& output) {
  for (std::size_t i = 1; i < output.solutions.size(); ++i)
    ASSERT_GT(output.solutions[i].stamp, output.solutions[i - 1].stamp) << "estimate " << i;
}

inline double positionError(const towfish::Estimate& estimate, const Run& run) {
  return (estimate.belief.mean - run.truthAt(estimate.stamp)).head<2>().norm();
}

}  // namespace sas_motion::testing

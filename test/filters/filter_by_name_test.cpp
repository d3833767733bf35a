// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/filter_by_name.hpp"

#include "support.hpp"

namespace sas_motion {
namespace {

const auto nothing = [](const auto&) {};

TEST(FilterByName, EveryNameMakesAFilter) {
  for (const std::string name : kFilterNames) {
    EXPECT_TRUE(withFilter<2>(name, {}, nothing)) << name;
    EXPECT_TRUE(withFilter<6>(name, {}, nothing)) << name;
    EXPECT_EQ(withFilter<27>(name, {}, nothing), name != "bank_kf" && name != "student_t_kf") << name;
  }
  for (const auto& loss : lossNames()) EXPECT_TRUE(withFilter<6>("robust_kf_" + loss, {}, nothing)) << loss;
  for (const char* name : {"", "kf_", "robust_kf_", "robust_kf_hubert", "ekf"})
    EXPECT_FALSE(withFilter<6>(name, {}, nothing)) << name;
}

TEST(FilterByName, OnlyFiltersThatRejectForEverAreGuarded) {
  static_assert(std::is_same_v<Guarded<KalmanFilter<6>>, KalmanFilter<6>>);
  static_assert(std::is_same_v<Guarded<BankKalmanFilter<6>>, BankKalmanFilter<6>>);
  static_assert(std::is_same_v<Guarded<GatedKalmanFilter<6>>, ReacquiringFilter<GatedKalmanFilter<6>, 6>>);
  using Calibrated = CalibratedFilter<RobustKalmanFilter<6>, 6>;
  static_assert(std::is_same_v<Guarded<RobustKalmanFilter<6>>, ReacquiringFilter<Calibrated, 6>>);
  FilterOptions options;
  options.reset_after = 0;
  EXPECT_NO_THROW(withGuardedFilter<6>("kf", options, nothing));
  EXPECT_THROW(withGuardedFilter<6>("gated_kf", options, nothing), std::invalid_argument);
}

TEST(FilterByName, EveryFilterReadsItsOptions) {
  auto yaml = YamlSection::fromText(
      "{gated_kf: {probability: 0.9}, robust_kf: {loss: cauchy}, student_t_kf: {degrees_of_freedom: 3}, mckf: "
      "{bandwidth: 2}, mixture_kf: {scales: [1, 2, 3, 4]}, bank_kf: {probabilities: [4, 3, 2, 1]}}",
      "test.yaml");
  FilterOptions options;
  readOptions(yaml, options);
  EXPECT_NO_THROW(yaml.finish());
  EXPECT_EQ(options.gated_kf.probability, 0.9);
  EXPECT_EQ(options.robust_kf.loss.tuning(), Loss::defaultTuning(LossKind::Cauchy));
  EXPECT_EQ(options.student_t_kf.degrees_of_freedom, 3);
  EXPECT_EQ(options.mckf.loss.tuning(), 2 * std::sqrt(2.0));
  EXPECT_TRUE(options.mckf.robustify_process);
  EXPECT_EQ(options.mixture_kf.scales[3], 4);
  EXPECT_EQ(options.bank_kf.probabilities[0], 4);
}

}  // namespace
}  // namespace sas_motion

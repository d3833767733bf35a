// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Every filter compiles and links for sizes that the library has not compiled it for.
#include <gtest/gtest.h>

#include "sas_motion/filters/filter_by_name.hpp"
#include "sas_motion/filters/gaussian_sum_filter.hpp"

namespace sas_motion {
namespace {

constexpr int kStates = 4, kRows = 3;

/// Two steps that see the first three states, each read as 1.
template <class Filter, class Belief>
void expectLearns(const Filter& filter, Belief belief) {
  for (int step = 1; step <= 2; ++step) {
    const auto mean = gaussian(belief).mean;
    belief =
        filter.predict(belief, Transition<kStates>{mean, Matrix<kStates>::Identity(), Matrix<kStates>::Identity()});
    LinearMeasurement<kStates, kRows> z;
    z.H.setIdentity();
    z.R.setIdentity();
    z.innovation = Vector<kRows>::Ones() - z.H * gaussian(belief).mean;
    z.time = step;
    const auto update = filter.update(belief, z);
    ASSERT_EQ(update.verdict, Verdict::Accepted);
    belief = update.belief;
  }
  EXPECT_GT(gaussian(belief).mean.template head<kRows>().minCoeff(), 0.5);
  EXPECT_EQ(gaussian(belief).mean(kRows), 0);
}

template <class Filter>
typename Filter::Belief start() {
  const Gaussian<kStates> known{Vector<kStates>::Zero(), Matrix<kStates>::Identity()};
  typename Filter::Belief belief;
  if constexpr (std::is_same_v<typename Filter::Belief, Gaussian<kStates>>)
    return known;
  else if constexpr (std::is_same_v<typename Filter::Belief, BankBelief<kStates>> ||
                     std::is_same_v<typename Filter::Belief, GaussianSum<kStates>>)
    belief.summary = known;
  else if constexpr (std::is_same_v<decltype(belief.state), CalibratedBelief<kStates>>)
    belief.state.state = known;
  else
    belief.state = known;
  return belief;
}

TEST(AnySize, EveryFilterLearnsFourStatesFromThreeRows) {
  for (const char* name : kFilterNames) {
    SCOPED_TRACE(name);
    EXPECT_TRUE(withGuardedFilter<kStates>(name, FilterOptions(), [](const auto& filter) {
      expectLearns(filter, start<std::decay_t<decltype(filter)>>());
    }));
  }
}

TEST(AnySize, GaussianSumFilterLearnsFourStatesFromThreeRows) {
  expectLearns(GaussianSumFilter<kStates>(GaussianSumOptions()), start<GaussianSumFilter<kStates>>());
}

}  // namespace
}  // namespace sas_motion

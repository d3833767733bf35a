// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/parallel/threads.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>

namespace sas_motion {
namespace {

TEST(ThreadTeam, DoesEveryTaskOnceRoundAfterRound) {
  for (const int threads : {0, 1, 2, 5}) {
    ThreadTeam team(threads);
    std::vector<int> done(1000);
    for (int round = 1; round <= 200; ++round) {
      const std::size_t count = round % 3 == 0 ? 0 : done.size();
      team.forEach(count, [&](std::size_t task) { ++done[task]; });
    }
    for (const int times : done) ASSERT_EQ(times, 134) << threads << " threads";
  }
}

TEST(ThreadTeam, HandsOnWhatATaskThrowsAndWorksOn) {
  ThreadTeam team(3);
  EXPECT_THROW(team.forEach(100,
                            [](std::size_t task) {
                              if (task == 7) throw std::runtime_error("seven");
                            }),
               std::runtime_error);
  std::atomic<int> done{0};
  team.forEach(100, [&](std::size_t) { ++done; });
  EXPECT_EQ(done, 100);
}

TEST(ForEachTask, DoesEveryTask) {
  std::vector<int> done(50);
  forEachTask(done.size(), 2, [&](std::size_t task) { done[task] = 1; });
  EXPECT_EQ(std::accumulate(done.begin(), done.end(), 0), 50);
}

}  // namespace
}  // namespace sas_motion

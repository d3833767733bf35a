// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/io/cpu_time.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

namespace sas_motion {
namespace {

TEST(CpuTime, CountsWorkAndNotSleep) {
  const double begin = cpuSeconds();
  volatile double sum = 0;
  while (cpuSeconds() - begin < 0.02) sum = sum + std::sqrt(sum + 1);
  const double worked = cpuSeconds();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_GE(worked - begin, 0.02);
  EXPECT_LT(cpuSeconds() - worked, 0.04);
}

TEST(CpuTime, IsOfTheCallingThread) {
  const double begin = cpuSeconds();
  std::thread([] {
    for (const double start = cpuSeconds(); cpuSeconds() - start < 0.05;) {
    }
  }).join();
  EXPECT_LT(cpuSeconds() - begin, 0.04);
}

}  // namespace
}  // namespace sas_motion

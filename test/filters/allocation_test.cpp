// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Predict and update use no heap. Every allocation of the process goes through the malloc below.
#include <cstdlib>
#include <iostream>

#include "sas_motion/filters/bank_kalman_filter.hpp"
#include "sas_motion/filters/calibrated_filter.hpp"
#include "sas_motion/filters/gated_kalman_filter.hpp"
#include "sas_motion/filters/mixture_kalman_filter.hpp"
#include "sas_motion/filters/particles/particle_filter.hpp"
#include "sas_motion/filters/particles/simplex_blocks.hpp"
#include "sas_motion/filters/particles/unscented_particle_filter.hpp"
#include "sas_motion/filters/reacquiring_filter.hpp"
#include "sas_motion/filters/robust_kalman_filter.hpp"
#include "sas_motion/filters/sigma_point_filter.hpp"
#include "sas_motion/filters/student_t_kalman_filter.hpp"
#include "sas_motion/navigation/mechanisation.hpp"
#include "sas_motion/systems/towfish/model.hpp"
#include "sas_motion/systems/usbl/calibrator.hpp"
#include "sas_motion/systems/usbl/simulator.hpp"
#include "support.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SAS_MOTION_CANNOT_COUNT \
  "the address and the thread sanitizer bring their own malloc, so allocations cannot be counted"
#elif !defined(__GLIBC__)
#define SAS_MOTION_CANNOT_COUNT "the counter stands on glibc's __libc_malloc, which is not here"
#endif

namespace {
thread_local long allocations = 0;
}

#ifndef SAS_MOTION_CANNOT_COUNT
extern "C" void* __libc_malloc(std::size_t);
extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
#endif

namespace sas_motion {
namespace {

using towfish::kStates;

template <class Filter>
void expectNoAllocation(const char* name, const Filter& filter) {
  const towfish::Model model{towfish::MotionParameters()};
  Random random = testing::announced(71);
  typename Filter::Belief belief{};  // zero and the identity
  auto two = testing::randomMeasurement<kStates, 2>(random);
  auto one = testing::randomMeasurement<kStates, 1>(random);
  const long before = allocations;
  for (int i = 0; i < 20; ++i) {
    belief = filter.predict(belief, model.transition(gaussian(belief).mean, {0.01}, 0.1));
    two.innovation(0) = i % 5 == 0 ? 30 : 0.3;  // outliers take other paths
    belief = filter.update(belief, two).belief;
    one.innovation(0) = i % 7 == 0 ? -30 : 0.2;
    belief = filter.update(belief, one).belief;
  }
  EXPECT_EQ(allocations - before, 0) << name;
  EXPECT_TRUE(gaussian(belief).mean.allFinite());
}

template <int Count>
void expectNoAllocation(const char* name, const SigmaPointFilter<kStates, Count>& filter) {
  const towfish::Model model{towfish::MotionParameters()};
  const auto f = [&](const Vector<kStates>& x) { return model.predict(x, {0.01}, 0.1); };
  const auto h = [](const Vector<kStates>& x) -> Vector<2> { return {std::hypot(x(0) - 30, x(1)), x(4)}; };
  Gaussian<kStates> belief;  // zero and the identity
  const Matrix<kStates> Q = 0.01 * Matrix<kStates>::Identity();
  const long before = allocations;
  for (int i = 0; i < 20; ++i) {
    belief = filter.predict(belief, f, Q, towfish::Model::difference).value();
    belief = filter.update(belief, Vector<2>(29, 0.1), h, Matrix<2>(Matrix<2>::Identity())).belief;
  }
  EXPECT_EQ(allocations - before, 0) << name;
  EXPECT_TRUE(belief.mean.allFinite());
}

/// A calibration's filter over the pings of a figure-eight with outliers, without its start.
void expectNoAllocation(const std::string& name, usbl::Mode mode) {
  usbl::Scenario scenario;
  scenario.duration = 40;
  scenario.noise.fill(testing::contaminated(0.2, 30));
  const auto pings = usbl::simulatePings(scenario, 72);
  usbl::Config config;
  config.mode = mode;
  const usbl::CubatureFilter filter(*usbl::filterOptions(name, config));
  const usbl::Model model(mode);
  usbl::CubatureFilter::Belief belief(
      Gaussian<usbl::kStates>{usbl::State::Zero(), config.prior.sigma.head<usbl::kStates>().cwiseAbs2().asDiagonal()});
  const Matrix<usbl::kStates> Q = 1e-12 * Matrix<usbl::kStates>::Identity();
  const auto difference = [&](const Vector<3>& y, const Vector<3>& x) { return model.difference(y, x); };
  const long before = allocations;
  for (const auto& labelled : pings) {
    const usbl::Reading reading = model.convert(labelled.ping.reading);
    Vector<3> z = Vector<3>::Zero(), variance = Vector<3>::Ones(), present = Vector<3>::Zero();
    for (int i = 0; i < 3; ++i)
      if (reading.has(i)) z(i) = reading.value(i), variance(i) = reading.variance(i), present(i) = 1;
    const auto h = [&](const usbl::State& x) { return model.predict(x, labelled.ping); };
    belief = filter.update(filter.predict(belief, Q), z, variance, present, h, difference).belief;
  }
  EXPECT_EQ(allocations - before, 0) << name << ", " << usbl::modeName(mode);
  EXPECT_TRUE(gaussian(belief).mean.allFinite());
}

template <class Filter>
void expectNoAllocationOfParticles(const char* name, Filter filter) {
  ASSERT_TRUE(filter.start({}));
  const auto f = [](const Vector<4>& x) -> Vector<4> { return x + Vector<4>(x(2), x(3), 0, 0); };
  const auto h = [](const Vector<4>& x) -> Vector<1> { return Vector<1>(std::atan2(x(1) - 9, x(0))); };
  bool resampled = false;
  const long before = allocations;
  for (int k = 0; k < 20; ++k) {
    filter.predict(f, Matrix<4>(0.3 * Matrix<4>::Identity()));
    resampled |= filter.update(Vector<1>(-1.5 + 0.1 * (k % 7)), h, Matrix<1>(1e-4)).resampled;
  }
  EXPECT_EQ(allocations - before, 0) << name;
  EXPECT_TRUE(resampled) << name;
  EXPECT_TRUE(filter.belief().mean.allFinite());
}

class Allocation : public ::testing::Test {
  void SetUp() override {
#ifdef SAS_MOTION_CANNOT_COUNT
    GTEST_SKIP() << SAS_MOTION_CANNOT_COUNT;
#endif
  }
};

TEST_F(Allocation, MechanisationUsesNoHeap) {
  Mechanisation ins({}, 0, {});
  const long before = allocations;
  for (int k = 1; k <= 100; ++k)
    ins.step({k * kNanosecondsPerSecond / 100, Vector<3>(0.01, 0, 0.02), Vector<3>(0, 0, 9.8)});
  EXPECT_EQ(allocations - before, 0);
  EXPECT_EQ(ins.stamp(), kNanosecondsPerSecond);
}

TEST_F(Allocation, ParticlesUseNoHeap) {
  UnscentedParticleOptions options;
  options.particles = 100;
  options.loss = Loss(LossKind::Tukey);
  options.threads = 2;
  expectNoAllocationOfParticles("pf", ParticleFilter<4>(options));
  const SimplexBlocks<4> blocks(simplexPoints<4>(0.2)), one_by_one(simplexPoints<4>(0.2), false);
  const OneByOne unscented(UnscentedKalmanFilter<4>(unscentedPoints<4>({1, 0, 1})));
  for (const auto weighting : {Weighting::Mixture, Weighting::OptimalProposal, Weighting::Literal}) {
    options.weighting = weighting;
    expectNoAllocationOfParticles("ss_srupf", UnscentedParticleFilter(blocks, options));
    expectNoAllocationOfParticles("ss_srupf, one by one", UnscentedParticleFilter(one_by_one, options));
    expectNoAllocationOfParticles("upf", UnscentedParticleFilter(unscented, options));
  }
}

TEST_F(Allocation, PredictAndUpdateUseNoHeap) {
  const long before = allocations;
  const std::vector<double> something(100, 1.0);
  ASSERT_GT(allocations, before) << "the counter does not count";
  ASSERT_EQ(something.size(), 100u);

  expectNoAllocation("kf", KalmanFilter<kStates>());
  using Reacquiring = ReacquiringFilter<GatedKalmanFilter<kStates>, kStates>;
  expectNoAllocation("gated_kf", Reacquiring(GatedKalmanFilter<kStates>({}), 1));
  expectNoAllocation("bank_kf", BankKalmanFilter<kStates>({}));
  expectNoAllocation("mixture_kf", MixtureKalmanFilter<kStates>({}));
  expectNoAllocation("student_t_kf", StudentTKalmanFilter<kStates>({}));
  expectNoAllocation("ckf", SigmaPointFilter(cubaturePoints<kStates>()));
  expectNoAllocation("ukf", SigmaPointFilter(unscentedPoints<kStates>({})));
  for (const auto& name : usbl::filterNames())
    for (const usbl::Mode mode :
         {usbl::Mode::DirectionAngles, usbl::Mode::DirectionCosines, usbl::Mode::AzimuthElevation, usbl::Mode::Azimuth})
      expectNoAllocation(name, mode);
  for (const auto& name : lossNames())
    for (const bool process : {false, true}) {
      RobustKalmanFilter<kStates>::Options options;
      options.loss = Loss(lossFromName(name));
      options.robustify_process = process;
      expectNoAllocation(name.c_str(), RobustKalmanFilter<kStates>(options));
      expectNoAllocation(("calibrated " + name).c_str(),
                         CalibratedFilter<RobustKalmanFilter<kStates>, kStates>(RobustKalmanFilter<kStates>(options)));
    }
}

}  // namespace
}  // namespace sas_motion

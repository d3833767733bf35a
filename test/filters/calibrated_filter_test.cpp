// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/calibrated_filter.hpp"

#include <cmath>

#include "sas_motion/filters/reacquiring_filter.hpp"
#include "sas_motion/filters/robust_kalman_filter.hpp"
#include "sas_motion/filters/student_t_kalman_filter.hpp"
#include "sas_motion/math/statistics.hpp"
#include "sas_motion/systems/constant_velocity/model.hpp"
#include "support.hpp"

namespace sas_motion {
namespace {

using testing::relativeDifference;
using Robust = RobustKalmanFilter<6>;
using StudentT = StudentTKalmanFilter<6>;

Robust::Options robust(const Loss& loss, bool calibrate = true) {
  Robust::Options options;
  options.loss = loss;
  options.calibrate = calibrate;
  return options;
}

/// A run of the textbook problem: `share` of the readings `K` times too noisy, the others `scale` times.
struct Simulated {
  std::vector<Vector<6>> truth;
  std::vector<Vector<4>> z;
};

Simulated simulate(Random& random, double share, double K, double scale = 1, int epochs = 300) {
  const constant_velocity::Model model;
  Simulated run;
  Vector<6> x = Vector<6>::Zero();
  for (int k = 0; k < epochs; ++k) {
    const auto step = model.transition(x);
    x = step.mean + step.Q.llt().matrixL() * testing::randomMatrix<6>(random);
    Vector<4> z = x.head<4>();
    for (int row = 0; row < 4; ++row)
      z(row) += model.sigma()(row) * random.gaussian() * (random.uniform() < share ? K : scale);
    run.truth.push_back(x);
    run.z.push_back(z);
  }
  return run;
}

/// Calls `see` with the belief after each epoch.
template <class Filter, class See>
void follow(const Filter& filter, const Simulated& run, See&& see) {
  const constant_velocity::Model model;
  typename Filter::Belief belief{Gaussian<6>()};
  for (std::size_t k = 0; k < run.z.size(); ++k) {
    belief = filter.predict(belief, model.transition(gaussian(belief).mean));
    belief =
        filter.update(belief, model.measurement(run.z[k], gaussian(belief).mean, 0.5 * static_cast<double>(k))).belief;
    see(k, gaussian(belief));
  }
}

template <class Filter>
std::vector<Gaussian<6>> answers(const Filter& filter, const Simulated& run) {
  std::vector<Gaussian<6>> all;
  follow(filter, run, [&](std::size_t, const Gaussian<6>& belief) { all.push_back(belief); });
  return all;
}

/// NEES per state over the runs of seeds 1 to 20.
template <class Filter>
double nees(const Filter& filter, double share, double K) {
  std::vector<double> values;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    const Simulated run = simulate(random, share, K);
    follow(filter, run, [&](std::size_t k, const Gaussian<6>& belief) {
      const Vector<6> error = belief.mean - run.truth[k];
      if (k >= 20) values.push_back(error.dot(belief.covariance.llt().solve(error)) / 6);
    });
  }
  return mean(values);
}

template <class Filter>
void expectTheSame(const Filter& filter, const std::vector<Gaussian<6>>& expected, const Simulated& run,
                   const char* what) {
  const auto found = answers(filter, run);
  for (std::size_t k = 0; k < expected.size(); ++k) {
    ASSERT_EQ(found[k].mean, expected[k].mean) << what << ", epoch " << k;
    ASSERT_EQ(found[k].covariance, expected[k].covariance) << what << ", epoch " << k;
  }
}

TEST(CalibratedFilter, MeansAreTheFiltersOwnToTheLastBit) {
  Random random = testing::announced(91);
  const Simulated run = simulate(random, 0.2, 20);
  for (const auto& name : lossNames()) {
    const Robust inner(robust(Loss(lossFromName(name))));
    const auto plain = answers(inner, run), calibrated = answers(CalibratedFilter<Robust, 6>(inner), run);
    for (std::size_t k = 0; k < plain.size(); ++k)
      ASSERT_EQ(plain[k].mean, calibrated[k].mean) << name << ", epoch " << k;
  }
}

TEST(CalibratedFilter, SwitchedOffItIsTheFilterToTheLastBit) {
  Random random = testing::announced(92);
  const Simulated run = simulate(random, 0.2, 20);
  const Robust huber(robust(Loss(LossKind::Huber), false));
  expectTheSame(CalibratedFilter<Robust, 6>(huber), answers(huber, run), run, "huber");
  const StudentT student({4, 30, 1e-6, false});
  expectTheSame(CalibratedFilter<StudentT, 6>(student), answers(student, run), run, "student_t");
}

TEST(CalibratedFilter, OnePassAndProcessWeightsAreLeftAsTheyAre) {
  Random random = testing::announced(93);
  const Simulated run = simulate(random, 0.2, 20);
  for (const auto& [iterations, process] : {std::pair(1, false), std::pair(10, true)}) {
    auto options = robust(Loss(LossKind::Huber));
    options.max_iterations = iterations;
    options.robustify_process = process;
    expectTheSame(CalibratedFilter<Robust, 6>(Robust(options)), answers(Robust(options), run), run,
                  process ? "process" : "one pass");
  }
}

TEST(CalibratedFilter, WhereNothingIsClippedItIsTheKalmanFilterHoweverNoisyTheReadings) {
  Random random = testing::announced(94);
  for (const double scale : {0.3, 1.0, 3.0}) {
    const Simulated run = simulate(random, 0, 1, scale);
    const auto kalman = answers(KalmanFilter<6>(), run);
    const auto expectKalman = [&](const auto& filter, const std::string& what) {
      const auto found = answers(filter, run);
      for (std::size_t k = 0; k < run.z.size(); ++k) {
        ASSERT_LT(relativeDifference(found[k].mean, kalman[k].mean), 1e-6) << what << ", epoch " << k;
        ASSERT_LT(relativeDifference(found[k].covariance, kalman[k].covariance), 1e-6) << what << ", epoch " << k;
      }
    };
    for (const auto& name : lossNames())
      expectKalman(CalibratedFilter<Robust, 6>(Robust(robust(Loss(lossFromName(name), name == "l2" ? 1 : 1e9)))), name);
    expectKalman(CalibratedFilter<StudentT, 6>(StudentT({1e9, 30, 1e-9, true})), "student_t");
  }
}

TEST(CalibratedFilter, NormalisedErrorsUnderContaminationAreNearWhatTheyShouldBe) {
  std::cout << "seeds 1 to 20\n";
  for (const char* name : {"huber", "pseudo_huber", "cauchy"})
    for (const auto& [share, K] : {std::pair(0.1, 10.0), std::pair(0.1, 50.0), std::pair(0.2, 20.0)}) {
      const Robust inner(robust(Loss(lossFromName(name))));
      const double calibrated = nees(CalibratedFilter<Robust, 6>(inner), share, K);
      EXPECT_GT(calibrated, 0.92) << name << ", " << share;
      EXPECT_LT(calibrated, 1.12) << name << ", " << share;
    }
  EXPECT_GT(nees(Robust(robust(Loss(LossKind::Huber))), 0.2, 20), 1.3) << "there would be nothing to calibrate";
  const StudentT student({});
  EXPECT_GT(nees(student, 0.1, 10), 1.1) << "there would be nothing to calibrate";
  EXPECT_NEAR(nees(CalibratedFilter<StudentT, 6>(student), 0.1, 10), 1, 0.08);
}

TEST(CalibratedFilter, OnGoodReadingsItIsAtMostALittleCautious) {
  std::cout << "seeds 1 to 20\n";
  for (const char* name : {"huber", "pseudo_huber", "cauchy", "tukey", "welsch"}) {
    const double calibrated = nees(CalibratedFilter<Robust, 6>(Robust(robust(Loss(lossFromName(name))))), 0, 1);
    EXPECT_GT(calibrated, 0.92) << name;
    EXPECT_LT(calibrated, 1.03) << name;
  }
}

TEST(CalibratedFilter, ComingBackAfterALockOutWidensBothCovariances) {
  const Robust inner(robust(Loss(LossKind::Tukey)));
  const ReacquiringFilter<Robust, 6> plain(inner, 5);
  const ReacquiringFilter<CalibratedFilter<Robust, 6>, 6> calibrated(CalibratedFilter<Robust, 6>(inner), 5);
  Random random = testing::announced(95);
  Simulated run = simulate(random, 0, 1);
  for (std::size_t k = 150; k < run.z.size(); ++k) run.z[k](0) += 200;  // the sensor's datum has moved
  const auto expected = answers(plain, run), found = answers(calibrated, run);
  EXPECT_NEAR(found.back().mean(0) - run.truth.back()(0), 200, 5);
  for (std::size_t k = 0; k < 150; ++k) ASSERT_EQ(found[k].mean, expected[k].mean) << k;
  for (const auto& belief : found) ASSERT_GT(testing::smallestEigenvalue<6>(belief.covariance), 0);
}

}  // namespace
}  // namespace sas_motion

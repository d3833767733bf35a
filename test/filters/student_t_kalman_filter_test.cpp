// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/student_t_kalman_filter.hpp"

#include "support.hpp"

namespace sas_motion {
namespace {

using testing::announced;

TEST(StudentTKalmanFilter, WithManyDegreesOfFreedomIsTheKalmanFilter) {
  Random random = announced(41);
  const StudentTKalmanFilter<6> filter({1e12, 30, 1e-12});
  for (int i = 0; i < 20; ++i) {
    const auto prior = testing::randomBelief<6>(random);
    const auto z = testing::randomMeasurement<6, 4>(random);
    const auto kalman = KalmanFilter<6>().update(prior, z), student = filter.update(prior, z);
    EXPECT_LT(testing::relativeDifference(student.belief.mean, kalman.belief.mean), 1e-8);
    EXPECT_LT(testing::relativeDifference(student.belief.covariance, kalman.belief.covariance), 1e-8);
  }
}

TEST(StudentTKalmanFilter, StopsAtAFixedPointOfTheVariationalEquations) {
  Random random = announced(42);
  const double nu = 4;
  for (int i = 0; i < 20; ++i) {
    const auto prior = testing::randomBelief<2>(random);
    auto z = testing::randomMeasurement<2, 1>(random);
    z.innovation(0) *= 3;
    const auto update = StudentTKalmanFilter<2>({nu, 1000, 1e-13}).update(prior, z);
    ASSERT_TRUE(update.converged);
    const double residual = z.innovation(0) - z.H.row(0).dot(update.belief.mean - prior.mean);
    const double squared = residual * residual + (z.H * update.belief.covariance * z.H.transpose())(0, 0);
    const double lambda = (nu + 1) / (nu + squared / z.R(0, 0));
    LinearMeasurement<2, 1> weighted = z;
    weighted.R /= lambda;
    EXPECT_NEAR(update.weights(0), std::min(1.0, lambda), 1e-9);
    EXPECT_LT(testing::relativeDifference(update.belief.mean, KalmanFilter<2>().update(prior, weighted).belief.mean),
              1e-9);
  }
}

TEST(StudentTKalmanFilter, FewerDegreesOfFreedomTrustAnOutlierLess) {
  Random random = announced(43);
  const auto prior = testing::randomBelief<6>(random);
  auto z = testing::randomMeasurement<6, 1>(random);
  z.innovation(0) = 50;
  double last = 0;
  for (const double nu : {1.0, 3.0, 10.0, 100.0, 1e6}) {
    const double moved = (StudentTKalmanFilter<6>({nu, 1000, 1e-10}).update(prior, z).belief.mean - prior.mean).norm();
    EXPECT_GT(moved, last) << nu;
    last = moved;
  }
}

TEST(StudentTKalmanFilter, RefusesBadOptions) {
  EXPECT_THROW(StudentTKalmanFilter<6>({0, 30, 1e-6}), std::invalid_argument);
  EXPECT_THROW(StudentTKalmanFilter<6>({4, 0, 1e-6}), std::invalid_argument);
  EXPECT_THROW(StudentTKalmanFilter<6>({4, 30, -1}), std::invalid_argument);
}

}  // namespace
}  // namespace sas_motion

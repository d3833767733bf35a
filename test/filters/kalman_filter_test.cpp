// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/kalman_filter.hpp"

#include "support.hpp"

namespace sas_motion {
namespace {

using testing::announced;
using testing::relativeDifference;

template <int N, int M>
Gaussian<N> textbookUpdate(const Gaussian<N>& prior, const LinearMeasurement<N, M>& z) {
  const Matrix<N> I = Matrix<N>::Identity();
  const Matrix<M> S = z.H * prior.covariance * z.H.transpose() + z.R;
  const Matrix<N, M> K = prior.covariance * z.H.transpose() * S.inverse();
  const Matrix<N> IKH = I - K * z.H;
  return {prior.mean + K * z.innovation, IKH * prior.covariance * IKH.transpose() + K * z.R * K.transpose()};
}

template <int N, int M>
void expectTextbook(Random& random) {
  auto z = testing::randomMeasurement<N, M>(random);
  z.R = testing::randomCovariance<M>(random);  // correlated
  const auto prior = testing::randomBelief<N>(random);
  const auto update = KalmanFilter<N>().update(prior, z);
  const auto expected = textbookUpdate(prior, z);
  const Matrix<M> S = z.H * prior.covariance * z.H.transpose() + z.R;
  EXPECT_LT(relativeDifference(update.belief.mean, expected.mean), 1e-11);
  EXPECT_LT(relativeDifference(update.belief.covariance, expected.covariance), 1e-11);
  EXPECT_LT(relativeDifference(update.S, S), 1e-13);
  EXPECT_NEAR(update.nis, z.innovation.dot(S.inverse() * z.innovation), 1e-9 * (1 + update.nis));
  EXPECT_EQ(update.innovation, z.innovation);
  EXPECT_EQ(update.verdict, Verdict::Accepted);
}

TEST(KalmanFilter, UpdateIsTheTextbooks) {
  Random random = announced(11);
  for (int i = 0; i < 50; ++i) {
    expectTextbook<2, 1>(random);
    expectTextbook<6, 1>(random);
    expectTextbook<6, 2>(random);
    expectTextbook<6, 4>(random);
  }
}

TEST(KalmanFilter, UpdateIsTheInformationFormsAnswer) {
  Random random = announced(12);
  const auto prior = testing::randomBelief<6>(random);
  const auto z = testing::randomMeasurement<6, 4>(random);
  const Matrix<6> information = prior.covariance.inverse() + z.H.transpose() * z.R.inverse() * z.H;
  const auto update = KalmanFilter<6>().update(prior, z);
  EXPECT_LT(relativeDifference(update.belief.covariance, information.inverse()), 1e-10);
  const Vector<6> step = information.inverse() * z.H.transpose() * z.R.inverse() * z.innovation;
  EXPECT_LT(relativeDifference(update.belief.mean, prior.mean + step), 1e-10);
}

TEST(KalmanFilter, PredictionIsFPFTPlusQ) {
  Random random = announced(13);
  const auto belief = testing::randomBelief<6>(random);
  const Transition<6> step{testing::randomMatrix<6>(random), testing::randomMatrix<6, 6>(random),
                           testing::randomCovariance<6>(random)};
  const auto prior = predictGaussian(belief, step);
  EXPECT_EQ(prior.mean, step.mean);
  EXPECT_LT(relativeDifference(prior.covariance, step.F * belief.covariance * step.F.transpose() + step.Q), 1e-13);
  EXPECT_EQ(prior.covariance, Matrix<6>(prior.covariance.transpose()));
}

TEST(KalmanFilter, RowByRowEqualsAllAtOnce) {
  Random random = announced(14);
  const auto prior = testing::randomBelief<6>(random);
  const auto z = testing::randomMeasurement<6, 4>(random);
  Gaussian<6> belief = prior;
  for (int row = 0; row < 4; ++row) {
    LinearMeasurement<6, 1> one;
    one.H = z.H.row(row);
    one.innovation(0) = z.innovation(row) - z.H.row(row).dot(belief.mean - prior.mean);
    one.R(0, 0) = z.R(row, row);
    belief = KalmanFilter<6>().update(belief, one).belief;
  }
  const auto together = KalmanFilter<6>().update(prior, z).belief;
  EXPECT_LT(relativeDifference(belief.mean, together.mean), 1e-11);
  EXPECT_LT(relativeDifference(belief.covariance, together.covariance), 1e-11);
}

}  // namespace
}  // namespace sas_motion

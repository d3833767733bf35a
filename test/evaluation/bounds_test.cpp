// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/evaluation/bounds.hpp"

#include <cmath>

#include "sas_motion/filters/kalman_filter.hpp"
#include "support.hpp"

namespace sas_motion {
namespace {

using testing::announced;
using testing::relativeDifference;

Transition<6> randomStep(Random& random) {
  return {Vector<6>::Zero(), Matrix<6>::Identity() + 0.1 * testing::randomMatrix<6, 6>(random),
          0.01 * testing::randomCovariance<6>(random)};
}

Matrix<6> inverse(const Matrix<6>& A) { return A.llt().solve(Matrix<6>::Identity()); }

TEST(PosteriorBound, IsTheRiccatiRecursionOfALinearGaussianModel) {
  Random random = announced(61);
  Gaussian<6> belief{Vector<6>::Zero(), testing::randomCovariance<6>(random)};
  PosteriorBound<6> bound(inverse(belief.covariance));
  const KalmanFilter<6> kalman;
  for (int i = 0; i < 200; ++i) {
    const auto step = randomStep(random);
    const auto z = testing::randomMeasurement<6, 2>(random);
    belief = kalman.update(kalman.predict(belief, step), z).belief;
    bound.step({step});
    bound.measurement<2>({z});
    ASSERT_LT(relativeDifference(*bound.covariance(), belief.covariance), 1e-12) << i;
  }
}

TEST(PosteriorBound, IsTichavskysRecursionWhereTruthsDiffer) {
  Random random = announced(62);
  PosteriorBound<6> bound(inverse(testing::randomCovariance<6>(random)));
  for (int i = 0; i < 50; ++i) {
    std::vector<Transition<6>> steps;
    Matrix<6> D11 = Matrix<6>::Zero(), D12 = Matrix<6>::Zero(), D22 = Matrix<6>::Zero();
    for (int truth = 0; truth < 5; ++truth) {
      steps.push_back(randomStep(random));
      const Matrix<6> inverse_Q = 0.8 * inverse(steps.back().Q);
      D11 += steps.back().F.transpose() * inverse_Q * steps.back().F / 5;
      D12 -= steps.back().F.transpose() * inverse_Q / 5;
      D22 += inverse_Q / 5;
    }
    const Matrix<6> expected = D22 - D12.transpose() * (bound.information() + D11).ldlt().solve(D12);
    bound.step(steps, 0.8);
    ASSERT_LT(relativeDifference(bound.information(), expected), 1e-10) << i;
  }
}

TEST(PosteriorBound, BothFormsAgree) {
  Random random = announced(63);
  const auto step = randomStep(random);
  auto other = step;
  other.F(0, 0) = std::nextafter(step.F(0, 0), 10);  // not the same, so by QR
  const Matrix<6> J = testing::randomCovariance<6>(random);
  PosteriorBound<6> closed(J), qr(J);
  closed.step({step, step}, 0.7);
  qr.step({step, other}, 0.7);
  EXPECT_LT(relativeDifference(qr.information(), closed.information()), 1e-12);
}

TEST(PosteriorBound, StandsANearlySingularProcessNoise) {
  Random random = announced(64);
  auto step = randomStep(random), other = step;
  step.Q = Matrix<6>::Identity() * 1e-14;
  step.Q(5, 5) = 1;
  other.Q = step.Q;
  other.F(0, 0) = std::nextafter(step.F(0, 0), 10);
  PosteriorBound<6> closed(Matrix<6>::Identity()), qr(Matrix<6>::Identity());
  for (int i = 0; i < 20; ++i) {
    const auto z = testing::randomMeasurement<6, 2>(random);
    closed.step({step});
    qr.step({step, other});
    closed.measurement<2>({z});
    qr.measurement<2>({z});
  }
  EXPECT_LT(relativeDifference(qr.information(), closed.information()),
            1e-6);  // differences of numbers near 1e14 would leave two digits
}

TEST(PosteriorBound, OfAConstantIsTheOrdinaryBound) {
  const Transition<2> still{Vector<2>::Zero(), Matrix<2>::Identity(), Matrix<2>::Zero()};
  PosteriorBound<2> bound(Matrix<2>::Zero());
  EXPECT_FALSE(bound.covariance());
  LinearMeasurement<2, 1> north{Vector<1>::Zero(), Matrix<1, 2>(1, 0), Matrix<1>(4.0)},
      east{Vector<1>::Zero(), Matrix<1, 2>(0, 1), Matrix<1>(9.0)};
  for (int i = 0; i < 100; ++i) {
    bound.step({still});
    bound.measurement<1>({north});
    bound.measurement<1>({east}, {Vector<1>(0.5)});
  }
  EXPECT_NEAR((*bound.covariance())(0, 0), 4.0 / 100, 1e-15);
  EXPECT_NEAR((*bound.covariance())(1, 1), 9.0 / 50, 1e-15);
}

TEST(PosteriorBound, FallsWithInformationAndRisesWithProcessNoise) {
  Random random = announced(65);
  const auto step = randomStep(random);
  const auto z = testing::randomMeasurement<6, 2>(random);
  const Matrix<6> J = testing::randomCovariance<6>(random);
  PosteriorBound<6> good(J), half(J), rough(J);
  auto rougher = step;
  rougher.Q *= 2;
  good.step({step});
  half.step({step});
  rough.step({rougher});
  good.measurement<2>({z});
  half.measurement<2>({z}, {Vector<2>(0.5, 0.5)});
  rough.measurement<2>({z});
  EXPECT_GT(testing::smallestEigenvalue<6>(*half.covariance() - *good.covariance()), -1e-12);
  EXPECT_GT(testing::smallestEigenvalue<6>(*rough.covariance() - *good.covariance()), 0);
}

TEST(PosteriorBound, IsReachedByTheKalmanFilterOnGaussianNoise) {
  std::cout << "seeds 1 to 400\n";
  const Transition<2> drift{Vector<2>::Zero(), (Matrix<2>() << 1, 0.5, 0, 1).finished(),
                            (Matrix<2>() << 0.05 / 24, 0.05 / 8, 0.05 / 8, 0.05 / 2).finished()};
  const Matrix<2> root = drift.Q.llt().matrixL();
  const KalmanFilter<2> kalman;
  double squares = 0, bounds = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    Random random(seed);
    Vector<2> truth(random.gaussian(), random.gaussian());
    Gaussian<2> belief;
    PosteriorBound<2> bound(Matrix<2>::Identity());
    for (int i = 0; i < 200; ++i) {
      truth = drift.F * truth + root * Vector<2>(random.gaussian(), random.gaussian());
      auto step = drift;
      step.mean = drift.F * belief.mean;
      belief = kalman.predict(belief, step);
      LinearMeasurement<2, 1> z{Vector<1>(truth(0) + random.gaussian() - belief.mean(0)), Matrix<1, 2>(1, 0),
                                Matrix<1>(1.0)};
      belief = kalman.update(belief, z).belief;
      bound.step({step});
      bound.measurement<1>({z});
      squares += (belief.mean - truth)(0) * (belief.mean - truth)(0);
      bounds += (*bound.covariance())(0, 0);
    }
  }
  EXPECT_NEAR(squares / bounds, 1, 0.02);
}

TEST(MeanBound, AveragesWhatTheErrorsMayBeNotWhatIsKnown) {
  MeanBound<2> mean;
  EXPECT_FALSE(mean.rmse({0}));
  mean.add(PosteriorBound<2>((Matrix<2>() << 1, 0, 0, 4).finished()));
  mean.add(PosteriorBound<2>((Matrix<2>() << 0.25, 0, 0, 1).finished()));
  EXPECT_NEAR(*mean.rmse({0}), std::sqrt((1 + 4) / 2.0), 1e-15);  // the mean information would say sqrt(1.6)
  EXPECT_NEAR(*mean.rmse({0, 1}), std::sqrt((1 + 4) / 2.0 + (0.25 + 1) / 2), 1e-15);
  mean.add(PosteriorBound<2>(Matrix<2>::Zero()));
  EXPECT_FALSE(mean.rmse({0})) << "a state that is not known at all has no bound";
}

}  // namespace
}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Sigma-point filters on bent models: beside a fine Monte Carlo, across +-pi, and over whole runs.
#include "sas_motion/filters/sigma_point_filter.hpp"
#include "sas_motion/math/statistics.hpp"
#include "sas_motion/systems/towfish/model.hpp"
#include "support.hpp"

namespace sas_motion {
namespace {

using testing::announced;
using towfish::kStates;

constexpr int kSamples = 400000;

Vector<2> rangeBearing(const Vector<2>& x) { return {x.norm(), std::atan2(x(1), x(0))}; }

Vector<2> bearingDifference(const Vector<2>& y, const Vector<2>& x) { return {y(0) - x(0), wrapAngle(y(1) - x(1))}; }

/// Mean and covariance of function(x) over the belief, by sampling.
template <int M, int N, class Function, class Difference>
Gaussian<M> sampled(const Gaussian<N>& belief, const Function& function, const Difference& difference, Random& random) {
  const Matrix<N> L = belief.covariance.llt().matrixL();
  const Vector<M> reference = function(belief.mean);
  Vector<M> sum = Vector<M>::Zero();
  Matrix<M> squares = Matrix<M>::Zero();
  for (int i = 0; i < kSamples; ++i) {
    const Vector<M> d = difference(function(Vector<N>(belief.mean + L * testing::randomMatrix<N>(random))), reference);
    sum += d;
    squares += d * d.transpose();
  }
  const Vector<M> mean = sum / kSamples;
  return {reference + mean, squares / kSamples - mean * mean.transpose()};
}

/// How many standard deviations apart the means are, at most in any row.
template <int M, class Difference>
double meanError(const Vector<M>& mean, const Gaussian<M>& truth, const Difference& difference) {
  return difference(mean, truth.mean).cwiseQuotient(truth.covariance.diagonal().cwiseSqrt()).cwiseAbs().maxCoeff();
}

TEST(SigmaPointAccuracy, RangeAndBearingHaveTheirMonteCarloMomentsAcrossPi) {
  Random random = announced(91);
  const Gaussian<2> belief{Vector<2>(-50, 1),
                           Vector<2>(25, 25).asDiagonal()};  // two fifths of it have the other sign of bearing
  const auto truth = sampled<2>(belief, rangeBearing, bearingDifference, random);
  const Matrix<2> R = Vector<2>(1, 1e-4).asDiagonal();
  const auto expectNear = [&](const auto& filter) {
    const auto update = filter.update(belief, truth.mean, rangeBearing, R, bearingDifference);
    const Vector<2> mean = truth.mean - update.innovation;
    EXPECT_LT(meanError(mean, truth, bearingDifference), 0.008);  // sampling alone: 0.0016
    EXPECT_LT(testing::relativeDifference((update.S - R).diagonal().cwiseQuotient(truth.covariance.diagonal()),
                                          Vector<2>::Ones()),
              0.05);
  };
  expectNear(SigmaPointFilter(cubaturePoints<2>()));
  expectNear(SigmaPointFilter(unscentedPoints<2>({1, 0, 1})));
  EXPECT_GT(meanError(rangeBearing(belief.mean), truth, bearingDifference), 0.04) << "h of the mean is no good here";
}

TEST(SigmaPointAccuracy, APredictionWithAnUncertainHeadingHasItsMonteCarloMoments) {
  Random random = announced(92);
  const towfish::Model model{towfish::MotionParameters{}};
  Gaussian<kStates> belief;
  belief.mean << 10, -20, 0.1, 0.2, 3.1, 2;  // the heading wraps
  belief.covariance.diagonal() << 0.1, 0.1, 0.01, 0.01, 0.01, 0.01;
  const auto f = [&](const Vector<kStates>& x) { return model.predict(x, {0.01}, 10); };
  const auto truth = sampled<kStates>(belief, f, towfish::Model::difference, random);
  const auto expectNear = [&](const auto& filter) {
    const auto prior = filter.predict(belief, f, Matrix<kStates>::Zero().eval(), towfish::Model::difference);
    ASSERT_TRUE(prior);
    EXPECT_LT(meanError(prior->mean, truth, towfish::Model::difference), 0.008);  // sampling alone: 0.0016
    const Vector<kStates> ratios = prior->covariance.diagonal().cwiseQuotient(truth.covariance.diagonal());
    EXPECT_LT(testing::relativeDifference(ratios, Vector<kStates>::Ones()), 0.03);
  };
  expectNear(SigmaPointFilter(cubaturePoints<kStates>()));
  expectNear(SigmaPointFilter(unscentedPoints<kStates>({1, 2, -3})));
  EXPECT_GT(meanError(f(belief.mean), truth, towfish::Model::difference), 0.06) << "f of the mean is no good here";
}

/// A quarter turn of the map takes the points of a diagonal covariance to each other, so the answer turns with it,
/// heading past pi and all.
TEST(SigmaPointAccuracy, AQuarterTurnOfTheMapTurnsTheAnswer) {
  const towfish::Model model{towfish::MotionParameters{}};
  Matrix<kStates> C = Matrix<kStates>::Zero();
  C(0, 1) = C(2, 3) = -1;
  C(1, 0) = C(3, 2) = C(4, 4) = C(5, 5) = 1;
  Gaussian<kStates> belief;
  belief.mean << 10, -20, 0.1, 0.2, 0.5, 2;
  belief.covariance.diagonal() << 0.1, 0.2, 0.01, 0.02, 0.09, 0.01;
  const auto f = [&](const Vector<kStates>& x) { return model.predict(x, {0.01}, 10); };
  const SigmaPointFilter filter(cubaturePoints<kStates>());
  const auto expected = filter.predict(belief, f, Matrix<kStates>::Identity().eval(), towfish::Model::difference);
  ASSERT_TRUE(expected);
  Vector<kStates> turn = Vector<kStates>::Zero();
  for (int quarter = 1; quarter <= 4; ++quarter) {
    belief = {C * belief.mean, C * belief.covariance * C.transpose()};
    belief.mean(towfish::kHeading) += kPi / 2;
    turn(towfish::kHeading) += kPi / 2;
    const auto prior = filter.predict(belief, f, Matrix<kStates>::Identity().eval(), towfish::Model::difference);
    ASSERT_TRUE(prior);
    Matrix<kStates> turned = Matrix<kStates>::Identity();
    for (int i = 0; i < quarter; ++i) turned = (C * turned).eval();
    EXPECT_LT(towfish::Model::difference(prior->mean, turned * expected->mean + turn).norm(), 1e-11) << quarter;
    EXPECT_LT(testing::relativeDifference(prior->covariance, turned * expected->covariance * turned.transpose()), 1e-12)
        << quarter;
  }
}

/// GIVEN a towfish that hears range and bearing of a beacon, WHEN it passes, THEN the filter's error is what its
/// covariance says.
TEST(SigmaPointAccuracy, NeesOfRunsPastABeaconIsInItsBand) {
  constexpr int kRuns = 200, kSteps = 60;
  const towfish::Model model{towfish::MotionParameters{0.1, 300, 0.5 * kRadPerDeg, 0.05, 0.01}};
  const SigmaPointFilter filter(cubaturePoints<kStates>());
  const Matrix<4> R = Vector<4>(1, 1e-4, 1e-4, 1e-2).asDiagonal();
  const auto h = [](const Vector<kStates>& x) -> Vector<4> {  // the beacon at (0, 40); relative bearing
    const double north = -x(0), east = 40 - x(1);
    return {std::hypot(north, east), wrapAngle(std::atan2(east, north) - x(4)), x(4), x(5)};
  };
  const auto difference = [](const Vector<4>& y, const Vector<4>& x) -> Vector<4> {
    return {y(0) - x(0), wrapAngle(y(1) - x(1)), wrapAngle(y(2) - x(2)), y(3) - x(3)};
  };
  const auto f = [&](const Vector<kStates>& x) { return model.predict(x, {}, 1); };
  Random random = announced(94);
  double nees = 0;
  for (int run = 0; run < kRuns; ++run) {
    Gaussian<kStates> belief;
    belief.mean << -60, 0, 0, 0, 0, 2;
    belief.covariance.diagonal() << 25, 25, 0.01, 0.01, 0.01, 0.04;
    Vector<kStates> truth = belief.mean + belief.covariance.cwiseSqrt() * testing::randomMatrix<kStates>(random);
    for (int step = 0; step < kSteps; ++step) {
      const Matrix<kStates> Q_true = model.transition(truth, {}, 1).Q, Q = model.transition(belief.mean, {}, 1).Q;
      truth = f(truth) + Matrix<kStates>(Q_true.llt().matrixL()) * testing::randomMatrix<kStates>(random);
      const auto prior = filter.predict(belief, f, Q, towfish::Model::difference);
      ASSERT_TRUE(prior) << "run " << run << " step " << step;
      const Vector<4> z = h(truth) + R.cwiseSqrt() * testing::randomMatrix<4>(random);
      const auto update = filter.update(*prior, z, h, R, difference);
      ASSERT_EQ(update.verdict, Verdict::Accepted) << "run " << run << " step " << step;
      belief = update.belief;
    }
    const Vector<kStates> error = towfish::Model::difference(truth, belief.mean);
    nees += error.dot(belief.covariance.llt().solve(error)) / kRuns;
  }
  const Band band = averageChiSquaredBand(kStates, kRuns, 0.99);
  EXPECT_GT(nees, band.lower);
  EXPECT_LT(nees, band.upper);
}

}  // namespace
}  // namespace sas_motion

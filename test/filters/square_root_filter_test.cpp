// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The square-root form gives the covariance form's answers, with half the digits, and some where the covariance form
// has none.
#include "sas_motion/filters/square_root_filter.hpp"

#include <limits>

#include "sas_motion/filters/kalman_filter.hpp"
#include "sas_motion/filters/sigma_point_filter.hpp"
#include "support.hpp"

namespace sas_motion {
namespace {

using testing::announced;
using testing::relativeDifference;

template <int N>
Matrix<N> rootOf(const Matrix<N>& P) {
  return choleskyLower<N>(P).value();
}

template <int N>
RootGaussian<N> rooted(const Gaussian<N>& belief) {
  return {belief.mean, rootOf<N>(belief.covariance)};
}

template <int N>
void expectSame(const RootGaussian<N>& root_form, const Gaussian<N>& expected, double tolerance) {
  EXPECT_LT(relativeDifference(root_form.mean, expected.mean), tolerance);
  EXPECT_LT(relativeDifference(gaussian(root_form).covariance, expected.covariance), tolerance);
  EXPECT_TRUE(root_form.root.isLowerTriangular(0));
  EXPECT_GE(root_form.root.diagonal().minCoeff(), 0);
}

TEST(SquareRoots, AddAndSubtractSquares) {
  Random random = announced(61);
  for (int i = 0; i < 20; ++i) {
    const Matrix<5> P = testing::randomCovariance<5>(random);
    const Matrix<5, 3> A = testing::randomMatrix<5, 3>(random);
    Matrix<5> root = rootOf<5>(P);
    addSquares<5, 3>(root, A);
    EXPECT_LT(relativeDifference(root, rootOf<5>(P + A * A.transpose())), 1e-12);
    for (int col = 0; col < 3; ++col) ASSERT_TRUE(subtractSquare<5>(root, A.col(col)));
    EXPECT_LT(relativeDifference(root, rootOf<5>(P)), 1e-9);
    EXPECT_FALSE(subtractSquare<5>(root, 1.001 * root.col(0))) << "what is left would be negative";
  }
}

TEST(SquareRoots, KeepWhatASquareWouldLose) {
  // GIVEN a covariance whose condition number is beyond a double's digits
  Matrix<2> root;
  root << 1, 0, 1, 1e-9;
  ASSERT_FALSE(choleskyLower<2>(root * root.transpose()));
  // WHEN a square is added in the direction that is well known THEN the root has it to all its digits
  addSquares<2, 1>(root, Vector<2>(0, 1e-9));
  EXPECT_NEAR(root(1, 1), std::sqrt(2.0) * 1e-9, 1e-15);
}

template <class Points>
void expectTheKalmanFilter(const Points& points) {
  const SquareRootFilter filter(points);
  Random random = announced(62);
  for (int i = 0; i < 30; ++i) {
    const auto belief = testing::randomBelief<6>(random);
    const Matrix<6> F = testing::randomMatrix<6, 6>(random), Q = testing::randomCovariance<6>(random);
    const auto prior = filter.predict(
        rooted(belief), [&](const Vector<6>& x) -> Vector<6> { return F * x; }, rootOf<6>(Q));
    ASSERT_TRUE(prior);
    expectSame<6>(*prior, predictGaussian<6>(belief, {F * belief.mean, F, Q}), 1e-12);
    auto z = testing::randomMeasurement<6, 4>(random);
    z.R = testing::randomCovariance<4>(random);
    const auto expected = KalmanFilter<6>().update(belief, z);
    const auto update = filter.update(
        rooted(belief), Vector<4>(z.H * belief.mean + z.innovation),
        [&](const Vector<6>& x) -> Vector<4> { return z.H * x; }, rootOf<4>(z.R));
    EXPECT_EQ(update.verdict, Verdict::Accepted);
    expectSame<6>(update.belief, expected.belief, 1e-11);
    EXPECT_LT(relativeDifference(update.S, expected.S), 1e-12);
    EXPECT_NEAR(update.nis, expected.nis, 1e-11 * (1 + expected.nis));
  }
}

TEST(SquareRootFilter, IsTheKalmanFilterOnALinearModel) {
  expectTheKalmanFilter(simplexPoints<6>(0));
  expectTheKalmanFilter(simplexPoints<6>(0.4));
  expectTheKalmanFilter(unscentedPoints<6>({1, 2, 1}));
}

Vector<6> bend(const Vector<6>& x) { return x + 0.1 * (x.array().sin() * x.reverse().array()).matrix(); }
Vector<2> look(const Vector<6>& x) { return {std::hypot(x(0) - 9, x(1)), x(4) * x(5) + x(2)}; }

template <class Points>
void expectTheCovarianceForm(const Points& points) {
  const SquareRootFilter root_form(points);
  const SigmaPointFilter covariance_form(points);
  Random random = announced(63);
  for (int i = 0; i < 30; ++i) {
    const auto belief = testing::randomBelief<6>(random);
    const Matrix<6> Q = testing::randomCovariance<6>(random);
    const Matrix<2> R = testing::randomCovariance<2>(random);
    const auto expected = covariance_form.predict(belief, bend, Q);
    const auto prior = root_form.predict(rooted(belief), bend, rootOf<6>(Q));
    ASSERT_TRUE(expected && prior);
    expectSame<6>(*prior, *expected, 1e-12);
    const Vector<2> z = look(expected->mean) + testing::randomMatrix<2>(random);
    const auto update = root_form.update(*prior, z, look, rootOf<2>(R));
    const auto expected_update = covariance_form.update(*expected, z, look, R);
    expectSame<6>(update.belief, expected_update.belief, 1e-10);
    EXPECT_NEAR(update.nis, expected_update.nis, 1e-10 * (1 + update.nis));
  }
}

TEST(SquareRootFilter, EqualsTheCovarianceFormOnANonLinearModel) {
  expectTheCovarianceForm(simplexPoints<6>(0));
  expectTheCovarianceForm(simplexPoints<6>(0.25));
  expectTheCovarianceForm(unscentedPoints<6>({1, 0, 2}));
}

TEST(SquareRootFilter, StandsACovarianceThatHasLostRank) {
  // GIVEN a state of which two are known exactly, and one follows from another
  RootGaussian<6> belief;
  belief.mean << 1, 2, 3, 4, 5, 6;
  belief.root.col(2).setZero();
  belief.root(4, 4) = 0;
  belief.root(3, 3) = 0;
  belief.root(3, 0) = 1;
  const SquareRootFilter filter(simplexPoints<6>(0.2));
  const auto prior = filter.predict(
      belief, [](const Vector<6>& x) -> Vector<6> { return 2 * x; }, Matrix<6>(Matrix<6>::Zero()));
  ASSERT_TRUE(prior);
  EXPECT_LT((gaussian(*prior).covariance - 4 * gaussian(belief).covariance).norm(), 1e-12);
  // WHEN it is measured THEN the answer is that of a filter without roots
  const auto h = [](const Vector<6>& x) -> Vector<2> { return {x(0) + x(2), x(3) - x(5)}; };
  const auto update = filter.update(*prior, Vector<2>(9, -3), h, Matrix<2>(0.1 * Matrix<2>::Identity()));
  ASSERT_EQ(update.verdict, Verdict::Accepted);
  LinearMeasurement<6, 2> z;
  z.innovation = Vector<2>(9, -3) - h(prior->mean);
  z.H << 1, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0, -1;
  z.R = 0.01 * Matrix<2>::Identity();
  expectSame<6>(update.belief, KalmanFilter<6>().update(gaussian(*prior), z).belief, 1e-9);
  EXPECT_NEAR(update.belief.mean(2), 6, 1e-12) << "what is known exactly stays";
}

TEST(SquareRootFilter, RefusesWhatIsNoMeasurementAndStaysAtThePrior) {
  const SquareRootFilter filter(simplexPoints<6>(0.2));
  Random random = announced(64);
  const auto prior = rooted(testing::randomBelief<6>(random));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expectRefused = [&](const Vector<2>& z, const Matrix<2>& R_root) {
    const auto update = filter.update(prior, z, look, R_root);
    EXPECT_EQ(update.verdict, Verdict::Invalid);
    EXPECT_EQ(update.belief.mean, prior.mean);
    EXPECT_EQ(update.belief.root, prior.root);
  };
  expectRefused({nan, 0}, Matrix<2>::Identity());
  expectRefused({1, 0}, Matrix<2>::Zero());
  expectRefused({1, 0}, -Matrix<2>::Identity());
  expectRefused({1, 0}, nan * Matrix<2>::Identity());
  EXPECT_FALSE(filter.predict(
      prior, [&](const Vector<6>& x) -> Vector<6> { return nan * x; }, prior.root));
  EXPECT_THROW(SquareRootFilter(unscentedPoints<6>({0.1, 2, 0})), std::invalid_argument) << "weights below zero";
}

}  // namespace
}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What every sigma-point filter promises: on linear models the Kalman filter's answer, whatever the units, and no
// answer from bad numbers.
#include "sas_motion/filters/sigma_point_filter.hpp"

#include <limits>

#include "sas_motion/filters/kalman_filter.hpp"
#include "support.hpp"

namespace sas_motion {
namespace {

using testing::announced;
using testing::relativeDifference;

struct Ckf : CubatureKalmanFilter<6> {
  Ckf() : SigmaPointFilter(cubaturePoints<6>()) {}
};
struct Ukf : UnscentedKalmanFilter<6> {
  Ukf() : SigmaPointFilter(unscentedPoints<6>({0.5, 2, 0})) {}
};

template <class Filter>
class EverySigmaPointFilter : public ::testing::Test {
 protected:
  Filter filter;
};
using Filters = ::testing::Types<Ckf, Ukf>;
TYPED_TEST_SUITE(EverySigmaPointFilter, Filters);

/// A smooth model without symmetries.
Vector<6> bend(const Vector<6>& x) { return x + 0.1 * (x.array().sin() * x.reverse().array()).matrix(); }
Vector<2> look(const Vector<6>& x) { return {std::hypot(x(0) - 9, x(1)), x(4) * x(5) + x(2)}; }

template <int M, class Filter>
void expectKalmanUpdate(const Filter& filter, Random& random) {
  const auto prior = testing::randomBelief<6>(random);
  auto z = testing::randomMeasurement<6, M>(random);
  z.R = testing::randomCovariance<M>(random);  // correlated
  const Vector<M> reading = z.H * prior.mean + z.innovation;
  const auto expected = KalmanFilter<6>().update(prior, z);
  const auto update = filter.update(
      prior, reading, [&](const Vector<6>& x) -> Vector<M> { return z.H * x; }, z.R);
  EXPECT_LT(relativeDifference(update.belief.mean, expected.belief.mean), 1e-12);
  EXPECT_LT(relativeDifference(update.belief.covariance, expected.belief.covariance), 1e-12);
  EXPECT_LT(relativeDifference(update.innovation, expected.innovation), 1e-12);
  EXPECT_LT(relativeDifference(update.S, expected.S), 1e-12);
  EXPECT_NEAR(update.nis, expected.nis, 1e-12 * (1 + expected.nis));
  EXPECT_EQ(update.verdict, Verdict::Accepted);
}

TYPED_TEST(EverySigmaPointFilter, IsTheKalmanFilterOnALinearModel) {
  Random random = announced(81);
  for (int i = 0; i < 50; ++i) {
    const auto belief = testing::randomBelief<6>(random);
    const Matrix<6> F = testing::randomMatrix<6, 6>(random), Q = testing::randomCovariance<6>(random);
    const auto expected = predictGaussian<6>(belief, {F * belief.mean, F, Q});
    const auto prior = this->filter.predict(
        belief, [&](const Vector<6>& x) -> Vector<6> { return F * x; }, Q);
    ASSERT_TRUE(prior);
    EXPECT_LT(relativeDifference(prior->mean, expected.mean), 1e-12);
    EXPECT_LT(relativeDifference(prior->covariance, expected.covariance), 1e-12);
    EXPECT_EQ(prior->covariance, Matrix<6>(prior->covariance.transpose()));
    expectKalmanUpdate<1>(this->filter, random);
    expectKalmanUpdate<2>(this->filter, random);
    expectKalmanUpdate<4>(this->filter, random);
  }
}

TYPED_TEST(EverySigmaPointFilter, UnitsDoNotMatter) {
  Random random = announced(82);
  Vector<6> scale;
  scale << 1000, 1, 1e-3, 1, 1000, 10;
  const Vector<2> rows(1000, 1e-3);
  const Matrix<6> T = scale.asDiagonal(), T_inverse = scale.cwiseInverse().asDiagonal();
  const auto scaled = [&](const Gaussian<6>& b) { return Gaussian<6>{T * b.mean, T * b.covariance * T}; };
  const auto expectSame = [&](const Gaussian<6>& in_new_units, const Gaussian<6>& b) {
    EXPECT_LT(relativeDifference(T_inverse * in_new_units.mean, b.mean), 1e-12);
    EXPECT_LT(relativeDifference(T_inverse * in_new_units.covariance * T_inverse, b.covariance), 1e-12);
  };
  for (int i = 0; i < 20; ++i) {
    const auto belief = testing::randomBelief<6>(random);
    const Matrix<6> Q = testing::randomCovariance<6>(random);
    const Matrix<2> R = testing::randomCovariance<2>(random), R_scaled = rows.asDiagonal() * R * rows.asDiagonal();
    const Vector<2> z = look(belief.mean) + testing::randomMatrix<2>(random), z_scaled = rows.cwiseProduct(z);
    const auto predicted = this->filter.predict(belief, bend, Q);
    const auto same = this->filter.predict(
        scaled(belief), [&](const Vector<6>& x) -> Vector<6> { return T * bend(T_inverse * x); }, T* Q* T);
    ASSERT_TRUE(predicted && same);
    expectSame(*same, *predicted);
    const auto update = this->filter.update(belief, z, look, R);
    const auto other = this->filter.update(
        scaled(belief), z_scaled,
        [&](const Vector<6>& x) -> Vector<2> { return rows.cwiseProduct(look(T_inverse * x)); }, R_scaled);
    ASSERT_EQ(update.verdict, Verdict::Accepted);
    expectSame(other.belief, update.belief);
    EXPECT_NEAR(other.nis, update.nis, 1e-10 * (1 + update.nis));
  }
}

TYPED_TEST(EverySigmaPointFilter, TheMeanOfAQuadraticIsExactInEveryRotatedFrame) {
  Random random = announced(83);
  for (int i = 0; i < 20; ++i) {
    const auto belief = testing::randomBelief<6>(random);
    const Matrix<6> A = testing::randomMatrix<6, 6>(random);
    const Matrix<6> C = testing::randomMatrix<6, 6>(random).householderQr().householderQ();
    const auto square = [&](const Vector<6>& x) -> Vector<6> { return x * x.dot(Vector<6>::Ones()) + A * x; };
    const auto rotated = this->filter.predict(
        {C * belief.mean, C * belief.covariance * C.transpose()},
        [&](const Vector<6>& x) -> Vector<6> { return C * square(C.transpose() * x); }, Matrix<6>::Identity());
    ASSERT_TRUE(rotated);
    const Vector<6> expected = square(belief.mean) + belief.covariance * Vector<6>::Ones();  // E[x 1'x] = m 1'm + P 1
    EXPECT_LT(relativeDifference(C.transpose() * rotated->mean, expected), 1e-12);
  }
}

TYPED_TEST(EverySigmaPointFilter, RefusesWhatIsNoMeasurementAndStaysAtThePrior) {
  Random random = announced(84);
  const auto prior = testing::randomBelief<6>(random);
  const Matrix<2> R = testing::randomCovariance<2>(random);
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const auto expectRefused = [&](const Gaussian<6>& belief, const Vector<2>& z, const auto& h, const Matrix<2>& noise,
                                 const char* what) {
    const auto update = this->filter.update(belief, z, h, noise);
    EXPECT_EQ(update.verdict, Verdict::Invalid) << what;
    EXPECT_EQ(update.belief.mean, belief.mean) << what;
    EXPECT_EQ(update.belief.covariance, belief.covariance) << what;
  };
  for (const double bad : {nan, inf, -inf}) {
    expectRefused(prior, {bad, 0}, look, R, "z");
    expectRefused(
        prior, {0, 0},
        [bad](const Vector<6>&) -> Vector<2> {
          return {bad, 0};
        },
        R, "h");
    EXPECT_FALSE(this->filter.predict(
        prior, [bad](const Vector<6>& x) -> Vector<6> { return bad * x; }, Matrix<6>::Identity()));
  }
  expectRefused(prior, {0, 0}, look, Matrix<2>(Vector<2>(1, -1).asDiagonal()), "R");
  auto broken = prior;
  broken.covariance(3, 3) = -1;
  expectRefused(broken, {0, 0}, look, R, "P");
  EXPECT_FALSE(this->filter.predict(broken, bend, Matrix<6>::Identity()));
  EXPECT_FALSE(this->filter.predict(prior, bend, -100 * Matrix<6>::Identity()));
}

TYPED_TEST(EverySigmaPointFilter, CovarianceStaysSymmetricAndPositiveOverLongRunsOfPreciseMeasurements) {
  Random random = announced(85);
  Gaussian<6> belief{Vector<6>::Zero(), 100 * Matrix<6>::Identity()};
  for (int i = 0; i < 3000; ++i) {
    const auto prior = this->filter.predict(
        belief, [](const Vector<6>& x) { return x; }, 1e-12 * Matrix<6>::Identity());
    ASSERT_TRUE(prior) << "step " << i;
    const Matrix<2, 6> H = testing::randomMatrix<2, 6>(random);
    const Vector<2> z = 1e-5 * testing::randomMatrix<2>(random);  // truth is zero
    const auto update = this->filter.update(
        *prior, z, [&](const Vector<6>& x) -> Vector<2> { return H * x; }, Matrix<2>(1e-10 * Matrix<2>::Identity()));
    ASSERT_NE(update.verdict, Verdict::Invalid) << "step " << i;
    belief = update.belief;
    ASSERT_EQ(belief.covariance, Matrix<6>(belief.covariance.transpose())) << "step " << i;
    ASSERT_GT(testing::smallestEigenvalue<6>(belief.covariance), 0) << "step " << i;
  }
}

}  // namespace
}  // namespace sas_motion

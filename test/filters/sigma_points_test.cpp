// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/sigma_points.hpp"

#include <limits>

#include "support.hpp"

namespace sas_motion {
namespace {

/// E of the product of powers of the coordinates, under the points.
template <int N, int Count>
double moment(const SigmaPoints<N, Count>& points, const Vector<N>& powers) {
  double sum = 0;
  for (int i = 0; i < Count; ++i) {
    double product = points.mean_weights(i);
    for (int row = 0; row < N; ++row) product *= std::pow(points.offsets(row, i), powers(row));
    sum += product;
  }
  return sum;
}

template <int N, int Count>
void expectStandardNormalToTheThirdDegree(const SigmaPoints<N, Count>& points) {
  EXPECT_NEAR(points.mean_weights.sum(), 1, 1e-13);
  const Vector<N> mean = points.offsets * points.mean_weights;
  const Matrix<N> covariance = points.offsets * points.covariance_weights.asDiagonal() * points.offsets.transpose();
  EXPECT_LT(mean.norm(), 1e-13);
  EXPECT_LT((covariance - Matrix<N>::Identity()).norm(), 1e-13);
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) {
      const Vector<N> powers = 2 * Vector<N>::Unit(i) + Vector<N>::Unit(j);
      EXPECT_NEAR(moment(points, powers), 0, 1e-12) << i << " " << j;
    }
}

TEST(SigmaPoints, HaveTheMomentsOfAStandardNormalToTheThirdDegree) {
  expectStandardNormalToTheThirdDegree(cubaturePoints<1>());
  expectStandardNormalToTheThirdDegree(cubaturePoints<2>());
  expectStandardNormalToTheThirdDegree(cubaturePoints<6>());
  expectStandardNormalToTheThirdDegree(cubaturePoints<16>());
  for (const auto& options :
       {UnscentedOptions{}, UnscentedOptions{0.5, 2, 0}, UnscentedOptions{0.1, 0, 3}, UnscentedOptions{1, 2, -1}}) {
    expectStandardNormalToTheThirdDegree(unscentedPoints<2>(options));
    expectStandardNormalToTheThirdDegree(unscentedPoints<6>(options));
  }
}

TEST(SigmaPoints, UnscentedWithoutWeightOnTheMeanAreTheCubaturePoints) {
  const auto unscented = unscentedPoints<6>({1, 0, 0});
  const auto cubature = cubaturePoints<6>();
  EXPECT_EQ(unscented.mean_weights(0), 0);
  EXPECT_EQ(unscented.covariance_weights(0), 0);
  EXPECT_LT((unscented.offsets.rightCols<12>() - cubature.offsets).norm(), 1e-15);
  EXPECT_LT((unscented.mean_weights.tail<12>() - cubature.mean_weights).norm(), 1e-15);
}

TEST(SigmaPoints, WithAlphaOneAndKappaThreeMinusNTheFourthMomentOfAnAxisIsThree) {
  EXPECT_NEAR(moment(unscentedPoints<2>({1, 2, 1}), Vector<2>(4, 0)), 3, 1e-12);
  EXPECT_NEAR(moment(unscentedPoints<6>({1, 2, -3}), Vector<6>(4 * Vector<6>::Unit(2))), 3, 1e-12);
}

template <int N>
void expectStandardNormalToTheSecondDegree() {
  for (const double W0 : {0.0, 0.3, 0.9}) {
    const auto points = simplexPoints<N>(W0);
    EXPECT_NEAR(points.mean_weights.sum(), 1, 1e-13);
    EXPECT_LT((points.offsets * points.mean_weights).norm(), 1e-13) << N;
    EXPECT_LT(
        (points.offsets * points.covariance_weights.asDiagonal() * points.offsets.transpose() - Matrix<N>::Identity())
            .norm(),
        1e-13)
        << N;
    EXPECT_EQ(points.offsets.col(0).norm(), 0);
    for (int i = 1; i < N + 2; ++i)
      EXPECT_NEAR(points.offsets.col(i).norm(), std::sqrt(N / (1 - W0)), 1e-12) << "a corner of the sphere";
  }
}

TEST(SigmaPoints, OfTheSphericalSimplexHaveTheMomentsOfAStandardNormalToTheSecondDegree) {
  expectStandardNormalToTheSecondDegree<1>();
  expectStandardNormalToTheSecondDegree<2>();
  expectStandardNormalToTheSecondDegree<3>();
  expectStandardNormalToTheSecondDegree<16>();
}

TEST(SigmaPoints, OfTheSphericalSimplexAreTheTriangleInThePlane) {
  Matrix<2, 4> triangle;
  triangle << 0, -std::sqrt(1.5), std::sqrt(1.5), 0,  //
      0, -std::sqrt(0.5), -std::sqrt(0.5), std::sqrt(2.0);
  EXPECT_LT((simplexPoints<2>(0).offsets - triangle).norm(), 1e-15);
  EXPECT_THROW(simplexPoints<2>(1), std::invalid_argument);
  EXPECT_THROW(simplexPoints<2>(-0.1), std::invalid_argument);
}

TEST(SigmaPoints, RefuseASpreadThatIsNone) {
  EXPECT_THROW(unscentedPoints<6>({0, 2, 0}), std::invalid_argument);
  EXPECT_THROW(unscentedPoints<6>({1, 2, -6}), std::invalid_argument);
  EXPECT_THROW(unscentedPoints<6>({std::numeric_limits<double>::quiet_NaN(), 2, 0}), std::invalid_argument);
  EXPECT_THROW(unscentedPoints<6>({1, std::numeric_limits<double>::infinity(), 0}), std::invalid_argument);
}

}  // namespace
}  // namespace sas_motion

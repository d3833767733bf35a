// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/math/factorization.hpp"

#include "sas_motion/math/stamp.hpp"
#include "support.hpp"

namespace sas_motion {
namespace {

TEST(Factorization, RootsGiveTheMatrixBack) {
  Random random = testing::announced(4);
  const Matrix<6> A = testing::randomCovariance<6>(random);
  const auto L = choleskyLower<6>(A), root = symmetricSqrt<6>(A);
  ASSERT_TRUE(L && root);
  EXPECT_LT(testing::relativeDifference(*L * L->transpose(), A), 1e-14);
  EXPECT_LT(testing::relativeDifference(*root * *root, A), 1e-13);
  EXPECT_LT(testing::relativeDifference(*root, root->transpose()), 1e-13);
}

TEST(Factorization, WhatIsNoCovarianceHasNoRoot) {
  Matrix<2> A;
  for (const double corner : {-1.0, std::nan(""), HUGE_VAL}) {
    A << 1, 0, 0, corner;
    EXPECT_FALSE(choleskyLower<2>(A)) << corner;
    EXPECT_FALSE(symmetricSqrt<2>(A)) << corner;
  }
  A << 1, 2, 2, 1;  // indefinite with positive diagonal
  EXPECT_FALSE(choleskyLower<2>(A));
  EXPECT_FALSE(symmetricSqrt<2>(A));
  EXPECT_FALSE(symmetricSqrt<2>(Matrix<2>::Constant(std::nan(""))));
}

TEST(Factorization, SymmetrizeAveragesTheHalves) {
  Matrix<2> A;
  A << 1, 2, 4, 5;
  symmetrize(A);
  EXPECT_EQ(A(0, 1), 3);
  EXPECT_EQ(A(1, 0), 3);
}

TEST(Stamp, SecondsAndNanosecondsAgree) {
  EXPECT_EQ(stampFromSeconds(1.5), 1'500'000'000);
  EXPECT_EQ(stampFromSeconds(-0.1), -100'000'000);
  EXPECT_EQ(stampFromSeconds(0.1 + 0.2), 300'000'000);  // rounded, not cut
  const Stamp begin = 1'700'000'000'000'000'001;
  EXPECT_DOUBLE_EQ(secondsBetween(begin, begin + 1), 1e-9);
  EXPECT_DOUBLE_EQ(secondsBetween(begin + 1, begin), -1e-9);
}

}  // namespace
}  // namespace sas_motion

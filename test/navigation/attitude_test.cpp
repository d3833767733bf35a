// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/navigation/attitude.hpp"

#include "sas_motion/math/angles.hpp"
#include "support.hpp"

namespace sas_motion {
namespace {

TEST(Attitude, HasTheTextbooksMatrix) {
  const double p = 0.3, r = -0.5, h = 2.1;
  const double cp = std::cos(p), sp = std::sin(p), cr = std::cos(r), sr = std::sin(r), ch = std::cos(h),
               sh = std::sin(h);
  Matrix<3> expected;
  expected << cr * ch + sr * sp * sh, cp * sh, sr * ch - cr * sp * sh,  //
      -cr * sh + sr * sp * ch, cp * ch, -sr * sh - cr * sp * ch,        //
      -sr * cp, sp, cr * cp;
  EXPECT_LT((rotationOf({p, r, h}) - expected).norm(), 1e-15);
}

TEST(Attitude, ABowUpAndAStarboardSideDownAreSeenAsSuch) {
  EXPECT_GT((rotationOf({0.1, 0, 0}) * Vector<3>::UnitY())(2), 0) << "pitch lifts the bow";
  EXPECT_LT((rotationOf({0, 0.1, 0}) * Vector<3>::UnitX())(2), 0) << "roll lowers starboard";
  EXPECT_GT((rotationOf({0, 0, 0.1}) * Vector<3>::UnitY())(0), 0) << "heading turns the bow to the east";
}

TEST(Attitude, ComesBackFromItsMatrix) {
  Random random = testing::announced(1);
  for (int i = 0; i < 100; ++i) {
    const Attitude attitude{(random.uniform() - 0.5) * 3, (random.uniform() - 0.5) * 6, (random.uniform() - 0.5) * 6.2};
    const Attitude back = attitudeOf(rotationOf(attitude));
    EXPECT_NEAR(back.pitch, attitude.pitch, 1e-12);
    EXPECT_NEAR(back.roll, attitude.roll, 1e-12);
    EXPECT_NEAR(back.heading, attitude.heading, 1e-12);
  }
}

TEST(Attitude, RosBodyAxesAreTheSameVectorsInOtherComponents) {
  const Matrix<3> C = bodyFromRosBody();
  EXPECT_EQ(C * Vector<3>(1, 0, 0), Vector<3>(0, 1, 0)) << "forward";
  EXPECT_EQ(C * Vector<3>(0, 1, 0), Vector<3>(-1, 0, 0)) << "port";
  EXPECT_NEAR(C.determinant(), 1, 1e-15);
}

}  // namespace
}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A block of square-root filters by vector instructions gives the answers of each filter alone, with every set of
// instructions, and its lanes do not touch each other.
#include "sas_motion/filters/particles/simplex_blocks.hpp"

#include <limits>
#include <vector>

#include "parallel/instruction_sets.hpp"
#include "sas_motion/math/angles.hpp"
#include "support.hpp"

namespace sas_motion {
namespace {

using testing::announced;
using testing::relativeDifference;

constexpr double kRounding = 1e-12;
constexpr int kFull = blocks::kLanes;

/// Turns and bends.
template <int N>
Vector<N> bend(const Vector<N>& x) {
  return 0.9 * x + 0.1 * (x.array().sin() * (1 + x.reverse().array())).matrix();
}
template <int N, int M>
Vector<M> look(const Vector<N>& x) {
  Vector<M> z;
  for (int row = 0; row < M; ++row) z(row) = std::hypot(3 + x(row % N), x((row + 1) % N)) + x(N - 1);
  return z;
}

template <int N>
using Beliefs = std::vector<RootGaussian<N>>;

/// The first of them is well known in half its states, the second exactly, so that their roots have lost rank.
template <int N>
Beliefs<N> randomBeliefs(Random& random, int count) {
  Beliefs<N> beliefs;
  for (int k = 0; k < count; ++k) {
    const auto belief = testing::randomBelief<N>(random);
    beliefs.push_back({belief.mean, choleskyLower<N>(belief.covariance).value()});
    if (k == 0) beliefs[0].root.bottomRows(N / 2) *= 1e-6;
    if (k == 1) beliefs[1].root.bottomRows(N / 2).setZero();
  }
  return beliefs;
}

/// A step of each, by `filter`: the beliefs after a prediction, after a reading, and what that says of their weights.
template <int N>
struct Step {
  Beliefs<N> predicted, updated;
  std::vector<double> likelihoods;
  std::vector<int> lost;
};

template <int N, int M, class Filter, class Difference = PlainDifference>
Step<N> stepOf(const Filter& filter, const Beliefs<N>& beliefs, const Matrix<N>& Q_root,
               const Difference& difference = {}) {
  Step<N> step{beliefs, {}, std::vector<double>(beliefs.size()), {}};
  const int count = static_cast<int>(beliefs.size());
  const auto of = [](Beliefs<N>& all) {
    return [&all](int k) -> RootGaussian<N>& { return all[static_cast<std::size_t>(k)]; };
  };
  filter.predict(count, of(step.predicted), bend<N>, Q_root, [&](int k) { step.lost.push_back(k); });
  step.updated = step.predicted;
  const Matrix<M> R_root = Vector<M>::LinSpaced(0.3, 0.4).asDiagonal();
  filter.template update<M>(
      count, of(step.updated), Vector<M>(Vector<M>::LinSpaced(2.5, 3.5)), look<N, M>, R_root, difference,
      [&](int k, double log_likelihood) { step.likelihoods[static_cast<std::size_t>(k)] = log_likelihood; });
  return step;
}

template <int N>
void expectSame(const RootGaussian<N>& belief, const RootGaussian<N>& expected) {
  EXPECT_LT(relativeDifference(belief.mean, expected.mean), kRounding);
  EXPECT_LT(relativeDifference(gaussian(belief).covariance, gaussian(expected).covariance), kRounding);
  EXPECT_TRUE(belief.root.isLowerTriangular(0));
}

template <int N, int M, class Difference = PlainDifference>
void expectEachAlone(int count, const Matrix<N>& Q_root, const Difference& difference = {}) {
  Random random(static_cast<std::uint64_t>(100 * N + count));
  const auto beliefs = randomBeliefs<N>(random, count);
  const auto points = simplexPoints<N>(0.2);
  const auto together = stepOf<N, M>(SimplexBlocks<N>(points), beliefs, Q_root, difference);
  const auto alone = stepOf<N, M>(OneByOne(SimplexFilter<N>(points)), beliefs, Q_root, difference);
  ASSERT_TRUE(together.lost.empty());
  for (std::size_t k = 0; k < beliefs.size(); ++k) {
    SCOPED_TRACE(std::to_string(N) + " states, " + std::to_string(count) + " particles, number " + std::to_string(k));
    expectSame<N>(together.predicted[k], alone.predicted[k]);
    expectSame<N>(together.updated[k], alone.updated[k]);
    EXPECT_NEAR(together.likelihoods[k], alone.likelihoods[k], kRounding * (1 + std::abs(alone.likelihoods[k])));
  }
}

template <int N, int M>
void expectEachAlone() {
  for (const int count : {kFull, kFull - 1, 3, 2, 1}) {
    expectEachAlone<N, M>(count, 0.1 * Matrix<N>::Identity());
    expectEachAlone<N, M>(count, Matrix<N>::Zero());
  }
}

TEST(SimplexBlocks, EqualEachFilterAloneOnEveryTarget) {
  forEachInstructionSet([] {
    SCOPED_TRACE(blocks::target());
    expectEachAlone<1, 1>();
    expectEachAlone<2, 1>();
    expectEachAlone<3, 6>();
    expectEachAlone<16, 4>();
    expectEachAlone<19, 4>();
  });
}

TEST(SimplexBlocks, CompareAnglesAsTheyAreTold) {
  const auto wrapped = [](const Vector<3>& a, const Vector<3>& b) {
    return Vector<3>(wrapAngle(a(0) - b(0)), a(1) - b(1), a(2) - b(2));
  };
  expectEachAlone<2, 3>(5, Matrix<2>(0.1 * Matrix<2>::Identity()), wrapped);
}

TEST(SimplexBlocks, GoOnByTheFilterAloneWhereARootCannotBeDowndated) {
  // GIVEN particles of which some know everything exactly, so that taking a square out leaves nothing positive
  Random random = announced(65);
  auto beliefs = randomBeliefs<16>(random, kFull);
  for (const std::size_t k : {2u, 5u}) beliefs[k].root.setZero();
  const SimplexBlocks<16> filter(simplexPoints<16>(0.2));
  // WHEN they read THEN what they know stays, and they are weighed as they are alone
  const auto step = stepOf<16, 4>(filter, beliefs, Matrix<16>::Zero());
  const Vector<4> z = Vector<4>::LinSpaced(2.5, 3.5);
  const Matrix<4> R_root = Vector<4>::LinSpaced(0.3, 0.4).asDiagonal();
  for (const std::size_t k : {2u, 5u}) {
    EXPECT_EQ(step.updated[k].mean, step.predicted[k].mean);
    EXPECT_EQ(step.updated[k].root, (Matrix<16>::Zero()));
    EXPECT_NEAR(step.likelihoods[k], logDensity<4>(z - look<16, 4>(step.predicted[k].mean), R_root), 1e-9);
  }
}

TEST(SimplexBlocks, KeepToTheirLanes) {
  Random random = announced(66);
  const auto beliefs = randomBeliefs<19>(random, kFull);
  const SimplexBlocks<19> filter(simplexPoints<19>(0.2));
  const Matrix<19> Q_root = 0.1 * Matrix<19>::Identity();
  const auto expected = stepOf<19, 4>(filter, beliefs, Q_root);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t bad = 0; bad < kFull; ++bad)
    for (const double value : {nan, 1e300, -std::numeric_limits<double>::infinity()}) {
      auto spoilt = beliefs;
      spoilt[bad].mean(7) = value;
      spoilt[bad].root(9, 3) = value;
      const auto step = stepOf<19, 4>(filter, spoilt, Q_root);
      EXPECT_EQ(step.lost, std::vector<int>{static_cast<int>(bad)});
      EXPECT_TRUE(std::isnan(step.likelihoods[bad]));
      for (std::size_t k = 0; k < kFull; ++k) {
        if (k == bad) continue;
        EXPECT_EQ(step.updated[k].mean, expected.updated[k].mean);
        EXPECT_EQ(step.updated[k].root, expected.updated[k].root);
        EXPECT_EQ(step.likelihoods[k], expected.likelihoods[k]);
      }
    }
}

TEST(SimplexBlocks, AddTheMomentsOfAMixture) {
  Random random = announced(67);
  forEachInstructionSet([&] {
    SCOPED_TRACE(blocks::target());
    for (const int count : {1, 7, 8, 21}) {
      auto beliefs = randomBeliefs<19>(random, count);
      const auto of = [&](int k) -> const RootGaussian<19>& { return beliefs[static_cast<std::size_t>(k)]; };
      const auto weight = [](int k) { return 0.1 + k; };
      const Vector<19> mean = testing::randomMatrix<19>(random);
      Matrix<19> together = Matrix<19>::Identity(), alone = together;
      SimplexBlocks<19>(simplexPoints<19>(0.2)).addMoments(count, of, weight, mean, together);
      OneByOne(SimplexFilter<19>(simplexPoints<19>(0.2))).addMoments(count, of, weight, mean, alone);
      EXPECT_LT(relativeDifference(together, alone), kRounding) << count << " particles";
    }
  });
}

}  // namespace
}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Particle filters against the Kalman filter, on the textbook's problems, and with numbers that are none. Bands are
// over fixed seeds.
#include <limits>

#include "sas_motion/filters/kalman_filter.hpp"
#include "sas_motion/filters/particles/particle_filter.hpp"
#include "sas_motion/filters/particles/simplex_blocks.hpp"
#include "sas_motion/filters/particles/unscented_particle_filter.hpp"
#include "sas_motion/filters/sigma_point_filter.hpp"
#include "sas_motion/math/angles.hpp"
#include "support.hpp"

namespace sas_motion {
namespace {

using testing::announced;

template <int N>
using Upf = UnscentedParticleFilter<N, OneByOne<UnscentedKalmanFilter<N>>>;
template <int N>
using SsSrupf = UnscentedParticleFilter<N, SimplexBlocks<N>>;

ParticleOptions options(int particles, std::uint64_t seed = 1, int threads = 1) {
  ParticleOptions all;
  all.particles = particles;
  all.seed = seed;
  all.threads = threads;
  return all;
}

template <int N>
Upf<N> upf(const ParticleOptions& particles, Weighting weighting = Weighting::Mixture) {
  UnscentedParticleOptions all;
  static_cast<ParticleOptions&>(all) = particles;
  all.weighting = weighting;
  return {OneByOne(UnscentedKalmanFilter<N>(unscentedPoints<N>({1, 0, 1}))), all};
}

template <int N>
SsSrupf<N> ssSrupf(const ParticleOptions& particles, Weighting weighting = Weighting::Mixture) {
  UnscentedParticleOptions all;
  static_cast<ParticleOptions&>(all) = particles;
  all.weighting = weighting;
  return {SimplexBlocks<N>(simplexPoints<N>(0.2)), all};
}

/// A walk with a velocity, whose position is read.
struct Walk {
  Matrix<2> F = (Matrix<2>() << 1, 0.5, 0, 1).finished();
  Matrix<2> Q_root = (Matrix<2>() << 0.2, 0, 0.1, 0.2).finished();
  Eigen::Matrix<double, 1, 2> H{1, 0};
  Matrix<1> R = Matrix<1>(0.25);
  Vector<2> move(const Vector<2>& x) const { return F * x; }
  Vector<1> read(const Vector<2>& x) const { return H * x; }
};

/// The mean over seeds of the squared distance of a filter's mean from the Kalman filter's, in the latter's covariance,
/// after 30 readings; and of the ratio of their variances of the position.
struct Distance {
  double mean_square = 0, variance_ratio = 0;
};

template <class Make>
Distance distanceFromTheKalmanFilter(const Make& make, int seeds) {
  const Walk walk;
  Distance distance;
  for (int seed = 1; seed <= seeds; ++seed) {
    Random random(static_cast<std::uint64_t>(seed), 5);
    auto filter = make(static_cast<std::uint64_t>(seed));
    Gaussian<2> exact;
    EXPECT_TRUE(filter.start(exact));
    Vector<2> truth = testing::randomMatrix<2>(random);
    for (int k = 0; k < 30; ++k) {
      truth = walk.move(truth) + walk.Q_root * testing::randomMatrix<2>(random);
      const Vector<1> z = walk.read(truth) + Vector<1>(0.5 * random.gaussian());
      exact = predictGaussian<2>(exact, {walk.F * exact.mean, walk.F, walk.Q_root * walk.Q_root.transpose()});
      exact = KalmanFilter<2>()
                  .update(exact, LinearMeasurement<2, 1>{Vector<1>(z - walk.H * exact.mean), walk.H, walk.R})
                  .belief;
      filter.predict([&](const Vector<2>& x) { return walk.move(x); }, walk.Q_root);
      const auto update = filter.update(
          z, [&](const Vector<2>& x) { return walk.read(x); }, walk.R);
      EXPECT_EQ(update.verdict, Verdict::Accepted);
    }
    const Gaussian<2> belief = filter.belief();
    const Vector<2> offset = belief.mean - exact.mean;
    distance.mean_square += offset.dot(exact.covariance.llt().solve(offset)) / (2 * seeds);
    distance.variance_ratio += belief.covariance(0, 0) / exact.covariance(0, 0) / seeds;
  }
  return distance;
}

TEST(ParticleFilters, AgreeWithTheKalmanFilterOnALinearModelWithinWhatTheyDraw) {
  const int particles = 1000;
  const auto expectNear = [&](const char* name, const Distance& distance, double draws) {
    std::cout << name << ": squared distance " << distance.mean_square << " of its variance, variance ratio "
              << distance.variance_ratio << "\n";
    EXPECT_LT(distance.mean_square, draws / particles) << name;
    EXPECT_NEAR(distance.variance_ratio, 1, 0.03) << name;
  };
  const auto bootstrap = [&](std::uint64_t seed) { return ParticleFilter<2>(options(particles, seed)); };
  expectNear("pf", distanceFromTheKalmanFilter(bootstrap, 20), 8);
  const auto mixture = [&](std::uint64_t seed) { return ssSrupf<2>(options(particles, seed)); };
  expectNear("ss_srupf", distanceFromTheKalmanFilter(mixture, 20), 2);
  const auto unscented = [&](std::uint64_t seed) { return upf<2>(options(particles, seed)); };
  expectNear("upf", distanceFromTheKalmanFilter(unscented, 10), 2);
  const auto optimal = [&](std::uint64_t seed) {
    return ssSrupf<2>(options(particles, seed), Weighting::OptimalProposal);
  };
  expectNear("ss_srupf, optimal proposal", distanceFromTheKalmanFilter(optimal, 20), 8);
}

TEST(ParticleFilters, RoughenedParticlesHaveTheNoiseBesideWhatTheyHad) {
  const Matrix<2> noise_root = (Matrix<2>() << 0.5, 0, 2, 1).finished(),
                  sum = Matrix<2>::Identity() + noise_root * noise_root.transpose();
  const auto covarianceOf = [&](auto filter) -> Matrix<2> {
    EXPECT_TRUE(filter.start({}));
    filter.roughen(noise_root);
    return filter.belief().covariance;
  };
  EXPECT_LT(testing::relativeDifference(covarianceOf(ParticleFilter<2>(options(20000))), sum), 0.05);
  EXPECT_LT(testing::relativeDifference(covarianceOf(upf<2>(options(20000))), sum), 0.05);
  EXPECT_LT(testing::relativeDifference(covarianceOf(ssSrupf<2>(options(20000))), sum), 0.05);
  EXPECT_LT(testing::relativeDifference(covarianceOf(upf<2>(options(1))), sum), 1e-12)
      << "one particle is widened instead";
  EXPECT_LT(testing::relativeDifference(covarianceOf(ssSrupf<2>(options(1))), sum), 1e-12);
}

TEST(ParticleFilters, RoughenedPointsCountTheirNoiseOnce) {
  // GIVEN points roughened as widely as a whole prediction would draw them, WHEN z is read, THEN the answer is the
  // Kalman filter's of the same noise
  const Walk walk;
  const Matrix<2> wide = (Matrix<2>() << 1.5, 0, 0, 0.5).finished();
  auto filter = ssSrupf<2>(options(20000), Weighting::OptimalProposal);
  EXPECT_TRUE(filter.start({}));
  filter.roughen(wide);
  filter.predict([&](const Vector<2>& x) { return walk.move(x); }, walk.Q_root);
  Gaussian<2> exact{Vector<2>::Zero(), Matrix<2>::Identity() + wide * wide.transpose()};
  exact = predictGaussian<2>(exact, {walk.F * exact.mean, walk.F, walk.Q_root * walk.Q_root.transpose()});
  const Vector<1> z(1.5);
  exact = KalmanFilter<2>()
              .update(exact, LinearMeasurement<2, 1>{Vector<1>(z - walk.H * exact.mean), walk.H, walk.R})
              .belief;
  filter.update(
      z, [&](const Vector<2>& x) { return walk.read(x); }, walk.R);
  EXPECT_LT((filter.belief().mean - exact.mean).norm(), 0.05);
  EXPECT_LT(testing::relativeDifference(filter.belief().covariance, exact.covariance), 0.05);
}

TEST(ParticleFilters, OneParticleIsItsFilterAlone) {
  const auto alone = [](std::uint64_t seed) { return ssSrupf<2>(options(1, seed)); };
  const Distance distance = distanceFromTheKalmanFilter(alone, 3);
  EXPECT_LT(distance.mean_square, 1e-20);
  EXPECT_NEAR(distance.variance_ratio, 1, 1e-10);
  EXPECT_THROW(ssSrupf<2>(options(0)), std::invalid_argument);
  EXPECT_THROW(ParticleFilter<2>(options(0)), std::invalid_argument);
  EXPECT_THROW(ParticleFilter<2>(options(-3)), std::invalid_argument);
  ParticleFilter<2> lonely(options(1));
  ASSERT_TRUE(lonely.start({}));
  lonely.predict([](const Vector<2>& x) { return x; }, Matrix<2>::Identity());
  EXPECT_EQ(lonely
                .update(
                    Vector<1>(0.3), [](const Vector<2>& x) { return Vector<1>(x(0)); }, Matrix<1>(1))
                .effective_size,
            1);
}

template <class Filter>
Gaussian<2> walkTo(Filter filter, int steps) {
  const Walk walk;
  EXPECT_TRUE(filter.start({}));
  for (int k = 0; k < steps; ++k) {
    filter.predict([&](const Vector<2>& x) { return walk.move(x); }, walk.Q_root);
    filter.update(
        Vector<1>(std::sin(0.3 * k)), [&](const Vector<2>& x) { return walk.read(x); }, walk.R);
  }
  return filter.belief();
}

template <class Make>
void expectTheSameOnAnyNumberOfThreads(const Make& make) {
  const Gaussian<2> one = walkTo(make(1), 20);
  for (const int threads : {2, 5}) {
    const Gaussian<2> more = walkTo(make(threads), 20);
    EXPECT_EQ(one.mean, more.mean);
    EXPECT_EQ(one.covariance, more.covariance);
  }
}

TEST(ParticleFilters, GiveTheSameBitsOnAnyNumberOfThreads) {
  expectTheSameOnAnyNumberOfThreads([](int threads) { return ParticleFilter<2>(options(333, 4, threads)); });
  for (const auto weighting : {Weighting::Mixture, Weighting::OptimalProposal, Weighting::Literal})
    expectTheSameOnAnyNumberOfThreads([&](int threads) { return ssSrupf<2>(options(333, 4, threads), weighting); });
}

TEST(ParticleFilters, ACopyGoesOnAsItsOriginalAndApartFromIt) {
  const Walk walk;
  const auto step = [&](SsSrupf<2>& filter, double z) {
    filter.predict([&](const Vector<2>& x) { return walk.move(x); }, walk.Q_root);
    filter.update(
        Vector<1>(z), [&](const Vector<2>& x) { return walk.read(x); }, walk.R);
  };
  auto original = ssSrupf<2>(options(100, 3, 2));
  ASSERT_TRUE(original.start({}));
  step(original, 0.5);
  auto copy = original;
  const Gaussian<2> before = copy.belief();
  step(original, 0.7);
  EXPECT_EQ(copy.belief().mean, before.mean);
  step(copy, 0.7);
  EXPECT_EQ(copy.belief().mean, original.belief().mean);
  EXPECT_EQ(copy.belief().covariance, original.belief().covariance);
  EXPECT_EQ(copy.mean(), copy.belief().mean);
}

/// x' = x / 2 + 25 x / (1 + x^2) + 8 cos(1.2 k) + w, z = x^2 / 20 + v, of variances 10 and 1: two answers to most
/// readings. [Gordon1993, 4.1]
template <class Make>
double growthError(const Make& make, int seeds) {
  double square = 0;
  constexpr int kSteps = 50;
  for (int seed = 1; seed <= seeds; ++seed) {
    Random random(static_cast<std::uint64_t>(seed), 6);
    auto filter = make(static_cast<std::uint64_t>(seed));
    filter.start({Vector<1>::Zero(), Matrix<1>(2)});
    double x = std::sqrt(2.0) * random.gaussian();
    for (int k = 1; k <= kSteps; ++k) {
      const auto f = [&](const Vector<1>& y) {
        return Vector<1>(y(0) / 2 + 25 * y(0) / (1 + y(0) * y(0)) + 8 * std::cos(1.2 * k));
      };
      x = f(Vector<1>(x))(0) + std::sqrt(10.0) * random.gaussian();
      filter.predict(f, Matrix<1>(std::sqrt(10.0)));
      filter.update(
          Vector<1>(x * x / 20 + random.gaussian()), [](const Vector<1>& y) { return Vector<1>(y(0) * y(0) / 20); },
          Matrix<1>(1));
      square += std::pow(filter.belief().mean(0) - x, 2) / (kSteps * seeds);
    }
  }
  return std::sqrt(square);
}

TEST(ParticleFilters, FollowTheUnivariateGrowthModelWhereOneGaussianDoesNot) {
  const double pf = growthError([](std::uint64_t seed) { return ParticleFilter<1>(options(500, seed)); }, 40);
  const double many = growthError([](std::uint64_t seed) { return ParticleFilter<1>(options(5000, seed)); }, 40);
  const double proposal =
      growthError([](std::uint64_t seed) { return upf<1>(options(500, seed), Weighting::OptimalProposal); }, 40);
  const double alone = growthError([](std::uint64_t) { return upf<1>(options(1)); }, 40);
  std::cout << "growth model, RMSE: pf " << pf << ", of 5000 " << many << ", upf " << proposal << ", ukf " << alone
            << "\n";
  EXPECT_LT(pf, 1.05 * many) << "500 are enough [Gordon1993]";
  EXPECT_LT(proposal, 1.15 * many);
  EXPECT_GT(alone, 1.7 * many);
}

/// A vessel that is heard, its bearing read from a listener that zigzags: position and velocity of the vessel.
/// [Gordon1993, 4.2]
template <class Filter>
double bearingsError(Filter filter, std::uint64_t seed) {
  constexpr double kSigma = 0.01;
  Random random(seed, 7);
  const Gaussian<4> start{Vector<4>(0, 10, 0.3, 0.1), Vector<4>(4, 4, 0.04, 0.04).asDiagonal()};
  Vector<4> truth = start.mean + start.covariance.cwiseSqrt() * testing::randomMatrix<4>(random);
  filter.start(start);
  const auto f = [](const Vector<4>& x) -> Vector<4> { return x + Vector<4>(x(2), x(3), 0, 0); };
  const Matrix<4> Q_root = Vector<4>(0.005, 0.005, 0.01, 0.01).asDiagonal();
  const auto wrapped = [](const Vector<1>& a, const Vector<1>& b) { return Vector<1>(wrapAngle(a(0) - b(0))); };
  double square = 0;
  for (int k = 1; k <= 40; ++k) {
    const Vector<2> listener(0.2 * k + 3 * std::sin(0.3 * k), 2 * std::sin(0.2 * k));
    const auto h = [&](const Vector<4>& x) { return Vector<1>(std::atan2(x(1) - listener(1), x(0) - listener(0))); };
    truth = f(truth) + Q_root * testing::randomMatrix<4>(random);
    filter.predict(f, Q_root);
    filter.update(Vector<1>(wrapAngle(h(truth)(0) + kSigma * random.gaussian())), h, Matrix<1>(kSigma * kSigma),
                  wrapped);
    if (k > 30) square += (filter.belief().mean - truth).template head<2>().squaredNorm() / 10;
  }
  return std::sqrt(square);
}

TEST(ParticleFilters, TrackByBearingsAlone) {
  std::vector<double> pf, mixture;
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    pf.push_back(bearingsError(ParticleFilter<4>(options(3000, seed)), seed));
    mixture.push_back(bearingsError(ssSrupf<4>(options(100, seed)), seed));
  }
  std::cout << "bearings only, median error: pf " << quantile(pf, 0.5) << " m, ss_srupf " << quantile(mixture, 0.5)
            << " m of 2.8 at the start\n";
  EXPECT_LT(quantile(pf, 0.5), 0.7);
  EXPECT_LT(quantile(mixture, 0.5), 0.7);
  EXPECT_LT(rootMeanSquare(mixture), rootMeanSquare(pf)) << "with a thirtieth of the particles";
}

TEST(ParticleFilters, TheLiteralWeightsCollapseWhereTheMixturesDoNot) {
  // GIVEN states that hardly move and are well known by each particle's own filter
  const auto effective = [](Weighting weighting) {
    auto filter = ssSrupf<6>(options(300), weighting);
    EXPECT_TRUE(filter.start({}));
    std::vector<double> sizes;
    Random random(9);
    for (int k = 0; k < 20; ++k) {
      filter.predict([](const Vector<6>& x) { return x; }, Matrix<6>(1e-3 * Matrix<6>::Identity()));
      const Vector<2> z = testing::randomMatrix<2>(random);
      sizes.push_back(
          filter
              .update(
                  z, [](const Vector<6>& x) -> Vector<2> { return x.head<2>(); }, Matrix<2>(Matrix<2>::Identity()))
              .effective_size);
    }
    return quantile(sizes, 0.5);
  };
  EXPECT_LT(effective(Weighting::Literal), 15);
  EXPECT_GT(effective(Weighting::Mixture), 150);
  EXPECT_GT(effective(Weighting::OptimalProposal), 100);
}

/// `start` begins with a standard normal belief, and returns whether it could.
template <class Filter, class Start>
void expectItRecovers(Filter filter, const Start& start) {
  const auto still = [](const Vector<2>& x) { return x; };
  const auto read = [](const Vector<2>& x) { return Vector<1>(x(0)); };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Matrix<2> Q_root = 0.1 * Matrix<2>::Identity();
  ASSERT_FALSE(filter.start({Vector<2>::Zero(), Matrix<2>::Zero()})) << "a belief without rank is none to draw from";
  ASSERT_TRUE(start(filter));
  filter.predict(still, Q_root);
  // readings that are none leave everything as it is
  const Gaussian<2> before = filter.belief();
  EXPECT_EQ(filter.update(Vector<1>(nan), read, Matrix<1>(1)).verdict, Verdict::Invalid);
  EXPECT_EQ(filter.update(Vector<1>(0.0), read, Matrix<1>(-1)).verdict, Verdict::Invalid);
  EXPECT_EQ(filter.update(Vector<1>(0.0), read, Matrix<1>(nan)).verdict, Verdict::Invalid);
  EXPECT_EQ(filter.belief().mean, before.mean);
  // likelihoods of nothing at all: reported, and the particles stay
  EXPECT_EQ(filter.update(Vector<1>(1e200), read, Matrix<1>(1e-3)).verdict, Verdict::Invalid);
  EXPECT_TRUE(filter.belief().mean.allFinite());
  // some particles come to where numbers are not finite: the others go on
  filter.predict([&](const Vector<2>& x) -> Vector<2> { return x(0) > 0.5 ? Vector<2>(nan * x) : x; }, Q_root);
  const auto update = filter.update(Vector<1>(0.1), read, Matrix<1>(1));
  EXPECT_NE(update.verdict, Verdict::Invalid);
  for (int k = 0; k < 20; ++k) {
    filter.predict(still, Q_root);
    filter.update(Vector<1>(0.1), read, Matrix<1>(0.04));
  }
  EXPECT_NEAR(filter.belief().mean(0), 0.1, 0.15);
  EXPECT_LT(filter.belief().covariance(0, 0), 0.04);
}

TEST(ParticleFilters, RecoverFromNumbersThatAreNone) {
  const auto whole = [](auto& filter) { return filter.start({}); };
  const auto narrow = [](auto& filter) {
    return filter.start({}, 0.1 * Matrix<2>::Identity());
  };  // Gaussians that do not all reach where numbers end
  expectItRecovers(ParticleFilter<2>(options(400)), whole);
  expectItRecovers(upf<2>(options(100)), narrow);
  for (const auto weighting : {Weighting::Mixture, Weighting::OptimalProposal, Weighting::Literal})
    expectItRecovers(ssSrupf<2>(options(100), weighting), narrow);
}

TEST(ParticleFilters, RedescendingLossStandsOutliers) {
  const auto error = [](const std::optional<Loss>& loss, double outliers) {
    const Walk walk;
    double square = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      auto robust = options(100, seed);
      robust.loss = loss;
      auto filter = ssSrupf<2>(robust);
      filter.start({});
      Random random(seed, 8), bad(seed, 9);
      Vector<2> truth = testing::randomMatrix<2>(random);
      for (int k = 0; k < 100; ++k) {
        truth = walk.move(truth) + walk.Q_root * testing::randomMatrix<2>(random);
        const double sigma = bad.bernoulli(outliers) ? 25 : 0.5;
        filter.predict([&](const Vector<2>& x) { return walk.move(x); }, walk.Q_root);
        filter.update(
            Vector<1>(truth(0) + sigma * random.gaussian()), [&](const Vector<2>& x) { return walk.read(x); }, walk.R);
        square += std::pow(filter.belief().mean(0) - truth(0), 2) / 1000;
      }
    }
    return std::sqrt(square);
  };
  const double clean = error(std::nullopt, 0), robust = error(Loss(LossKind::Tukey), 0.1);
  std::cout << "clean " << clean << ", 10 % of 50 sigma: " << robust << " robust, " << error(std::nullopt, 0.1)
            << " not\n";
  EXPECT_LT(error(Loss(LossKind::Tukey), 0), 1.05 * clean);
  EXPECT_LT(robust, 1.2 * clean);
  EXPECT_GT(error(std::nullopt, 0.1), 3 * clean);
}

}  // namespace
}  // namespace sas_motion

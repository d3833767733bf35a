// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtsam/base/numericalDerivative.h>
#include <gtsam/geometry/Point3.h>

#include "systems/usbl/graph/batch.hpp"
#include "systems/usbl/graph/problems.hpp"

namespace sas_motion::usbl {
namespace {

using testing::figureEight;
using testing::simulatedProblem;

Unknowns randomUnknowns(Random& random) {
  Unknowns x;
  x << 0.3 * sas_motion::testing::randomMatrix<3>(random), 2 * sas_motion::testing::randomMatrix<3>(random),
      sas_motion::testing::randomMatrix<3>(random), 0.01 * random.gaussian();
  return x;
}

TEST(UsblFactors, UnknownsSurviveTheVariables) {
  Random random = sas_motion::testing::announced(311);
  Prior prior;
  testing::estimateAll(prior);
  for (int i = 0; i < 50; ++i) {
    const Unknowns x = randomUnknowns(random);
    EXPECT_LT((unknownsFrom(valuesFrom(prior, x), Unknowns::Zero()) - x).norm(), 1e-12);
    EXPECT_LT((unknownsFrom(gtsam::Values(), x) - x).norm(), 1e-15) << "what has no variable is known";
  }
}

TEST(UsblFactors, ChannelJacobiansMatchGtsamsNumericalOnes) {
  Random random = sas_motion::testing::announced(312);
  using gtsam::Point3;
  using gtsam::Rot3;
  for (const auto& name : modeNames()) {
    Problem problem = simulatedProblem(figureEight(40), 1, modeFromName(name));
    testing::estimateAll(problem.prior);
    for (const auto& ping : problem.pings)
      for (int channel = 0; channel < kChannels; ++channel) {
        if (!ping.reading.has(channel)) continue;
        const ChannelFactor factor(problem, ping, channel, Loss(LossKind::Huber), Unknowns::Zero());
        const gtsam::Values values = valuesFrom(problem.prior, randomUnknowns(random));
        std::vector<gtsam::Matrix> H(4);
        const gtsam::Vector error = factor.unwhitenedError(values, H);
        const auto with = [&](gtsam::Key key, const auto& variable) {
          gtsam::Values changed = values;
          changed.update(key, variable);
          return gtsam::Vector(factor.unwhitenedError(changed));
        };
        const auto point = [&](gtsam::Key key) {
          return gtsam::numericalDerivative11<gtsam::Vector, Point3>([&](const Point3& p) { return with(key, p); },
                                                                     values.at<Point3>(key));
        };
        const auto rotation = gtsam::numericalDerivative11<gtsam::Vector, Rot3>(
            [&](const Rot3& R) { return with(kMountingKey, R); }, values.at<Rot3>(kMountingKey));
        const auto scale = gtsam::numericalDerivative11<gtsam::Vector, double>(
            [&](double s) { return with(kRangeScaleKey, s); }, values.at<double>(kRangeScaleKey));
        EXPECT_LT(std::abs(error(0) - with(kLeverKey, values.at<Point3>(kLeverKey))(0)), 1e-12);
        EXPECT_LT((H[0] - rotation).norm(), 1e-5 * std::max(1.0, rotation.norm())) << name << channel;
        EXPECT_LT((H[1] - point(kLeverKey)).norm(), 1e-6) << name << channel;
        EXPECT_LT((H[2] - point(kTransponderKey)).norm(), 1e-6) << name << channel;
        EXPECT_LT((H[3] - scale).norm(), 1e-5 * std::max(1.0, scale.norm())) << name << channel;
      }
  }
}

TEST(UsblFactors, TheMountingPriorsJacobianMatchesGtsamsNumericalOne) {
  Random random = sas_motion::testing::announced(313);
  for (int i = 0; i < 50; ++i) {
    Prior prior;
    prior.mean = randomUnknowns(random);
    prior.mean(kMountingZ) = kPi - 1e-3;  // the heading angle wraps
    const MountingPriorFactor factor(prior);
    Unknowns x = randomUnknowns(random);
    x(kMountingZ) = -kPi + 0.1 * random.gaussian();
    const gtsam::Rot3 R(mountingRotation(x.head<3>()));
    gtsam::Matrix H;
    const gtsam::Vector error = factor.evaluateError(R, H);
    EXPECT_LT((H - gtsam::numericalDerivative11<gtsam::Vector, gtsam::Rot3>(
                       [&](const gtsam::Rot3& at) { return factor.evaluateError(at, boost::none); }, R))
                  .norm(),
              1e-6);
    EXPECT_LT(std::abs(error(kMountingZ)), 1);
    EXPECT_NEAR(error(kMountingX), x(kMountingX) - prior.mean(kMountingX), 1e-12);
  }
}

TEST(UsblFactors, TheGraphsErrorIsTheProblemsCost) {
  for (const auto& mode : modeNames())
    for (const auto& name : lossNames()) {
      const Loss loss(lossFromName(name));
      Problem problem = simulatedProblem(figureEight(60), 2, modeFromName(mode));
      problem.prior.estimated[kTransponderX] = problem.prior.estimated[kRangeScale] = true;
      problem.scale << 1.2, 0.8, 0.9;
      const Unknowns x = Scenario::defaultTruth();
      const double expected = cost(problem, loss, x);
      EXPECT_NEAR(buildGraph(problem, loss, x).error(valuesFrom(problem.prior, x)), expected, 1e-9 * expected)
          << mode << ", " << name;
    }
}

}  // namespace
}  // namespace sas_motion::usbl

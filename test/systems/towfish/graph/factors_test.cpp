// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/towfish/graph/factors.hpp"

#include <gtsam/base/numericalDerivative.h>

#include "graph/loss_estimator.hpp"
#include "support.hpp"
#include "systems/towfish/graph/batch.hpp"

namespace sas_motion::towfish {
namespace {

using testing::announced;

StateVector randomState(Random& random, bool south) {
  StateVector x;
  x << 100 * random.gaussian(), 100 * random.gaussian(), 0.3 * random.gaussian(), 0.3 * random.gaussian(), 0,
      2 + random.gaussian();
  x(kHeading) = south ? wrapAngle(kPi + 1e-4 * random.gaussian()) : kPi * (2 * random.uniform() - 1);
  return x;
}

TEST(Factors, MotionJacobiansMatchGtsamsNumericalOnes) {
  Random random = announced(301);
  const Model model{MotionParameters()};
  for (int i = 0; i < 50; ++i) {
    const StateVector from = randomState(random, i % 2 == 0);
    const Input input{0.1 * random.gaussian()};
    const double dt = 0.01 + random.uniform();
    StateVector to = model.predict(from, input, dt) + 0.1 * testing::randomMatrix<6>(random);
    const MotionFactor factor(0, 1, model, input, dt, model.transition(from, input, dt).Q);
    const auto error = [&](const StateVector& a, const StateVector& b) -> gtsam::Vector {
      return factor.evaluateError(a, b, boost::none, boost::none);
    };
    gtsam::Matrix H_from, H_to;
    const gtsam::Vector value = factor.evaluateError(from, to, H_from, H_to);
    EXPECT_LT((value - error(from, to)).norm(), 1e-12);
    EXPECT_LT((H_from - gtsam::numericalDerivative21<gtsam::Vector, StateVector, StateVector>(error, from, to)).norm(),
              1e-6)
        << i;
    EXPECT_LT((H_to - gtsam::numericalDerivative22<gtsam::Vector, StateVector, StateVector>(error, from, to)).norm(),
              1e-6)
        << i;
    EXPECT_LT(std::abs(value(kHeading)), 1);  // wrapped
  }
}

TEST(Factors, RowAndPriorJacobiansMatchGtsamsNumericalOnes) {
  Random random = announced(302);
  const Model model{MotionParameters()};
  for (int i = 0; i < 50; ++i) {
    const StateVector x = randomState(random, i % 2 == 0);
    for (const Sensor sensor : {Sensor::Position, Sensor::Heading, Sensor::Speed})
      for (int row = 0; row < rowsOf(sensor); ++row) {
        Measurement z;
        z.sensor = sensor;
        z.lever_arm_body << 3, -1;
        z.value = Model::expected(z, x) + 0.1 * testing::randomMatrix<2>(random);
        const RowFactor factor(0, model, z, row, Loss(LossKind::Huber));
        const auto error = [&](const StateVector& at) -> gtsam::Vector {
          return factor.evaluateError(at, boost::none);
        };
        gtsam::Matrix H;
        EXPECT_NEAR(factor.evaluateError(x, H)(0), Model::expected(z, x)(row) - z.value(row),
                    sensor == Sensor::Heading ? 7 : 1e-9);
        EXPECT_LT((H - gtsam::numericalDerivative11<gtsam::Vector, StateVector>(error, x)).norm(), 1e-6)
            << sensorName(sensor) << row;
        EXPECT_LT(error(x).norm(), 1) << sensorName(sensor);  // wrapped
      }
    const PriorStateFactor prior(0, {randomState(random, i % 2 == 0), testing::randomCovariance<6>(random)});
    const auto error = [&](const StateVector& at) -> gtsam::Vector { return prior.evaluateError(at, boost::none); };
    gtsam::Matrix H;
    prior.evaluateError(x, H);
    EXPECT_LT((H - gtsam::numericalDerivative11<gtsam::Vector, StateVector>(error, x)).norm(), 1e-6);
  }
}

TEST(Factors, LossEstimatorIsTheLoss) {
  for (const auto& name : lossNames()) {
    const Loss loss(lossFromName(name));
    const LossEstimator estimator(loss);
    for (double r = -20; r <= 20; r += 0.37) {
      EXPECT_EQ(estimator.loss(r), loss.rho(r)) << name;
      EXPECT_EQ(estimator.weight(r), loss.weight(r)) << name;
    }
    EXPECT_TRUE(estimator.equals(LossEstimator(loss), 1e-9));
    EXPECT_FALSE(estimator.equals(LossEstimator(Loss(loss.kind(), 2 * loss.tuning())), 1e-9));
  }
}

TEST(Factors, TheGraphsErrorIsTheProblemsCost) {
  const auto scenario = testing::zhu2007(20, testing::contaminated(0.2, 20));
  std::cout << "seed 1\n";
  const auto problem = *buildProblem(testing::simulate(scenario, 1).measurements, testing::configFor(scenario));
  for (const auto& name : lossNames()) {
    const Loss loss(lossFromName(name));
    const double expected = cost(problem, loss, problem.initial);
    EXPECT_NEAR(buildGraph(problem, loss).error(initialValues(problem.initial)), expected, 1e-9 * expected) << name;
  }
}

}  // namespace
}  // namespace sas_motion::towfish

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/ins_gps_dvl/graph/factors.hpp"

#include <gtsam/linear/VectorValues.h>
#include <gtsam/nonlinear/Values.h>

#include "support.hpp"
#include "systems/ins_gps_dvl/graph/runs.hpp"

namespace sas_motion::ins {
namespace {

using sas_motion::testing::announced;
using sas_motion::testing::randomMatrix;

constexpr double kBegin = 40, kLength = 0.2;  // of the interval [s]

Node nodeAt(double time) {
  const Scenario scenario = testing::surveyOf(100);
  Node node;
  node.state = Trajectory(scenario.track, scenario.duration).at(time).state;
  return node;
}

/// Perfect readings between two times.
IntervalPtr intervalOf(double begin, double end) {
  const Trajectory trajectory(testing::surveyOf(100).track, 100);
  constexpr double kPeriod = 0.01;
  Mechanisation ins(trajectory.at(begin - kPeriod).state, stampFromSeconds(begin - kPeriod), {});
  ins.advance(trajectory.imu(begin - kPeriod, begin), stampFromSeconds(begin));
  InertialInterval interval{ins};
  for (double time = begin; time < end - 1e-9; time += kPeriod) {
    const ImuReading reading = trajectory.imu(time, time + kPeriod);
    interval.pieces.push_back({reading, reading.stamp});
  }
  interval.duration = end - begin;
  return std::make_shared<const InertialInterval>(interval);
}

ModelPtr modelOf(const Parameters& parameters) {
  return std::make_shared<const ErrorModel>(parameters, nodeAt(0).state);
}

Parameters parametersOf(bool distorted) {
  Parameters p = testing::surveyOf(100).parameters;
  p.dvl_scale = distorted ? 0.01 : 0;
  p.dvl_misalignment = distorted ? 0.01 : 0;
  p.dvl_lever_sigma = distorted ? 0.1 : 0;
  return p;
}

/// Somewhere near the truth at both ends of the interval.
gtsam::Values valuesNear(Random& random) {
  gtsam::Values values;
  values.insert(0, nodeAt(kBegin).retract(randomMatrix<kNodeStates>(random)));
  values.insert(1, nodeAt(kBegin + kLength).retract(randomMatrix<kNodeStates>(random)));
  values.insert(kConstantsKey, Constants(randomMatrix<kConstantStates>(random)));
  values.insert(kDvlScaleKey, 0.02);
  values.insert(kDvlMisalignmentKey, gtsam::Vector3(0.01, -0.02, 0.03));
  values.insert(kDvlLeverKey, gtsam::Vector3(0.3, -0.5, 0.2));
  return values;
}

/// Central differences by each variable of a factor, against its Jacobians; `slack` is absolute.
void expectJacobians(const gtsam::NoiseModelFactor& factor, const gtsam::Values& values, double relative,
                     double slack) {
  constexpr double kStep = 1e-2;  // in units of the states
  std::vector<gtsam::Matrix> H(factor.keys().size());
  factor.unwhitenedError(values, H);
  for (std::size_t i = 0; i < H.size(); ++i) {
    const gtsam::Key key = factor.keys()[i];
    for (Eigen::Index column = 0; column < H[i].cols(); ++column) {
      const auto at = [&](double step) {
        gtsam::VectorValues delta = values.zeroVectors();
        delta.at(key)(column) = step;
        return gtsam::Vector(factor.unwhitenedError(values.retract(delta)));
      };
      const gtsam::Vector found = (at(kStep) - at(-kStep)) / (2 * kStep);
      for (Eigen::Index row = 0; row < found.size(); ++row)
        EXPECT_NEAR(H[i](row, column), found(row), relative * std::abs(found(row)) + slack)
            << "variable " << i << ", row " << row << ", column " << column;
    }
  }
}

TEST(InsNode, StepsAreTheErrorsOfTheModel) {
  Random random = announced(411);
  for (int i = 0; i < 20; ++i) {
    const Node truth = nodeAt(kBegin);
    const Vector<kNodeStates> e = randomMatrix<kNodeStates>(random);
    const Node computed = truth.retract(e);
    EXPECT_LT((truth.localCoordinates(computed) - e).cwiseAbs().maxCoeff(), 1e-8);
    const ErrorModel model({}, truth.state);
    Errors errors = Errors::Zero();
    errors.head<9>() = e.head<9>();
    EXPECT_LT(truth.localCoordinates(nodeOf(corrected(computed.state, errors, model.unit()), Errors::Zero()))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-8);
  }
}

TEST(InertialFactor, IsSmallOnTheTrueWayAndSeesWhatLeavesIt) {
  const auto interval = intervalOf(kBegin, kBegin + kLength);
  const Node from = nodeAt(kBegin), to = nodeAt(kBegin + kLength);
  const InertialFactor factor(0, 1, modelOf({}), interval, from, Constants::Zero());
  const gtsam::Vector error = factor.evaluateError(from, to, Constants::Zero(), boost::none, boost::none, boost::none);
  EXPECT_LT(error.segment<3>(kVelocity).norm(), 1e-6);
  EXPECT_LT(error.segment<3>(kPosition).norm(), 1e-6) << "a third of the least noise of an interval";
  EXPECT_LT(error.segment<3>(kAttitude).norm() * kMilliradian, 1e-10);
  // GIVEN a bias of 1 mm/s^2 that the node does not know of, THEN it misses by that times the time
  const gtsam::Vector biased =
      factor.evaluateError(from, to, -Constants::Unit(4), boost::none, boost::none, boost::none);
  EXPECT_NEAR(biased.segment<3>(kVelocity).norm(), kBias * kLength, 1e-6);
}

TEST(InertialFactor, JacobiansAreThoseOfDifferences) {
  Random random = announced(412);
  for (const double length : {kLength, 0.03}) {
    const auto interval = intervalOf(kBegin, kBegin + length);
    for (int i = 0; i < 5; ++i) {
      gtsam::Values values = valuesNear(random);
      // The Jacobian is for an end that is near the node.
      values.update(1, Node{integrate(*interval, values.at<Node>(0), values.at<Constants>(kConstantsKey)).end,
                            values.at<Node>(1).wandering});
      const InertialFactor factor(0, 1, modelOf({}), interval, values.at<Node>(0), Constants::Zero());
      expectJacobians(factor, values, 0.01, 2e-6);
    }
  }
}

TEST(AidingFactor, JacobiansAreThoseOfDifferences) {
  Random random = announced(413);
  for (const bool distorted : {false, true}) {
    const auto model = modelOf(parametersOf(distorted));
    for (int i = 0; i < 5; ++i) {
      gtsam::Values values = valuesNear(random);
      Aiding reading;
      reading.fix = nodeAt(kBegin).state;
      reading.velocity_body = nodeAt(kBegin).state.q_nav_body.conjugate() * nodeAt(kBegin).state.velocity_nav;
      for (const auto sensor : {Sensor::Gps, Sensor::Dvl, Sensor::Depth}) {
        reading.sensor = sensor;
        for (int row = 0; row < rowsOf(sensor); ++row) {
          const AidingFactor factor(0, model, reading, {0.02, -0.01, 0.03}, row, Loss(LossKind::Huber));
          EXPECT_EQ(factor.keys().size(), distorted && sensor == Sensor::Dvl ? 4U : 1U);
          expectJacobians(factor, values, 1e-3, 2e-5);
        }
      }
    }
  }
}

TEST(AidingFactor, JacobiansOfADvlThatDriftsAreThoseOfDifferences) {
  Random random = announced(415);
  Parameters parameters = parametersOf(true);
  parameters.dvl_drift = DvlDrift();
  const auto model = modelOf(parameters);
  gtsam::Values values = valuesNear(random);
  Node node = values.at<Node>(0);
  node.wandering.tail<3>() << 0.1, 0.02, 0.01;  // [rad], [m/s], [m/s]
  values.update(0, node);
  Aiding reading;
  reading.sensor = Sensor::Dvl;
  reading.velocity_body = node.state.q_nav_body.conjugate() * node.state.velocity_nav;
  for (int row = 0; row < 3; ++row)
    expectJacobians(AidingFactor(0, model, reading, {0.02, -0.01, 0.03}, row, Loss(LossKind::L2)), values, 1e-3, 2e-5);
}

TEST(AidingFactor, TakesScaleMisalignmentAndLeverArmOutOfADvl) {
  // GIVEN a DVL that reads 2 % too much, is turned by 30 mrad and sits half a metre from where it is told to be
  const auto model = modelOf(parametersOf(true));
  const Vector<3> rate(0.02, -0.01, 0.03), misalignment(0.01, -0.02, 0.03), lever(0.3, -0.5, 0.2);
  const Node node = nodeAt(kBegin);
  const ErrorModel plain({}, node.state);
  Aiding reading;
  reading.sensor = Sensor::Dvl;
  reading.velocity_body =
      -model->velocityOfIns(node.state, rate, -(node.state.q_nav_body.conjugate() * node.state.velocity_nav));
  reading.velocity_body += rateOverGround(node.state, rate).cross(lever);
  reading.velocity_body = dvlDistortion(0.02, misalignment) * reading.velocity_body;
  gtsam::Values values;
  values.insert(0, node);
  values.insert(kDvlScaleKey, 0.02);
  values.insert(kDvlMisalignmentKey, gtsam::Vector3(misalignment));
  values.insert(kDvlLeverKey, gtsam::Vector3(lever));
  for (int row = 0; row < 3; ++row) {
    const AidingFactor factor(0, model, reading, rate, row, Loss(LossKind::L2));
    EXPECT_NEAR(factor.unwhitenedError(values)(0), 0, 1e-12);
  }
}

TEST(BeliefFactor, WeighsAsTheFilterDoes) {
  Random random = announced(414);
  const ErrorModel model({}, nodeAt(kBegin).state);
  Gaussian<kStates> belief = model.start();
  const Errors scale = belief.covariance.diagonal().cwiseSqrt();
  belief.covariance = scale.asDiagonal() * sas_motion::testing::randomCovariance<kStates>(random) * scale.asDiagonal();
  belief.mean.tail<18>() = randomMatrix<18>(random);
  const NavigationState fused = nodeAt(kBegin).state;
  const BeliefFactor factor(0, fused, belief);
  // GIVEN errors of the INS and what wanders, WHEN they are taken out of the estimate
  Errors e = Errors::Zero();
  e.head<9>() = 0.1 * randomMatrix<9>(random);
  e.segment<15>(kGyroConstant) = belief.mean.segment<15>(kGyroConstant) + 0.1 * randomMatrix<15>(random);
  gtsam::Values values;
  values.insert(0, nodeOf(corrected(fused, e, model.unit()), e));
  values.insert(kConstantsKey, constantsOf(e));
  Vector<24> difference = e.head<24>();
  difference.tail<15>() -= belief.mean.segment<15>(kGyroConstant);
  const Matrix<24> P = belief.covariance.topLeftCorner<24, 24>();
  const double square = difference.dot(P.llt().solve(difference));
  EXPECT_NEAR(2 * factor.error(values), square, 1e-4 * square);
  expectJacobians(factor, values, 1e-3, 2e-4);
}

TEST(BeliefFactor, IsExactWhereTheAttitudeIsFarOff) {
  // GIVEN a start whose heading is 30 and 120 degrees wrong and whose tilt is too
  for (const double heading : {30.0, 120.0}) {
    const NavigationState truth = nodeAt(kBegin).state;
    const Vector<3> phi(0.01, -0.02, heading * kRadPerDeg);
    NavigationState estimated = truth;
    estimated.q_nav_body = quaternionOf(-phi) * truth.q_nav_body;
    Parameters parameters;
    parameters.start_heading = 1;
    parameters.start_tilt = 0.01;
    const ErrorModel model(parameters, estimated);
    const BeliefFactor factor(0, estimated, model.start());
    gtsam::Values values;
    values.insert(0, nodeOf(truth, Errors::Zero()));
    values.insert(kConstantsKey, Constants(Constants::Zero()));
    // THEN the error is the rotation vector, however long, and the Jacobian that of differences
    EXPECT_LT((factor.unwhitenedError(values).segment<3>(kAttitude) * kMilliradian - phi).norm(), 1e-9);
    expectJacobians(factor, values, 1e-4, 1e-6);
  }
}

}  // namespace
}  // namespace sas_motion::ins

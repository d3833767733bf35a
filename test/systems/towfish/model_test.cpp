// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/model.hpp"

#include <cmath>

#include "support.hpp"

namespace sas_motion::towfish {
namespace {

using testing::announced;

StateVector randomState(Random& random) {
  StateVector x;
  x << 500 * random.gaussian(), 500 * random.gaussian(), 0.3 * random.gaussian(), 0.3 * random.gaussian(),
      kPi * (2 * random.uniform() - 1), 2 + random.gaussian();
  return x;
}

/// States everywhere and, every other one, within a hair of heading south.
StateVector trickyState(Random& random, int i) {
  StateVector x = randomState(random);
  if (i % 2 == 0) x(kHeading) = wrapAngle(kPi + 1e-7 * random.gaussian());
  return x;
}

TEST(TowfishModel, MotionJacobianMatchesCentralDifferences) {
  Random random = announced(81);
  const Model model{MotionParameters()};
  for (int i = 0; i < 200; ++i) {
    const StateVector x = trickyState(random, i);
    const Input input{0.1 * random.gaussian()};
    const double dt = std::pow(10.0, 4 * random.uniform() - 3), h = 1e-5;  // 1 ms to 10 s
    const auto step = model.transition(x, input, dt);
    EXPECT_LT(Model::difference(step.mean, model.predict(x, input, dt)).cwiseAbs().maxCoeff(), 1e-9);
    for (int col = 0; col < kStates; ++col) {
      const StateVector e = h * StateVector::Unit(col);
      const StateVector slope =
          Model::difference(model.predict(x + e, input, dt), model.predict(x - e, input, dt)) / (2 * h);
      EXPECT_LT((slope - step.F.col(col)).cwiseAbs().maxCoeff(), 1e-6 * (1 + dt)) << "column " << col << ", dt " << dt;
    }
  }
}

TEST(TowfishModel, MeasurementJacobiansMatchCentralDifferences) {
  Random random = announced(82);
  const Model model{MotionParameters()};
  const double h = 1e-5;
  for (int i = 0; i < 200; ++i)
    for (const Sensor sensor : {Sensor::Position, Sensor::Heading, Sensor::Speed, Sensor::Velocity}) {
      const StateVector x = trickyState(random, i);
      Measurement z;
      z.sensor = sensor;
      z.lever_arm_body << 3 * random.gaussian(), random.gaussian();
      z.value = Model::expected(z, x) + 0.1 * testing::randomMatrix<2>(random);
      model.linearize(z, x, [&](const auto& linear) {
        for (int col = 0; col < kStates; ++col) {
          const StateVector e = h * StateVector::Unit(col);
          using Rows = std::decay_t<decltype(linear.innovation)>;
          const auto innovation = [&](const StateVector& at) {
            return model.linearize(z, at, [](const auto& l) -> Vector<2> {
              Vector<2> rows = Vector<2>::Zero();
              rows.head(l.innovation.rows()) = l.innovation;
              return rows;
            });
          };
          const Vector<2> slope = -(innovation(x + e) - innovation(x - e)) / (2 * h);  // of h = z - innovation
          EXPECT_LT((slope.head<Rows::RowsAtCompileTime>() - linear.H.col(col)).cwiseAbs().maxCoeff(), 1e-6)
              << sensorName(sensor) << " " << col;
        }
      });
    }
}

TEST(TowfishModel, SecondOrderTransitionOfThePaperIsCloseForShortSteps) {  // (6)
  const MotionParameters p;
  const Model model(p);
  StateVector x;
  x << 0, 0, 0.2, -0.1, 0.7, 2;
  const double beta = 1 / p.current_time_constant;
  for (const double T : {0.01, 0.1, 1.0}) {
    StateMatrix paper = StateMatrix::Identity();
    paper(0, 2) = paper(1, 3) = T - beta * T * T / 2;
    paper(2, 2) = paper(3, 3) = 1 - beta * T + beta * beta * T * T / 2;
    paper(0, 4) = -x(5) * T * std::sin(x(4));
    paper(0, 5) = T * std::cos(x(4));
    paper(1, 4) = x(5) * T * std::cos(x(4));
    paper(1, 5) = T * std::sin(x(4));
    EXPECT_LT((model.transition(x, {}, T).F - paper).cwiseAbs().maxCoeff(), beta * beta * T * T * T);
  }
}

TEST(TowfishModel, MeanFollowsThePapersEquationsOfMotion) {  // (1), integrated in small steps
  MotionParameters p;
  p.current_time_constant = 50;
  const Model model(p);
  StateVector x;
  x << 10, -20, 0.4, -0.3, 2.9, 1.7;
  const Input input{0.08};
  StateVector fine = x;
  const double T = 2, h = 1e-4;
  for (int i = 0; i < 20000; ++i) {
    const double middle = fine(kHeading) + 0.5 * h * input.turn_rate;
    fine(kNorth) += h * (fine(kCurrentNorth) + fine(kSpeed) * std::cos(middle));
    fine(kEast) += h * (fine(kCurrentEast) + fine(kSpeed) * std::sin(middle));
    fine(kCurrentNorth) -= h * fine(kCurrentNorth) / p.current_time_constant;
    fine(kCurrentEast) -= h * fine(kCurrentEast) / p.current_time_constant;
    fine(kHeading) += h * input.turn_rate;
  }
  const StateVector one = Model::difference(model.predict(x, input, T), fine);
  EXPECT_LT(one.head<2>().norm(),
            x(kSpeed) * T * std::pow(input.turn_rate * T, 2) / 24 * 1.1);  // the midpoint rule's error
  EXPECT_LT(one.tail<4>().cwiseAbs().maxCoeff(), 1e-5);
  StateVector many = x;
  for (int i = 0; i < 20; ++i) many = model.predict(many, input, T / 20);
  EXPECT_LT(Model::difference(many, fine).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(TowfishModel, HeadingInnovationTakesTheShortWayRound) {
  const Model model{MotionParameters()};
  StateVector x = StateVector::Zero();
  Measurement z;
  z.sensor = Sensor::Heading;
  for (const double turns : {-3.0, 0.0, 2.0}) {
    x(kHeading) = kPi - 0.01;
    z.value(0) = -kPi + 0.02 + 2 * kPi * turns;
    EXPECT_NEAR(model.heading(z, x).innovation(0), 0.03, 1e-9);
    x(kHeading) = -kPi + 0.01;
    z.value(0) = kPi - 0.02 + 2 * kPi * turns;
    EXPECT_NEAR(model.heading(z, x).innovation(0), -0.03, 1e-9);
  }
}

TEST(TowfishModel, AntennaStandsWhereItsLeverArmPoints) {
  Measurement z;
  z.lever_arm_body << 4, 1;  // forward, starboard
  StateVector x = StateVector::Zero();
  EXPECT_LT((Model::expected(z, x) - Vector<2>(4, 1)).norm(),
            1e-12);  // heading north: forward is north, starboard east
  x(kHeading) = kPi / 2;
  EXPECT_LT((Model::expected(z, x) - Vector<2>(-1, 4)).norm(), 1e-12);  // heading east: starboard is south
}

TEST(TowfishModel, AVelocityOverGroundIsSpeedAndCurrentInTheBody) {
  StateVector x;
  x << 0, 0, 0.3, -0.4, kPi / 2, 2;  // bound east; the current sets north and west
  Measurement z;
  z.sensor = Sensor::Velocity;
  EXPECT_LT((Model::expected(z, x) - Vector<2>(1.6, -0.3)).norm(), 1e-12);  // slower, and to port
}

TEST(TowfishModel, RefusesParametersThatAreNotPositive) {
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    MotionParameters p;
    p.speed_noise = bad;
    try {
      Model{p};
      FAIL() << bad;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("speed_noise"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace sas_motion::towfish

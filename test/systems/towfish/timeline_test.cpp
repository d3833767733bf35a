// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "systems/towfish/feeding.hpp"

namespace sas_motion::towfish {
namespace {

constexpr Stamp kBegin = 5'000 * kNanosecondsPerSecond;

Stamp at(double seconds) { return kBegin + stampFromSeconds(seconds); }

Measurement reading(Sensor sensor, double seconds, const Vector<2>& value, double sigma) {
  Measurement z;
  z.stamp = at(seconds);
  z.sensor = sensor;
  z.value = value;
  z.variance.setConstant(sigma * sigma);
  return z;
}

/// A vessel that lies still and heads `heading`, ten readings a second for ten seconds.
std::unique_ptr<testing::TowfishTimeline> lyingStill(double heading, const Config& config = {}) {
  auto estimator = testing::timelineOf("kf", config);
  Output output;
  for (int i = 0; i <= 100; ++i) {
    estimator->process(reading(Sensor::Position, 0.1 * i, {0, 0}, 0.1), output);
    estimator->process(reading(Sensor::Heading, 0.1 * i, {heading, 0}, 0.001), output);
    estimator->process(reading(Sensor::Speed, 0.1 * i, {0, 0}, 0.01), output);
  }
  return estimator;
}

TEST(TowfishTimeline, AnswersBetweenMeasurementsByTheModel) {
  const Config config;
  const auto estimator = lyingStill(0.3, config);
  const Model model(config.model);
  const auto before = estimator->at(at(7.3));
  const auto between = estimator->at(at(7.34));
  ASSERT_TRUE(before && between);
  const auto step = model.transition(before->belief.mean, {}, 0.04);
  EXPECT_LT((between->belief.mean - step.mean).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT(between->belief.covariance(kNorth, kNorth), before->belief.covariance(kNorth, kNorth));
  EXPECT_EQ(estimator->at(at(10))->belief.mean, estimator->current()->belief.mean);
  EXPECT_EQ(estimator->current()->stamp, at(10));
  EXPECT_TRUE(estimator->at(at(12)));  // after the newest
  EXPECT_FALSE(estimator->at(at(1)));  // settled long ago
  EXPECT_FALSE(estimator->at(at(-10)));
}

TEST(TowfishTimeline, SaysNothingBeforeItStarts) {
  const auto estimator = testing::timelineOf("kf", {});
  EXPECT_FALSE(estimator->current());
  EXPECT_FALSE(estimator->at(kBegin));
  Output output;
  estimator->process(reading(Sensor::Position, 0, {0, 0}, 1), output);
  EXPECT_FALSE(estimator->current());
  EXPECT_TRUE(output.solutions.empty());
}

TEST(TowfishTimeline, ATurnRateIsBelievedForItsHoldTimeOnly) {
  Config config;
  config.input_hold = 1;
  const auto estimator = lyingStill(0, config);
  Output output;
  estimator->process(reading(Sensor::TurnRate, 10.05, {0.2, 0}, 0.001), output);
  const double heading = estimator->at(at(10.05))->belief.mean(kHeading);
  EXPECT_NEAR(estimator->at(at(10.55))->belief.mean(kHeading) - heading, 0.1, 1e-9);
  EXPECT_NEAR(estimator->at(at(11.04))->belief.mean(kHeading) - heading, 0.198, 1e-9);
  EXPECT_NEAR(estimator->at(at(11.10))->belief.mean(kHeading) - heading, 0, 1e-9);  // expired: no longer known
}

TEST(TowfishTimeline, FollowsAHeadingThroughSouthAThousandTimes) {
  for (const auto& name : testing::filterNames()) {
    const auto estimator = testing::timelineOf(name, {});
    Random random(211);
    Output output;
    const double rate = 0.5, step = 0.2;
    double worst = 0;
    std::size_t refused = 0;
    for (int i = 0; i * step * rate < 1000 * 2 * kPi; ++i) {
      const double t = i * step, turning = std::max(0.0, t - 10);  // the start is on a straight line
      const double heading = wrapAngle(3 + rate * turning), straight = 2 * (t - turning);
      const Vector<2> place(straight * std::cos(3) + 2 / rate * (std::sin(heading) - std::sin(3)),
                            straight * std::sin(3) + 2 / rate * (std::cos(3) - std::cos(heading)));
      estimator->process(reading(Sensor::Position, t, place + 0.5 * testing::randomMatrix<2>(random), 0.5), output);
      estimator->process(reading(Sensor::Heading, t, {wrapAngle(heading + 0.01 * random.gaussian()), 0}, 0.01), output);
      estimator->process(reading(Sensor::Speed, t, {2, 0}, 0.05), output);
      estimator->process(reading(Sensor::TurnRate, t, {t < 10 ? 0 : rate, 0}, 0.01), output);
      refused += testing::count(output, Verdict::Invalid);
      output.clear();
      if (const auto now = estimator->current(); now && t > 15)
        worst = std::max(worst, std::abs(wrapAngle(now->belief.mean(kHeading) - heading)));
    }
    EXPECT_LT(worst, 0.05) << name;
    EXPECT_GT(worst, 0) << name;
    EXPECT_EQ(refused, 0u) << name;
  }
}

TEST(TowfishTimeline, EstimatorsAreMadeByName) {
  const Config config;
  for (const auto& name : testing::filterNames()) EXPECT_TRUE(makeEstimator(name, config)) << name;
  for (const auto& loss : lossNames()) EXPECT_TRUE(makeEstimator("robust_kf_" + loss, config)) << loss;
  EXPECT_TRUE(makeEstimator("rts", config));
  for (const char* wrong : {"", "KF", "robust_kf_", "robust_kf_hubert", "robust", "kf "})
    EXPECT_FALSE(makeEstimator(wrong, config)) << wrong;
}

/// The worst position error over a stretch of time.
double worstError(const Output& output, const testing::Run& run, double from, double until) {
  double worst = 0;
  for (const auto& estimate : output.solutions) {
    const double t = secondsBetween(Simulator::kStart, estimate.stamp);
    if (t >= from && t <= until) worst = std::max(worst, testing::positionError(estimate, run));
  }
  return worst;
}

TEST(Scenario, GnssJumpsFiveHundredMetresAndRecovers) {
  // GIVEN a survey with good GNSS
  const auto scenario = testing::survey(200);
  auto run = testing::simulate(scenario, 21);
  // WHEN all fixes are 500 m to the east for 15 s, less than it takes to be believed
  for (auto& z : run.measurements) {
    const double t = secondsBetween(Simulator::kStart, z.stamp);
    if (z.sensor == Sensor::Position && t >= 100 && t < 115) z.value(1) += 500;
  }
  // THEN the plain filter is carried away, and the mixture filter stays near and is back soon
  const auto kf = testing::feed("kf", testing::configFor(scenario), run.measurements);
  const auto mixture = testing::feed("mixture_kf", testing::configFor(scenario), run.measurements);
  EXPECT_GT(worstError(kf, run, 100, 115), 100);
  EXPECT_LT(worstError(mixture, run, 50, 100), 4);
  EXPECT_LT(worstError(mixture, run, 100, 140), 15);
  EXPECT_LT(worstError(mixture, run, 160, 200), 4);
}

TEST(Scenario, GnssMovesForGoodAndIsBelievedInTheEnd) {
  // GIVEN a survey with good GNSS
  const auto scenario = testing::survey(200);
  auto run = testing::simulate(scenario, 23);
  // WHEN all fixes from 100 s on are 500 m to the east
  for (auto& z : run.measurements)
    if (z.sensor == Sensor::Position && secondsBetween(Simulator::kStart, z.stamp) >= 100) z.value(1) += 500;
  // THEN every filter comes over within its reset time and some more, and is not thrown off by it
  for (const auto& name : testing::filterNames()) {
    auto output = testing::feed(name, testing::configFor(scenario), run.measurements);
    for (auto& estimate : output.solutions)
      if (secondsBetween(Simulator::kStart, estimate.stamp) >= 100) estimate.belief.mean(kEast) -= 500;
    EXPECT_LT(worstError(output, run, name == "kf" ? 195 : 130, 200), 15)
        << name;  // the plain filter's current takes a while
  }
}

TEST(Scenario, GnssIsLostForAMinuteAndTheEstimateKnowsIt) {
  // GIVEN a survey with good GNSS
  const auto scenario = testing::survey(200);
  auto run = testing::simulate(scenario, 22);
  // WHEN no fix comes for 60 s
  const auto lost = [](const Measurement& z) {
    const double t = secondsBetween(Simulator::kStart, z.stamp);
    return z.sensor == Sensor::Position && t >= 100 && t < 160;
  };
  run.measurements.erase(std::remove_if(run.measurements.begin(), run.measurements.end(), lost),
                         run.measurements.end());
  // THEN the error grows no faster than the reported uncertainty, and the next fixes mend it
  for (const auto& name : testing::filterNames()) {
    const auto output = testing::feed(name, testing::configFor(scenario), run.measurements);
    for (const auto& estimate : output.solutions) {
      const double t = secondsBetween(Simulator::kStart, estimate.stamp);
      if (t < 20 || t > 170) continue;
      const Matrix<2> P = estimate.belief.covariance.topLeftCorner<2, 2>();
      ASSERT_LT(testing::positionError(estimate, run), 5 * std::sqrt(P.trace())) << name << " at " << t;
    }
    EXPECT_LT(worstError(output, run, 175, 200), 5) << name;
  }
}

}  // namespace
}  // namespace sas_motion::towfish

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/filters/bank_kalman_filter.hpp"

#include <cmath>
#include <numeric>

#include "sas_motion/systems/constant_velocity/model.hpp"
#include "support.hpp"

namespace sas_motion {
namespace {

using Bank = BankKalmanFilter<6>;
using constant_velocity::Model;
using Noise = Vector<4>;

Bank::Options epochsOf(const Model& model) {
  Bank::Options options;
  options.epoch = model.step;
  return options;
}

/// A bank on the constant-velocity problem, beside the truth.
struct Voyage {
  Model model;
  Bank bank{epochsOf(model)};
  Bank::Belief belief{Gaussian<6>()};
  Vector<6> truth = Vector<6>::Zero();
  double time = 0;
  Random random;

  explicit Voyage(std::uint64_t seed) : random(testing::announced(seed)) {}

  /// One epoch, with `wrong` added to the good noise [sigma] and the process noise `jump` times as large.
  void step(const Noise& wrong = Noise::Zero(), double jump = 1) {
    time += model.step;
    const auto transition = model.transition(truth);
    const Matrix<6> root = transition.Q.llt().matrixL();
    truth = transition.mean + jump * (root * testing::randomMatrix<6>(random));
    const Noise z = truth.head<4>() + model.sigma().cwiseProduct(testing::randomMatrix<4>(random) + wrong);
    belief = bank.predict(belief, model.transition(gaussian(belief).mean));
    belief = bank.update(belief, model.measurement(z, gaussian(belief).mean, time)).belief;
  }
  void steps(int count, const Noise& wrong = Noise::Zero()) {
    for (int i = 0; i < count; ++i) step(wrong);
  }
  /// Position error of an axis over its standard deviation.
  double error(int axis) const {
    return std::abs(belief.summary.mean(axis) - truth(axis)) / std::sqrt(belief.summary.covariance(axis, axis));
  }
};

TEST(BankKalmanFilter, IsTheKalmanFilterWhereNothingIsExpectedToGoWrong) {
  Random random = testing::announced(81);
  Bank::Options options;
  options.jump_scale = 1;
  options.sticky = 0;
  options.scales = {1, 1, 1e9, 1e9};
  options.probabilities = {0.5, 0.5, 1e-15, 1e-15};
  const Bank bank(options);
  Bank::Belief belief{Gaussian<6>()};
  Gaussian<6> kalman;
  const Model model;
  for (int i = 0; i < 50; ++i) {
    belief = bank.predict(belief, model.transition(gaussian(belief).mean));
    kalman = KalmanFilter<6>().predict(kalman, model.transition(kalman.mean));
    auto z = testing::randomMeasurement<6, 4>(random);
    z.time = i;
    belief = bank.update(belief, z).belief;
    kalman = KalmanFilter<6>().update(kalman, z).belief;
    EXPECT_LT(testing::relativeDifference(gaussian(belief).mean, kalman.mean), 1e-8) << i;
    EXPECT_LT(testing::relativeDifference(gaussian(belief).covariance, kalman.covariance), 1e-8) << i;
  }
}

TEST(BankKalmanFilter, TheSummaryHasTheMomentsOfTheHypotheses) {
  Voyage voyage(82);
  for (int i = 0; i < 40; ++i) voyage.step(i % 7 == 0 ? Noise(30, 0, 0, 5) : Noise::Zero(), i % 11 == 0 ? 10 : 1);
  const auto& belief = voyage.belief;
  Vector<6> mean = Vector<6>::Zero();
  Matrix<6> P = Matrix<6>::Zero();
  double total = 0;
  for (const auto& h : belief.hypotheses) {
    total += h.weight;
    mean += h.weight * h.deviation;
    P += h.weight * (h.covariance + h.deviation * h.deviation.transpose());
    EXPECT_GT(testing::smallestEigenvalue<6>(h.covariance), 0);
  }
  EXPECT_NEAR(total, 1, 1e-12);
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT(testing::relativeDifference(P, belief.summary.covariance), 1e-12);
}

TEST(BankKalmanFilter, WhereTheMapBeginsDoesNotMatter) {
  Voyage here(83), there(83);
  const Vector<6> away = (Vector<6>() << 1e4, -2e4, 5e3, 0, 0, 0).finished();
  there.truth += away;
  there.belief.summary.mean += away;
  for (int i = 0; i < 60; ++i) {
    const Noise wrong = i % 9 == 0 ? Noise(-20, 10, 0, 0) : Noise::Zero();
    here.step(wrong, i == 30 ? 10 : 1);
    there.step(wrong, i == 30 ? 10 : 1);
  }
  EXPECT_LT((there.belief.summary.mean - here.belief.summary.mean - away).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(BankKalmanFilter, TellsAManoeuvreFromOutliersWithinAFewEpochs) {
  Voyage voyage(84);
  voyage.steps(60);
  EXPECT_GT(voyage.belief.hypotheses[0].weight, 0.8) << "nothing has jumped";
  voyage.truth.tail<3>() << 6, 0, 0;  // four standard deviations of a jump
  voyage.steps(3);
  const double jumped = 1 - voyage.belief.hypotheses[0].weight;
  EXPECT_GT(jumped, 0.9);
  EXPECT_LT(voyage.error(0), 4);
  voyage.steps(1, Noise(25, 25, 25, 0));
  EXPECT_LT(voyage.error(1), 4) << "an outlier is no manoeuvre";
}

TEST(BankKalmanFilter, ABurstOfBiasIsNotBelieved) {
  int followed = 0;
  for (std::uint64_t seed = 100; seed < 120; ++seed) {
    Voyage voyage(seed);
    voyage.steps(60);
    voyage.steps(10, Noise(20, 20, 20, 0));
    followed += (voyage.belief.summary.mean - voyage.truth).head<3>().cwiseAbs().maxCoeff() > 10;
    voyage.steps(5);
    EXPECT_LT((voyage.belief.summary.mean - voyage.truth).head<3>().norm(), 5) << "seed " << seed;
  }
  EXPECT_LE(followed, 1);
}

TEST(BankKalmanFilter, AShiftThatStaysIsBelieved) {
  for (const auto& [what, shift] : {std::pair{"one row", Noise(40, 0, 0, 0)}, {"the sensor", Noise(40, -30, 50, 0)}}) {
    Voyage voyage(86);
    voyage.steps(60);
    voyage.steps(25, shift);
    const Vector<6> shifted = voyage.truth + (Vector<6>() << shift.head<3>(), 0, 0, 0).finished();
    EXPECT_LT((voyage.belief.summary.mean - shifted).head<3>().norm(), 5) << what;
  }
}

TEST(BankKalmanFilter, LearnsHowOftenAChannelLies) {
  Voyage voyage(87);
  Random dice = testing::announced(88);
  for (int i = 0; i < 400; ++i) voyage.step(Noise(dice.bernoulli(0.3) ? 50 * dice.gaussian() : 0, 0, 0, 0));
  const auto& lying = voyage.belief.channels[0].shares;
  const auto& good = voyage.belief.channels[1].shares;
  EXPECT_NEAR(lying[2] + lying[3], 0.27, 0.08);  // a tenth of the outliers look like good readings
  EXPECT_LT(good[2] + good[3], 0.02);
  EXPECT_LT(voyage.belief.jump_probability, Bank::Options().jump_probability / 2) << "nothing has jumped";
}

TEST(BankKalmanFilter, APauseOfTheDataIsNoJumpOfTheNoise) {
  Voyage voyage(89);
  voyage.steps(60);
  Model long_step = voyage.model;
  long_step.step = 10;  // twenty epochs without data
  const auto transition = long_step.transition(voyage.belief.summary.mean);
  const auto kalman = KalmanFilter<6>().predict(voyage.belief.summary, transition);
  auto bank = voyage.bank.predict(voyage.belief, transition);
  EXPECT_NEAR(bank.summary.covariance(0, 0), kalman.covariance(0, 0), 1e-9 * kalman.covariance(0, 0));
  const auto z = voyage.model.measurement(bank.summary.mean.head<4>(), bank.summary.mean, voyage.time + 10);
  bank = voyage.bank.update(bank, z).belief;
  EXPECT_LT(bank.summary.covariance(0, 0), 1.5) << "a reading of 1 m was there";
}

TEST(BankKalmanFilter, RefusesOptionsOutOfTheirRange) {
  const auto refused = [](auto&& change) {
    Bank::Options options;
    change(options);
    EXPECT_THROW(Bank{options}, std::invalid_argument);
  };
  refused([](auto& o) { o.epoch = 0; });
  refused([](auto& o) { o.jump_probability = 0.5; });
  refused([](auto& o) { o.jump_scale = 0.5; });
  refused([](auto& o) { o.scales[3] = -1; });
  refused([](auto& o) { o.probabilities[0] = 0; });
  refused([](auto& o) { o.sticky = 1; });
  refused([](auto& o) { o.repeat = 1.5; });
  refused([](auto& o) { o.patience = 0; });
}

}  // namespace
}  // namespace sas_motion

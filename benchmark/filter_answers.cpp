// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Data, models and what our Kalman, cubature and unscented filters make of them, as JSON for benchmark/cross_check.py,
// which gives the same to other people's code. usage: filter_answers [STEPS]
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <limits>

#include "answer_cases.hpp"
#include "sas_motion/filters/kalman_filter.hpp"
#include "sas_motion/filters/sigma_point_filter.hpp"
#include "sas_motion/math/random.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::benchmark;

// alpha = 1e-3, the textbook's, has weights of 1e6: every implementation then loses six digits, and the comparison
// would be of rounding.
constexpr UnscentedOptions kUnscented{0.5, 2, 0};

template <class Case>
std::vector<Reading> readings(const Case& problem, int steps) {
  Random random(1);
  const auto noise = [&](const auto& covariance) {
    auto w = covariance.col(0).eval();
    for (int i = 0; i < w.size(); ++i) w(i) = random.gaussian();
    return (covariance.llt().matrixL() * w).eval();
  };
  State truth = problem.start.mean + noise(problem.start.covariance);
  std::vector<Reading> all;
  for (int k = 0; k < steps; ++k) {
    truth = problem.f(truth) + noise(problem.Q);
    all.push_back(problem.h(truth) + noise(problem.R));
  }
  return all;
}

/// One step of a filter: the belief before and after the reading.
struct Step {
  Belief prior, posterior;
};

template <class Case>
Step kalman(const Case& problem, const Belief& belief, const Reading& z) {
  const KalmanFilter<6> filter;
  const auto prior = filter.predict(belief, problem.transition(belief.mean));
  return {prior, filter.update(prior, problem.linearized(z, prior.mean)).belief};
}

template <int Count, class Case>
Step sigmaPoints(const SigmaPointFilter<6, Count>& filter, const Case& problem, const Belief& belief,
                 const Reading& z) {
  const auto f = [&](const State& x) { return problem.f(x); };
  const auto h = [&](const State& x) { return problem.h(x); };
  const auto prior = filter.predict(belief, f, problem.Q).value();
  return {prior, filter.update(prior, z, h, problem.R).belief};
}

/// A filter's beliefs over all readings, and the nanoseconds a step takes.
template <class Function>
json answers(const Belief& start, const std::vector<Reading>& all, Function step) {
  json priors = json::array(), posteriors = json::array();
  Belief belief = start;
  for (const auto& z : all) {
    const Step now = step(belief, z);
    priors.push_back(described(now.prior));
    posteriors.push_back(described(now.posterior));
    belief = now.posterior;
  }
  double fastest = std::numeric_limits<double>::infinity();
  for (int repetition = 0; repetition < 20; ++repetition) {
    const auto begin = std::chrono::steady_clock::now();
    belief = start;
    for (const auto& z : all) belief = step(belief, z).posterior;
    fastest =
        std::min(fastest, std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count());
  }
  const double checksum = belief.mean.sum();  // used, so that the loop above is not left out
  return {{"priors", priors},
          {"posteriors", posteriors},
          {"ns_per_step", fastest / static_cast<double>(all.size())},
          {"checksum", checksum}};
}

template <class Case>
json solved(const Case& problem, int steps) {
  const auto all = readings(problem, steps);
  const SigmaPointFilter ckf(cubaturePoints<6>());
  const SigmaPointFilter ukf(unscentedPoints<6>(kUnscented));
  json result = problem.description();
  result["Q"] = rows(problem.Q);
  result["R"] = rows(problem.R);
  result["start"] = described(problem.start);
  result["readings"] = json::array();
  for (const auto& z : all) result["readings"].push_back(rows(z));
  result["filters"] = {
      {"kf", answers(problem.start, all, [&](const Belief& b, const Reading& z) { return kalman(problem, b, z); })},
      {"ckf",
       answers(problem.start, all, [&](const Belief& b, const Reading& z) { return sigmaPoints(ckf, problem, b, z); })},
      {"ukf", answers(problem.start, all,
                      [&](const Belief& b, const Reading& z) { return sigmaPoints(ukf, problem, b, z); })}};
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  const int steps = argc > 1 ? std::atoi(argv[1]) : 200;
  const json unscented{{"alpha", kUnscented.alpha}, {"beta", kUnscented.beta}, {"kappa", kUnscented.kappa}};
  std::cout << json{{"unscented", unscented}, {"cases", {solved(Linear(), steps), solved(Towfish(), steps)}}} << "\n";
}

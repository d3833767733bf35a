// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Readings, models and what our bootstrap filter makes of them with many seeds, as JSON for
// benchmark/compare_particles.py, which gives the same to other people's code. usage: particle_answers RUNS
// PARTICLES...
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <vector>

#include "particle_cases.hpp"
#include "sas_motion/filters/particles/particle_filter.hpp"
#include "sas_motion/math/random.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::benchmark;

template <int N>
Vector<N> drawn(Random& random, const Matrix<N>& covariance) {
  Vector<N> w;
  for (int i = 0; i < N; ++i) w(i) = random.gaussian();
  return covariance.llt().matrixL() * w;
}

/// Of a truth that begins where the filters' belief has its mean.
template <class Case>
std::vector<Vector<Case::kRows>> readings(const Case& problem) {
  Random random(1);
  auto truth = problem.start.mean;
  std::vector<Vector<Case::kRows>> all;
  for (int k = 1; k <= Case::kSteps; ++k) {
    truth = problem.f(truth, k) + drawn<Case::kStates>(random, problem.Q);
    all.push_back(problem.h(truth) + drawn<Case::kRows>(random, problem.R));
  }
  return all;
}

/// Means and variances after each reading, a list a run, and the processor's nanoseconds a step; `told` times the noise
/// of the process is what the filter is told of it.
template <class Case>
json answers(const Case& problem, const std::vector<Vector<Case::kRows>>& all, int particles, int runs, double told) {
  const auto Q_root = choleskyLower<Case::kStates>(told * problem.Q).value();
  const auto h = [&](const auto& x) { return problem.h(x); };
  const auto difference = [&](const auto& a, const auto& b) { return problem.difference(a, b); };
  std::vector<Gaussian<Case::kStates>> beliefs(all.size());
  json means = json::array(), variances = json::array();
  double seconds = 0;
  for (int run = 0; run < runs; ++run) {
    ParticleOptions options;
    options.particles = particles;
    options.seed = static_cast<std::uint64_t>(run + 1);
    ParticleFilter<Case::kStates> filter(options);
    filter.start(problem.start);
    const std::clock_t begin = std::clock();
    for (std::size_t k = 0; k < all.size(); ++k) {
      filter.predict([&](const auto& x) { return problem.f(x, static_cast<int>(k) + 1); }, Q_root);
      filter.template update<Case::kRows>(all[k], h, problem.R, difference);
      beliefs[k] = filter.belief();
    }
    seconds += static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    json of_means = json::array(), of_variances = json::array();
    for (const auto& belief : beliefs) {
      of_means.push_back(rows(belief.mean));
      of_variances.push_back(rows(belief.covariance.diagonal().eval()));
    }
    means.push_back(of_means);
    variances.push_back(of_variances);
  }
  return {{"particles", particles},
          {"means", means},
          {"variances", variances},
          {"ns_per_step", 1e9 * seconds / (runs * static_cast<double>(all.size()))}};
}

template <class Case>
json solved(int runs, const std::vector<int>& particles) {
  const Case problem;
  const auto all = readings(problem);
  json result{{"name", Case::kName},
              {"start", {{"mean", rows(problem.start.mean)}, {"covariance", rows(problem.start.covariance)}}},
              {"Q", rows(problem.Q)},
              {"R", rows(problem.R)},
              {"readings", json::array()},
              {"answers", json::array()},
              {"misled", json::array()}};
  for (const auto& z : all) result["readings"].push_back(rows(z));
  constexpr double kMisled = 1.2;  // a filter that is told so much of the noise is to be found out
  for (const int count : particles) {
    result["answers"].push_back(answers(problem, all, count, runs, 1));
    result["misled"].push_back(answers(problem, all, count, runs, kMisled));
  }
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return EXIT_FAILURE;
  std::vector<int> particles;
  for (int i = 2; i < argc; ++i) particles.push_back(std::atoi(argv[i]));
  const int runs = std::atoi(argv[1]);
  std::cout << json{solved<Growth>(runs, particles), solved<Bearings>(runs, particles)} << "\n";
}

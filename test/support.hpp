// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What several tests share: seeded random problems and the paper's scenario.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <iostream>

#include "sas_motion/filters/linearized.hpp"
#include "sas_motion/math/gaussian.hpp"
#include "sas_motion/math/random.hpp"
#include "sas_motion/systems/towfish/config.hpp"
#include "sas_motion/systems/towfish/simulator.hpp"

namespace sas_motion::testing {

/// What a ConfigError says that `run` throws; empty where it throws none.
template <class Run>
std::string configErrorOf(const Run& run) {
  try {
    run();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

/// Expects that `run` throws a ConfigError that says all these words.
template <class Run>
void expectRefused(const Run& run, const std::vector<std::string>& words) {
  const std::string error = configErrorOf(run);
  EXPECT_FALSE(error.empty()) << "it was accepted";
  for (const auto& word : words)
    EXPECT_NE(error.find(word), std::string::npos) << "'" << word << "' is not in: " << error;
}

/// A random source that says its seed, so that a failure can be run again.
inline Random announced(std::uint64_t seed) {
  std::cout << "seed " << seed << "\n";
  return Random(seed);
}

template <int Rows, int Cols = 1>
Matrix<Rows, Cols> randomMatrix(Random& random) {
  Matrix<Rows, Cols> A;
  for (int row = 0; row < Rows; ++row)
    for (int col = 0; col < Cols; ++col) A(row, col) = random.gaussian();
  return A;
}

/// Symmetric, positive definite, with a condition number of some tens.
template <int N>
Matrix<N> randomCovariance(Random& random) {
  const Matrix<N> A = randomMatrix<N, N>(random);
  return A * A.transpose() / N + 0.1 * Matrix<N>::Identity();
}

template <int N>
Gaussian<N> randomBelief(Random& random) {
  return {randomMatrix<N>(random), randomCovariance<N>(random)};
}

/// A random linear measurement with independent rows.
template <int N, int M>
LinearMeasurement<N, M> randomMeasurement(Random& random) {
  LinearMeasurement<N, M> z;
  z.innovation = randomMatrix<M>(random);
  z.H = randomMatrix<M, N>(random);
  z.R.setZero();
  for (int row = 0; row < M; ++row) z.R(row, row) = 0.1 + random.uniform();
  return z;
}

template <int N>
double smallestEigenvalue(const Matrix<N>& A) {
  return Eigen::SelfAdjointEigenSolver<Matrix<N>>(A, Eigen::EigenvaluesOnly).eigenvalues().minCoeff();
}

/// The largest difference of two matrices' entries over the largest entry.
template <class A, class B>
double relativeDifference(const A& a, const B& b) {
  return (a - b).cwiseAbs().maxCoeff() / std::max(1e-300, b.cwiseAbs().maxCoeff());
}

/// The paper's scenario, shortened, with the same noise law on every sensor.
inline towfish::Scenario zhu2007(double duration, const NoiseMix& noise = {}) {
  auto scenario = towfish::Scenario::fromFile(std::string(SAS_MOTION_SOURCE_DIR) + "/config/scenarios/zhu2007.yaml");
  scenario.duration = duration;
  for (auto& sensor : scenario.sources) sensor.noise = noise;
  return scenario;
}

/// A GNSS-aided survey with its sensors at their own rates: 1 Hz, 10 Hz, 5 Hz, and a turn rate at 10 Hz.
inline towfish::Scenario survey(double duration) {
  towfish::Scenario scenario;
  scenario.kind = towfish::Scenario::Kind::Survey;
  scenario.duration = duration;
  scenario.sensor(towfish::Sensor::Position) = {1, 0.04, 1.0, {}};
  scenario.sensor(towfish::Sensor::Heading) = {10, 0.02, 0.5 * kRadPerDeg, {}};
  scenario.sensor(towfish::Sensor::Speed) = {5, 0.06, 0.05, {}};
  scenario.sensor(towfish::Sensor::TurnRate) = {10, 0.01, 0.1 * kRadPerDeg, {}};
  return scenario;
}

inline NoiseLaw contaminated(double epsilon, double K) { return {NoiseLaw::Kind::Contaminated, epsilon, K, 0, 0}; }

/// A whole simulated run, in time order.
struct Run {
  std::vector<towfish::TruthSample> truth;
  std::vector<towfish::LabelledMeasurement> labelled;
  std::vector<towfish::Measurement> measurements;

  const towfish::StateVector& truthAt(Stamp stamp) const {
    const auto found = std::lower_bound(truth.begin(), truth.end(), stamp,
                                        [](const auto& sample, Stamp s) { return sample.stamp < s; });
    return found->state;
  }
};

inline Run simulate(const towfish::Scenario& scenario, std::uint64_t seed) {
  Run run;
  towfish::Simulator simulator(scenario, seed);
  while (simulator.next()) {
    run.truth.push_back(simulator.truth());
    for (const auto& labelled : simulator.measurements()) {
      run.labelled.push_back(labelled);
      run.measurements.push_back(labelled.z);
    }
  }
  return run;
}

/// Estimators that know the model the scenario draws truth from.
inline towfish::Config configFor(const towfish::Scenario& scenario) {
  towfish::Config config;
  config.model = scenario.motion;
  return config;
}

}  // namespace sas_motion::testing

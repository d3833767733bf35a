// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The constant-velocity problem under eight noise laws: three axes at 2 Hz, the position measured in each and the
// velocity in the first.
#pragma once

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "sas_motion/math/random.hpp"
#include "sas_motion/systems/constant_velocity/model.hpp"

namespace sas_motion::testing {

/// What is drawn large, how often, and by how much.
struct EightLaw {
  std::string name;
  double epsilon = 0, K = 1;  ///< contaminated readings; with a K of 0, Student's t of 3 degrees of freedom
  bool process = false;       ///< one step in twenty has 10 times the process noise in all states
  bool burst = false;         ///< the positions are now and then off by 20 sigma for ten steps
};

inline const std::array<EightLaw, 8> kEightLaws{{{"gauss"},
                                                 {"meas10", 0.1, 10},
                                                 {"meas50", 0.1, 50},
                                                 {"meas30", 0.3, 50},
                                                 {"t3", 1, 0},
                                                 {"process", 0, 1, true},
                                                 {"both", 0.1, 10, true},
                                                 {"burst", 0, 1, false, true}}};

inline const constant_velocity::Model kCv;

/// One axis of the problem: position and velocity.
inline Transition<2> cvAxis(const Vector<2>& x) {
  const auto all = kCv.transition(Vector<6>::Zero());
  Transition<2> step;
  step.F << all.F(0, 0), all.F(0, 3), all.F(3, 0), all.F(3, 3);
  step.Q << all.Q(0, 0), all.Q(0, 3), all.Q(3, 0), all.Q(3, 3);
  step.mean = step.F * x;
  return step;
}

struct CvSample {
  Vector<6> truth;
  Vector<4> z;
  double process = 1;     ///< what an oracle is told: variances over the good ones
  Vector<4> measurement;  ///< likewise
};

inline std::vector<CvSample> cvRun(const EightLaw& law, Random& random, int steps) {
  const auto model = kCv.transition(Vector<6>::Zero());
  const Matrix<6> root = model.Q.llt().matrixL();
  Vector<6> x = Vector<6>::Zero();
  int burst = 0;
  std::vector<CvSample> run;
  for (int k = 0; k < steps; ++k) {
    CvSample sample;
    sample.process = law.process && random.bernoulli(0.05) ? 100 : 1;
    Vector<6> w;
    for (int i = 0; i < 6; ++i) w(i) = random.gaussian();
    x = model.F * x + std::sqrt(sample.process) * (root * w);
    burst = law.burst && burst == 0 && random.bernoulli(0.01) ? 10 : std::max(0, burst - 1);
    for (int row = 0; row < 4; ++row) {
      const double sigma = kCv.sigma()(row);
      double& told = sample.measurement(row);
      told = law.K == 0 ? 1.5 / random.gamma(1.5) : random.bernoulli(law.epsilon) ? law.K * law.K : 1;
      sample.z(row) = x(row) + sigma * std::sqrt(told) * random.gaussian();
      if (burst > 0 && row < 3) {
        sample.z(row) += 20 * sigma;
        told = 1e6;
      }
    }
    sample.truth = x;
    run.push_back(sample);
  }
  return run;
}

}  // namespace sas_motion::testing

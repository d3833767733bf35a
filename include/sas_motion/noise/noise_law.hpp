// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "sas_motion/config/yaml_section.hpp"

namespace sas_motion {

/// What a noise law is used for. Not every law suits both.
enum class NoiseUse { Sensor, Process };

/// A named distribution of noise; sizes are in units of the good standard deviation, times in seconds since the start.
///   gaussian       N(0, 1)
///   contaminated   (1 - epsilon) N(0, 1) + epsilon N(0, K^2), the paper's mixed normal [Zhu2007]
///   student_t      Student's t of nu degrees of freedom
///   burst          a bias of K during spells (`rate` a second, of `length` seconds)
///   step           a bias from t0 to t1
///   ramp           a bias that grows by `slope` a second from t0 to t1 and then ends
///   frozen         the last measurement again during spells
///   dropout        no measurement during spells, or for each measurement with `probability`
///   multipath      an added exponential of this mean, with `probability`
///   correlated     a share of the variance is a Gauss-Markov process
///   varying        the standard deviation swings between 1 and factor
///   quantised      the measurement is rounded to multiples of the quantum
///   manoeuvre      of the process: all its noise is K times larger during spells
struct NoiseLaw {
  enum class Kind {
    Gaussian,
    Contaminated,
    Burst,
    StudentT,
    Step,
    Ramp,
    Frozen,
    Dropout,
    Multipath,
    Correlated,
    Varying,
    Quantised,
    Manoeuvre
  };
  Kind kind = Kind::Gaussian;
  double epsilon = 0;  ///< share of outliers [-]
  double K = 1;        ///< their size, or a burst's [-]
  double rate = 0;     ///< spells a second [1/s]
  double length = 0;   ///< of a spell [s]
  double epoch = 0;    ///< of one draw for all states of a contaminated process; 0: a draw each state and step [s]
  double nu = 4;       ///< degrees of freedom [-]
  double bias = 0;     ///< [-]
  double slope = 0;    ///< [1/s]
  double t0 = 0;       ///< [s]
  double t1 = std::numeric_limits<double>::infinity();  ///< [s]
  double probability = 0;                               ///< of a draw [-]
  double mean = 1;                                      ///< of the exponential [-]
  double time_constant = 10;                            ///< [s]
  double share = 0;                                     ///< of the variance [-]
  double period = 60;                                   ///< [s]
  double factor = 1;                                    ///< largest standard deviation [-]
  double quantum = 0;                                   ///< [-]

  static NoiseLaw read(YamlSection yaml, NoiseUse use = NoiseUse::Sensor);
  /// A name for tables: gaussian, or e.g. contaminated(0.1,10).
  std::string name() const;
};

/// Laws that are applied one after the other; no law means gaussian.
struct NoiseMix {
  std::vector<NoiseLaw> laws;

  NoiseMix() = default;
  NoiseMix(const NoiseLaw& law) : laws{law} {}  // of one law
  NoiseMix(std::vector<NoiseLaw> all) : laws(std::move(all)) {}

  /// Reads a law, a list of laws, or nothing under `key`.
  static NoiseMix read(YamlSection& owner, const std::string& key, NoiseUse use = NoiseUse::Sensor);
  std::string name() const;
};

}  // namespace sas_motion

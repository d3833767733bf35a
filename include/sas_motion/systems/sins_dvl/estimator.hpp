// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sas_motion/filters/particles/unscented_particle_filter.hpp"
#include "sas_motion/systems/ins_gps_dvl/estimator.hpp"
#include "sas_motion/systems/sins_dvl/model.hpp"

namespace sas_motion::sins {

/// The settings of every estimator of this system.
struct Config {
  Parameters parameters;
  Mechanisation::Options imu;
  UnscentedParticleOptions
      particles;  ///< number, threads, seed; the estimator's name decides the weighting and whether there is a loss
  bool accelerometer_bias = true;  ///< 19 states; else the paper's 16
  double longest_step = 1;         ///< of one prediction of the filter [s]
  FilterOptions filters;           ///< of the fusion by small angles
  ins::FixedLag fixed_lag;         ///< of its factor graph
  bool vectorised = true;          ///< square-root filters by vector instructions
};

/// The same where an alignment found the start and the lever arms.
Config startedAt(Config config, const ins::Config& found);

/// Of the particles of the paper's filters, or of one filter of that kind alone.
enum class FilterKind { Bootstrap, Unscented, SquareRoot };
struct NamedFilter {
  std::string name;
  FilterKind kind;
  Weighting weighting = Weighting::Mixture;
  bool alone = false;   ///< one particle
  bool robust = false;  ///< with a loss against outliers
  bool steady = false;  ///< for imaging: without the jumps of readings, see SteadyTrack
};
const std::vector<NamedFilter>& namedFilters();
/// Null for an unknown name.
const NamedFilter* findFilter(const std::string& name);

/// The fusion by small angles, beside the named filters: kf27, robust_kf27 and so on.
const std::vector<std::string>& fusionNames();
/// What an estimator is called now whose name was another one before; any other name as it is.
std::string currentName(const std::string& name);

/// pf, upf, ss_srupf, their forms, ss_srukf, ukf, and beside them the fusion by small angles;
/// null for any other name. The INS is mechanised from its readings and, but for the latter, never corrected; its
/// estimated errors are taken out of the solution. Audits hold the effective number of particles.
std::unique_ptr<ins::Estimator> makeEstimator(const std::string& name, const Config& config);

/// The same sensors for the fusion by small angles.
ins::Config inSmallAngles(const Config& config);

using EstimatorFactory = std::function<std::unique_ptr<ins::Estimator>(const std::string&, const Config&)>;

}  // namespace sas_motion::sins

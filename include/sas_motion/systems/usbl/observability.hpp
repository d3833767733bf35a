// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sas_motion/systems/usbl/problem.hpp"

namespace sas_motion::usbl {

/// What a track can tell of the unknowns, before any estimate is trusted.
struct Observability {
  std::size_t pings = 0;
  std::vector<int>
      unknowns;  ///< that are estimated; mounting and lever arm, which the vectors below are of, come first
  std::vector<double>
      singular_values;  ///< of the pings' information in units of the prior's standard deviations, largest first [-]
  std::vector<double> weak_direction;  ///< where it is least, each part over what it would be known to if the others
                                       ///< were known; of unit length
  double weak_sigma = 0;  ///< what the pings alone know of it, over what the prior does; infinite for nothing [-]
  Unknowns bound = Unknowns::Zero();  ///< Cramer-Rao bound on each standard deviation, pings and prior; 0 for what is
                                      ///< known [rad, m, -]
  bool observable = false;            ///< the pings know every direction far better than the prior
  std::string verdict;                ///< in plain words, with what to do
};

/// Of pings whose information is `data`, without the prior's.
Observability observability(const Matrix<kUnknowns>& data, const Prior& prior, std::size_t pings);

/// At good noise of the problem's scale whose Fisher information is `factor` over a Gaussian's.
Observability observability(const Problem& problem, const Unknowns& x,
                            const Vector<kChannels>& factor = Vector<kChannels>::Ones());

}  // namespace sas_motion::usbl

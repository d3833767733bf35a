// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/random/gamma_distribution.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <cmath>
#include <cstdint>

namespace sas_motion {

/// A seeded source of random numbers: the same numbers on every platform. `stream` separates users of one seed, so that
/// adding a sensor does not change the noise of the others.
class Random {
 public:
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0) : engine_(mix(seed, stream)) {}

  double gaussian() { return normal_(engine_); }
  double uniform() { return uniform_(engine_); }
  bool bernoulli(double probability) { return uniform() < probability; }
  double exponential() { return -std::log1p(-uniform()); }                                          ///< of mean 1
  double gamma(double shape) { return boost::random::gamma_distribution<double>(shape)(engine_); }  ///< of scale 1

 private:
  static std::uint64_t mix(std::uint64_t seed, std::uint64_t stream) {  // splitmix64 [Steele2014]
    std::uint64_t z = seed * 0x9E3779B97F4A7C15ULL + stream * 0xD1B54A32D192ED03ULL + 0x9E3779B97F4A7C15ULL;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }

  boost::random::mt19937_64 engine_;
  boost::random::normal_distribution<double> normal_;
  boost::random::uniform_01<double> uniform_;
};

}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/evaluation/law_aware.hpp"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

#include "sas_motion/noise/noise_source.hpp"

namespace sas_motion {
namespace {

using Kind = NoiseLaw::Kind;
using Terms = std::vector<NoiseTerm>;

constexpr double kOnceInAWhile = 1e-3;  // rate of steps and ramps [1/s]
constexpr double kLongest = 1000;       // of those without an end [s]

/// All terms of one law for each of the terms before it.
Terms times(const Terms& before, const Terms& law) {
  Terms product;
  for (const auto& [variance, probability, mean] : law)
    for (const auto& term : before)
      product.push_back({variance * term.variance, probability * term.probability, std::sqrt(variance) * term.mean});
  return product;
}

Terms contaminated(double epsilon, double K) { return {{1, 1 - epsilon, 0}, {K * K, epsilon, 0}}; }

Terms varying(const NoiseLaw& law) {
  constexpr int kPhases = 6;
  Terms terms;
  for (int i = 0; i < kPhases; ++i)
    terms.push_back({std::pow(varyingSigma(law, 0.5 * law.period * (i + 0.5) / kPhases), 2), 1.0 / kPhases, 0});
  return terms;
}

/// The terms, and each of them with the parts of an exponential between its quantiles added.
Terms multipath(Terms before, double probability, double m) {
  const std::array<double, 8> quantiles{0, 0.1, 0.3, 0.5, 0.7, 0.85, 0.95, 1};
  const auto tail = [](double q) {
    return q < 1 ? std::pair{-std::log1p(-q), 1 - q} : std::pair{0.0, 0.0};
  };  // x in units of m, and e^-x
  Terms terms = before;
  for (auto& term : terms) term.probability *= 1 - probability;
  for (std::size_t i = 1; i < quantiles.size(); ++i) {
    const auto [a, ea] = tail(quantiles[i - 1]);
    const auto [b, eb] = tail(quantiles[i]);
    const double share = quantiles[i] - quantiles[i - 1], mean = ((a + 1) * ea - (b + 1) * eb) / share;
    const double square = ((a * a + 2 * a + 2) * ea - (b * b + 2 * b + 2) * eb) / share;
    for (const auto& term : before)
      terms.push_back({term.variance + m * m * (square - mean * mean), probability * share * term.probability,
                       term.mean + m * mean});
  }
  return terms;
}

/// Takes one more law of spells into the mode.
void addSpells(BiasMode& mode, double rate, double length, std::optional<double> bias) {
  const bool first = mode.rate == 0;
  mode.rate += rate;
  mode.length = first ? length : std::max(mode.length, length);
  mode.bias = first ? bias : std::nullopt;
}

void setProcess(GaussianSumOptions& options, const NoiseMix& process, double period) {
  double inflation = 1;
  for (const auto& law : process.laws) {
    if (law.kind == Kind::Contaminated && law.epoch > 0) {
      options.process = times(options.process, contaminated(law.epsilon, law.K));
      options.epoch = law.epoch;
    } else if (law.kind == Kind::Contaminated) {
      inflation *= 1 - law.epsilon + law.epsilon * law.K * law.K;
    } else if (law.kind == Kind::StudentT) {
      inflation *= law.nu > 2.1 ? law.nu / (law.nu - 2) : 20;
    } else if (law.kind == Kind::Manoeuvre && law.rate > 0 && law.length > 0) {
      const double share = law.rate * law.length / (1 + law.rate * law.length);
      options.process = times(options.process, contaminated(share, law.K));
      options.epoch = period;
      options.persistence = std::max(0.0, 1 - period / (law.length * (1 - share)));
    }
  }
  for (auto& term : options.process) term.variance *= inflation;
}

}  // namespace

std::vector<NoiseTerm> studentTerms(double nu) {
  const std::array<double, 8> quantiles{0,   0.003, 0.02, 0.07,
                                        0.2, 0.45,  0.75, 1};  // of the precision, finest where it is small
  const double shape = 0.5 * nu;
  const auto share = [&](double q) {
    return q < 1 ? boost::math::gamma_p(shape + 1, boost::math::gamma_p_inv(shape, q)) : 1;
  };  // of the mean, 1
  std::vector<NoiseTerm> terms;
  for (std::size_t i = quantiles.size() - 1; i > 0; --i) {
    const double probability = quantiles[i] - quantiles[i - 1];
    terms.push_back({probability / (share(quantiles[i]) - share(quantiles[i - 1])), probability, 0});
  }
  return terms;
}

GaussianSumOptions lawAware(const NoiseMix& measurement, const NoiseMix& process, double period, BurstSize bursts) {
  GaussianSumOptions options;
  Terms& terms = options.measurement;
  for (const auto& law : measurement.laws) switch (law.kind) {
      case Kind::Contaminated: terms = times(terms, contaminated(law.epsilon, law.K)); break;
      case Kind::StudentT: terms = times(terms, studentTerms(law.nu)); break;
      case Kind::Multipath: terms = multipath(terms, law.probability, law.mean); break;
      case Kind::Varying: terms = times(terms, varying(law)); break;
      case Kind::Quantised:
        for (auto& term : terms) term.variance += law.quantum * law.quantum / 12;
        break;
      case Kind::Burst:
        addSpells(options.mode, law.rate, std::max(law.length, period),
                  bursts == BurstSize::Known ? std::optional<double>(law.K) : std::nullopt);
        break;
      case Kind::Frozen: addSpells(options.mode, law.rate, std::max(law.length, period), std::nullopt); break;
      case Kind::Step:
      case Kind::Ramp:
        addSpells(options.mode, kOnceInAWhile, std::clamp(law.t1 - law.t0, period, kLongest), std::nullopt);
        break;
      case Kind::Gaussian:
      case Kind::Correlated:
      case Kind::Dropout:
      case Kind::Manoeuvre: break;
    }
  setProcess(options, process, period);
  return options;
}

}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// USBL calibration: how well the filters follow a noise that changes, and whether a circle centred on the transponder
// is refused. usage: usbl_figures [SEEDS]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

#include "sas_motion/math/statistics.hpp"
#include "sas_motion/systems/usbl/problem.hpp"
#include "systems/usbl/estimate.hpp"
#include "systems/usbl/graph/batch.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::usbl;

constexpr double kSettled = 60;   // [s]
constexpr double kFollows = 0.2;  // relative error of the variance

const NoiseLaw kOutliers{NoiseLaw::Kind::Contaminated, 0.1, 10};

NoiseLaw varying() {
  NoiseLaw law;
  law.kind = NoiseLaw::Kind::Varying;
  law.factor = 5;
  law.period = 1000;
  return law;
}

Scenario figureEight(const NoiseMix& noise) {
  Scenario scenario;
  scenario.track.centre = scenario.transponder_map.head<2>();
  scenario.noise.fill(noise);
  return scenario;
}

/// The median over seeds of the estimated over the true variance of good noise, by time, channel by channel; then its
/// worst and how often it is within 20 %.
void follow(const std::string& law, const std::string& filter, const NoiseMix& noise, std::uint64_t seeds) {
  const Scenario scenario = figureEight(noise);
  std::map<double, std::array<std::vector<double>, kChannels>> ratios;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed)
    for (const auto& estimate : estimate({}, scenario, simulatePings(scenario, seed), filter, {}).estimates)
      for (std::size_t i = 0; i < kChannels; ++i)
        if (estimate.time > kSettled)
          ratios[estimate.time][i].push_back(estimate.noise(static_cast<Eigen::Index>(i)) /
                                             std::pow(varyingSigma(varying(), estimate.time), 2));
  for (std::size_t i = 0; i < kChannels; ++i) {
    double least = INFINITY, most = 0, within = 0;
    for (const auto& [time, channels] : ratios) {
      const double median = quantile(channels[i], 0.5);
      least = std::min(least, median);
      most = std::max(most, median);
      within += std::abs(median - 1) <= kFollows;
    }
    fmt::print("{:<24}{:<18}{:>9}{:>10.3f}{:>10.3f}{:>16.1f}\n", law, filter, i, least, most,
               100 * within / static_cast<double>(ratios.size()));
  }
}

/// How often all six errors at the end are within three reported standard deviations.
void centredCircle(std::uint64_t seeds) {
  Scenario scenario = figureEight(kOutliers);
  scenario.track.kind = Track::Kind::Circle;
  scenario.track.radius = 224;
  std::map<std::string, int> covered;
  int refused = 0;
  std::string verdict;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const auto pings = simulatePings(scenario, seed);
    Problem problem;
    for (const auto& labelled : pings) problem.pings.push_back(labelled.ping);
    for (const char* name : {"ckf", "vbckf", "hckf", "hvbckf", "batch"}) {
      const auto estimates = estimate({}, scenario, pings, name, makeFitter).estimates;
      if (estimates.empty()) continue;
      const auto& belief = estimates.back().belief;
      const State error = belief.mean - scenario.truth.head<kStates>();
      covered[name] += (error.array().abs() <= 3 * belief.covariance.diagonal().array().sqrt()).all();
      if (std::string(name) != "batch") continue;
      const auto found = observability(problem, Model::widened(belief.mean));
      refused += !found.observable;
      verdict = found.verdict;
    }
  }
  fmt::print("\nA circle centred on the transponder, 10 % outliers, {} seeds: refused in {}. \"{}\"\n", seeds, refused,
             verdict);
  for (const auto& [name, count] : covered) fmt::print("{:<18}all six errors within 3 sigma in {}\n", name, count);
}

}  // namespace

int main(int argc, char** argv) {
  const auto seeds = static_cast<std::uint64_t>(argc > 1 ? std::max(1, std::atoi(argv[1])) : 100);
  fmt::print(
      "Estimated over true variance of good noise, median of {} seeds, after {} "
      "s\n{:<24}{:<18}{:>9}{:>10}{:>10}{:>16}\n",
      seeds, kSettled, "law", "filter", "channel", "least", "most", "within 20 % [%]");
  const std::vector<NoiseLaw> both{varying(), kOutliers};
  for (const char* filter : {"vbckf", "hvbckf"}) {
    follow("sigma 1 to 5", filter, varying(), seeds);
    follow("sigma 1 to 5, 10 %", filter, both, seeds);
  }
  centredCircle(seeds);
}

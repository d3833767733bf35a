// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "campaign/systems.hpp"
#include "sas_motion/io/cpu_time.hpp"
#include "sas_motion/systems/ins_gps_dvl/solutions.hpp"
#include "systems/ins_gps_dvl/campaign.hpp"
#include "systems/ins_gps_dvl/score.hpp"

namespace sas_motion {
namespace {

using namespace ins;

constexpr double kScoreEvery = 0.1;  // [s]

/// What one estimator made of a run.
struct Scored {
  std::string name;
  const NamedSolution* solution;  // none of an estimator that shares its run with no other
  Score score;
  double microseconds = 0;
};

/// One law with its run, scored by several estimators at once where they come from the same filter.
class RunScoring {
 public:
  RunScoring(const Scenario& scenario, double skip, std::uint64_t seed, const EstimatorFactory& make)
      : scenario_(scenario),
        trajectory_(scenario.track, scenario.duration),
        recording_(simulate(scenario, trajectory_, seed)),
        skip_(skip),
        make_(make) {}

  std::vector<Scored> of(const std::vector<std::string>& names) const {
    std::vector<Scored> all;
    for (const auto& name : names) all.push_back({name, findSolution(name), Score(scenario_, skip_)});
    const Config config = configOf(scenario_);
    for (const auto kind : kFilterKinds) {
      std::vector<Scored*> mine;
      for (auto& scored : all)
        if (scored.solution && scored.solution->filter == kind) mine.push_back(&scored);
      if (mine.empty()) continue;
      withFilter(kind, config,
                 [&](const auto& filter, const NavigatorOptions& options) { follow(filter, options, mine); });
    }
    for (auto& scored : all)
      if (!scored.solution) follow(*make_(scored.name, config), scored);
    return all;
  }

 private:
  template <class Filter>
  void follow(const Filter& filter, const NavigatorOptions& options, const std::vector<Scored*>& scored) const {
    Navigator<Filter> navigator(filter, scenario_.parameters, recording_.start, 0, options);
    auto next = recording_.aiding.begin();
    double scoring = 0;
    const double begin = cpuSeconds();
    for (const auto& reading : recording_.imu) {
      const auto first = next;
      for (; next != recording_.aiding.end() && next->reading.stamp <= reading.stamp; ++next)
        navigator.add(next->reading);
      navigator.add(reading);
      const double since = cpuSeconds();
      note(navigator, &*first, scored);
      scoring += cpuSeconds() - since;
    }
    const double seconds = cpuSeconds() - begin - scoring;
    for (auto* one : scored)
      one->microseconds = 1e6 * seconds / static_cast<double>(std::max<std::size_t>(1, recording_.aiding.size()));
  }

  /// `labelled` are the readings that the navigator audited, in order.
  template <class Filter>
  void note(const Navigator<Filter>& navigator, const LabelledAiding* labelled,
            const std::vector<Scored*>& scored) const {
    const double time = secondsBetween(0, navigator.stamp());
    for (std::size_t i = 0; i < navigator.audits().size(); ++i)
      for (auto* one : scored) one->score.add(navigator.audits()[i], labelled[i]);
    if (!isScored(time)) return;
    const TruthSample truth = trajectory_.at(time);
    for (auto* one : scored)
      if (const auto solution = solutionOf(navigator, one->solution->source)) one->score.add(truth, *solution);
  }

  static bool isScored(double time) {
    const double ticks = time / kScoreEvery;
    return std::abs(ticks - std::round(ticks)) < 1e-6;
  }

  /// An estimator that answers late, or at the end alone.
  void follow(Estimator& estimator, Scored& scored) const {
    Output output;
    const double begin = cpuSeconds();
    replay(estimator, recording_, output, [] {});
    scored.microseconds =
        1e6 * (cpuSeconds() - begin) / static_cast<double>(std::max<std::size_t>(1, recording_.aiding.size()));
    for (const auto& solution : output.solutions)
      if (const double time = secondsBetween(0, solution.stamp); isScored(time))
        scored.score.add(trajectory_.at(time), solution);
    for (std::size_t i = 0; i < std::min(output.audits.size(), recording_.aiding.size()); ++i)
      scored.score.add(output.audits[i], recording_.aiding[i]);
  }

  const Scenario& scenario_;
  Trajectory trajectory_;
  Recording recording_;
  double skip_;
  const EstimatorFactory& make_;
};

class InsSystem final : public System {
 public:
  InsSystem(YamlSection& campaign, const std::string& folder, const EstimatorFactory& make)
      : make_(make), scenarios_(readInsCampaign(campaign, folder, *this)) {
    dimension = kStates;
    for (const auto& name : estimators)
      if (!findSolution(name) && !make_(name, {}))
        campaign.fail("estimators", fmt::format("names '{}', which is no estimator of this system", name));
  }

  std::vector<EstimatorReport> run(std::size_t law, std::uint64_t seed) const override {
    std::vector<EstimatorReport> reports;
    for (const auto& scored : RunScoring(scenarios_[law], skip, seed, make_).of(estimators)) {
      reports.push_back(scored.score.report(scored.name));
      reports.back().microseconds = scored.microseconds;
    }
    return reports;
  }

  Named<Trace> trace(std::size_t law, std::uint64_t seed) const override {
    Named<Trace> traces;
    for (const auto& scored : RunScoring(scenarios_[law], skip, seed, make_).of(estimators))
      traces.emplace_back(scored.name, scored.score.trace());
    return traces;
  }

  Named<double> bound(std::size_t law, const std::vector<std::uint64_t>& seeds) const override {
    return insBound(scenarios_[law], skip, seeds);
  }

 private:
  EstimatorFactory make_;
  std::vector<Scenario> scenarios_;  // by law
};

}  // namespace

std::unique_ptr<System> makeInsSystem(YamlSection& campaign, const std::string& folder, const EstimatorFactory& make) {
  return std::make_unique<InsSystem>(campaign, folder, make);
}

}  // namespace sas_motion

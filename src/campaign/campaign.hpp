// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "evaluation/estimator_scorer.hpp"
#include "sas_motion/config/yaml_section.hpp"
#include "sas_motion/imaging/focus_bench.hpp"
#include "sas_motion/noise/noise_law.hpp"

namespace sas_motion {

/// One outlier law of a campaign, as tables and plots name it.
struct LawInfo {
  std::string name, description;
  std::optional<double> epsilon, K;  ///< of a contamination; 0 and 1 where the noise is good
};

/// How a law is named and plotted.
LawInfo lawInfo(const std::string& name, const NoiseMix& measurement, const NoiseMix& process);

/// The Kalman filter with the true variance of each row and of each draw of process noise. Truth that is not drawn from
/// the model has no such draws; the filter then has the model's own process noise.
constexpr const char* kOracle = "oracle_kf";
/// The Gaussian sum that knows the law of the position's noise, but not which readings are bad.
constexpr const char* kBayesReference = "bayes_reference";

/// One system under several outlier laws, estimated by several estimators.
class Campaign {
 public:
  virtual ~Campaign() = default;

  std::string title, kind;        ///< of the campaign; of the system
  double duration = 0, skip = 0;  ///< of a run, and of its start that is not scored [s]
  int dimension = 0;              ///< of the state
  int particles = 0;              ///< of its particle filters; 0 where it has none
  std::vector<std::string> estimators;
  std::vector<LawInfo> laws;

  /// Simulates one run and lets every estimator work on it. The same law and seed give the same numbers, on any thread.
  virtual std::vector<EstimatorReport> run(std::size_t law, std::uint64_t seed) const;
  Named<Trace> trace(std::size_t law, std::uint64_t seed) const;
  /// The posterior Cramer-Rao bound on each group's RMSE over the scored time, averaged over the truths of `seeds`;
  /// empty where there is none.
  virtual Named<double> bound(std::size_t, const std::vector<std::uint64_t>&) const { return {}; }
  /// Writes the image that every estimator of a run has of its first aperture into a folder; nothing where the system
  /// makes no images.
  virtual std::optional<imaging::FocusResult> images(std::size_t, std::uint64_t, const std::string&) const {
    return std::nullopt;
  }

 protected:
  /// The scores of every estimator over one run.
  virtual std::vector<EstimatorScorer> score(std::size_t, std::uint64_t) const { return {}; }

  /// Reads the scenario, a file or a mapping, and the duration, which goes over the scenario's.
  template <class Scenario>
  Scenario readScenario(YamlSection& yaml, const std::string& folder) {
    Scenario scenario = yaml.isMapping("scenario") ? Scenario::read(yaml.section("scenario"))
                                                   : Scenario::fromFile(fileOf(yaml, "scenario", folder));
    readDuration(yaml, scenario.duration);
    scenario.duration = duration;
    return scenario;
  }
  void readDuration(YamlSection& yaml, double of_scenario);
  /// Reads the start that is not scored, and the estimators, each of which must be known. A negative `default_skip`
  /// counts from the end of a run.
  /// `current_name` gives the present name of an estimator that had another one before.
  void readScoring(YamlSection& yaml, double default_skip, const std::function<bool(const std::string&)>& known,
                   const std::function<std::string(const std::string&)>& current_name = nullptr);
  /// The path of a file that a required key names.
  static std::string fileOf(YamlSection& yaml, const char* key, const std::string& folder);
  /// Reads the laws by `read(section, name, scenario)`, which changes a copy of the scenario. Returns the scenario
  /// under each law; without any law, the scenario itself under the name `unchanged`, where there is one.
  template <class Scenario, class Read>
  std::vector<Scenario> readLaws(YamlSection& yaml, const Scenario& scenario, const Read& read,
                                 std::optional<std::string> unchanged = std::nullopt) {
    auto items = yaml.list("laws");
    const bool none = items.empty();
    if (none && !unchanged) yaml.fail("laws", "is missing; list at least one");
    if (none) items.push_back(YamlSection::fromText("{}", yaml.file()));
    std::vector<Scenario> scenarios;
    for (auto& item : items) {
      std::string name = none ? *unchanged : "";
      item.text("name", name);
      scenarios.push_back(scenario);
      laws.push_back(read(item, name, scenarios.back()));
      item.finish();
    }
    return scenarios;
  }
};

}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "campaign/ordered_tasks.hpp"
#include "campaign/suite.hpp"
#include "support.hpp"
#include "systems/constant_velocity/campaign.hpp"
#include "systems/ins_gps_dvl/campaign.hpp"
#include "systems/sins_dvl/campaign.hpp"
#include "systems/towfish/campaign.hpp"
#include "systems/usbl/campaign.hpp"

namespace sas_motion::testing {

/// Readers of every system's campaigns; without other factories, with the estimators that need no factor graph.
inline CampaignReaders readers(const ins::EstimatorFactory& make_ins = ins::makeEstimator,
                               const sins::EstimatorFactory& make_sins = sins::makeEstimator,
                               const towfish::EstimatorFactory& make_towfish = towfish::makeEstimator,
                               const usbl::FitterFactory& fitters = {}) {
  using Yaml = YamlSection;
  using Folder = std::string;
  return {
      {"towfish", [=](Yaml& yaml, const Folder& at) { return towfish::readCampaign(yaml, at, make_towfish); }},
      {"constant_velocity", &constant_velocity::readCampaign},
      {"usbl", [=](Yaml& yaml, const Folder& at) { return usbl::readCampaign(yaml, at, fitters); }},
      {"ins_gps_dvl", [=](Yaml& yaml, const Folder& at) { return ins::readCampaign(yaml, at, make_ins); }},
      {"imaging", [=](Yaml& yaml, const Folder& at) { return ins::readImagingCampaign(yaml, at, make_ins); }},
      {"sins_dvl", [=](Yaml& yaml, const Folder& at) { return sins::readCampaign(yaml, at, make_sins); }},
  };
}

/// A suite from text, read as a file of its own.
inline Suite suiteOf(const std::string& text, const CampaignReaders& by = readers()) {
  const auto path = std::filesystem::path(::testing::TempDir()) /
                    ("suite_" + std::to_string(std::hash<std::string>()(text)) + ".yaml");
  std::ofstream(path) << text;
  return Suite::fromFile(path, by);
}

/// A suite that is refused with a message that has this word.
inline void expectRefused(const std::string& text, const std::string& word) {
  SCOPED_TRACE(text);
  testing::expectRefused([&] { suiteOf(text); }, {word});
}

/// A suite of one campaign on the paper's scenario, of `duration` seconds.
inline std::string zhuSuite(double duration, int runs, const std::string& estimators, const std::string& laws) {
  const auto scenario = std::filesystem::path(::testing::TempDir()) / ("zhu_" + std::to_string(duration) + ".yaml");
  std::ifstream original(std::string(SAS_MOTION_SOURCE_DIR) + "/config/scenarios/zhu2007.yaml");
  std::string text((std::istreambuf_iterator<char>(original)), {});
  text.replace(text.find("duration: 600"), 13, "duration: " + std::to_string(duration));
  std::ofstream(scenario) << text;
  return "{runs: " + std::to_string(runs) + ", campaigns: [{name: towfish, scenario: " + scenario.string() +
         ", skip: 20, estimators: " + estimators + ", laws: " + laws + "}]}";
}

/// Every run of a suite, on two threads.
inline std::vector<std::vector<EstimatorReport>> runAll(const Suite& suite) {
  std::cout << "seeds " << suite.first_seed << " to " << suite.first_seed + static_cast<std::uint64_t>(suite.runs) - 1
            << "\n";
  std::vector<std::vector<EstimatorReport>> all;
  inOrder(
      0, suite.tasks(), 2,
      [&](std::size_t index) {
        const auto task = suite.task(index);
        return task.campaign->run(task.law, task.seed);
      },
      [&](const std::vector<EstimatorReport>& reports) { all.push_back(reports); });
  return all;
}

/// The only estimator's error of each group that has a bound under the first law, over that bound, RMS over all runs.
inline std::map<std::string, double> overBound(const Suite& suite) {
  const auto runs = runAll(suite);
  std::map<std::string, double> ratios;
  for (const auto& [group, bound] : suite.campaigns[0]->bound(0, {1})) {
    std::vector<double> errors;
    for (const auto& reports : runs)
      for (const auto& [name, error] : reports.front().errors)
        if (name == group) errors.push_back(error.rmse);
    EXPECT_EQ(errors.size(), runs.size()) << group;
    ratios[group] = rootMeanSquare(errors) / bound;
    std::cout << group << ", error over bound: " << ratios[group] << "\n";
  }
  EXPECT_FALSE(ratios.empty());
  return ratios;
}

/// RMS position error of an estimator over all runs of a law, of a suite of one campaign.
inline double rmse(const Suite& suite, const std::vector<std::vector<EstimatorReport>>& runs, const std::string& law,
                   const std::string& estimator) {
  std::vector<double> errors;
  for (std::size_t task = 0; task < runs.size(); ++task) {
    if (suite.campaigns[0]->laws[suite.task(task).law].name != law) continue;
    for (const auto& report : runs[task])
      if (report.estimator == estimator) errors.push_back(report.errors.front().second.rmse);
  }
  EXPECT_FALSE(errors.empty()) << law << ", " << estimator;
  return rootMeanSquare(errors);
}

}  // namespace sas_motion::testing

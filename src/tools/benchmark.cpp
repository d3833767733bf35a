// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// benchmark SUITE.yaml -o OUT_DIR: Monte Carlo over outlier laws, seeds and estimators.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <thread>

#include "main_guard.hpp"
#include "progress.hpp"
#include "sas_motion/evaluation/ensemble.hpp"
#include "sas_motion/evaluation/monte_carlo.hpp"
#include "sas_motion/io/atomic_file.hpp"
#include "sas_motion/smoothers/factor_graph/estimators.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::towfish;
using nlohmann::json;

struct Options {
  std::string suite, out;
  int jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  int runs = 0;
};

json toJson(const RunResult& result) {
  const Scores& s = result.scores;
  json line{{"law", result.law}, {"estimator", result.estimator}, {"seed", result.seed}, {"samples", s.samples}, {"diverged", s.diverged}};
  for (int group = 0; group < kGroups; ++group) {
    const auto g = static_cast<Group>(group);
    if (s.error[g]) line[groupName(g)] = {{"rmse", s.error[g]->rmse}, {"p95", s.error[g]->p95}, {"max", s.error[g]->max}};
    if (s.nees[g]) line["nees"][groupName(g)] = s.nees[g]->mean;
  }
  if (s.nees_full) line["nees"]["full"] = s.nees_full->mean;
  line["aperture_across"] = s.aperture.across;
  return line;
}

/// One estimator under one law, over all seeds.
struct Row {
  std::vector<double> position, nees, aperture;
  std::vector<std::vector<double>> nees_over_time;
  double seconds = 0;
  std::size_t measurements = 0, diverged = 0;

  void add(const RunResult& result, double divergence) {
    const double rmse = result.scores.error[kPositionGroup] ? result.scores.error[kPositionGroup]->rmse : NAN;
    seconds += result.seconds;
    measurements += result.measurements;
    if (result.scores.diverged || !(rmse <= divergence)) {
      ++diverged;
      return;
    }
    position.push_back(rmse);
    aperture.push_back(result.scores.aperture.across);
    if (result.scores.nees_full) nees.push_back(result.scores.nees_full->mean);
    nees_over_time.push_back(result.nees);
  }
  double rmse() const { return position.empty() ? NAN : rootMeanSquare(position); }  // nothing to say where all runs diverged
  double median() const { return position.empty() ? NAN : quantile(position, 0.5); }
};

using Table = std::map<std::pair<std::string, std::string>, Row>;  // by law, estimator

Table tabulate(const Campaign& campaign, const std::vector<RunResult>& results) {
  std::map<std::string, std::vector<double>> clean;  // an estimator's position RMSE under the first law
  for (const auto& result : results)
    if (result.law == campaign.laws.front().name && result.scores.error[kPositionGroup])
      clean[result.estimator].push_back(result.scores.error[kPositionGroup]->rmse);
  Table table;
  for (const auto& result : results) table[{result.law, result.estimator}].add(result, 50 * quantile(clean[result.estimator], 0.5));
  return table;
}

double ratio(double a, double b) { return b > 0 ? a / b : NAN; }

/// NEES/6 is the mean over runs and time, +- its standard error; inside: how often the average over the runs lies in its 95 % chi-squared band.
void print(const Campaign& campaign, Table& table) {
  fmt::print("{}: {} runs of {:g} s, first {:g} s not scored, seeds {} to {}\n", campaign.name, campaign.runs, campaign.scenario.duration, campaign.skip,
             campaign.first_seed, campaign.first_seed + static_cast<std::uint64_t>(campaign.runs) - 1);
  const auto& clean = campaign.laws.front().name;
  const bool has_kf = table.count({clean, "kf"}), has_oracle = table.count({clean, kOracle});
  for (const auto& law : campaign.laws) {
    fmt::print("\n{}\n{:<14}{:>12}{:>12}{:>8}{:>8}{:>10}{:>14}{:>10}{:>8}{:>8}{:>10}{:>10}\n", law.name, "estimator", "RMSE [m]", "median [m]", "R", "/kf",
               "/oracle", "aperture [mm]", "NEES/6", "+-", "inside", "diverged", "us/update");
    for (const auto& name : campaign.estimators) {
      const Row& row = table[{law.name, name}];
      const auto ensemble = ensembleConsistency(row.nees_over_time, kStates);
      fmt::print("{:<14}{:>12.4f}{:>12.4f}{:>8.3f}{:>8.3f}{:>10.3f}{:>14.2f}{:>10.2f}{:>8.3f}{:>8.2f}{:>10}{:>10.2f}\n", name, row.rmse(), row.median(),
                 ratio(row.rmse(), table[{clean, name}].rmse()), has_kf ? ratio(row.rmse(), table[{law.name, "kf"}].rmse()) : NAN,
                 has_oracle ? ratio(row.rmse(), table[{law.name, kOracle}].rmse()) : NAN, 1e3 * mean(row.aperture), mean(row.nees) / kStates,
                 standardError(row.nees) / kStates, ensemble.inside, row.diverged,
                 1e6 * row.seconds / static_cast<double>(std::max<std::size_t>(1, row.measurements)));
    }
  }
}

json summary(const Campaign& campaign, Table& table) {
  json all{{"schema", "sas_motion/benchmark/1"}, {"suite", campaign.name}, {"runs", campaign.runs}, {"first_seed", campaign.first_seed}};
  for (const auto& law : campaign.laws)
    for (const auto& name : campaign.estimators) {
      const Row& row = table[{law.name, name}];
      const auto ensemble = ensembleConsistency(row.nees_over_time, kStates);
      all["laws"][law.name][name] = {{"position_rmse", row.rmse()},
                                     {"position_rmse_median", row.median()},
                                     {"nees_per_state", mean(row.nees) / kStates},
                                     {"nees_per_state_standard_error", standardError(row.nees) / kStates},
                                     {"nees_per_state_band", {ensemble.band.lower / kStates, ensemble.band.upper / kStates}},
                                     {"nees_inside_band", ensemble.inside},
                                     {"aperture_across", mean(row.aperture)},
                                     {"diverged", row.diverged}};
    }
  return all;
}

void run(const Options& options) {
  Campaign campaign = Campaign::fromFile(options.suite);
  if (options.runs > 0) campaign.runs = options.runs;
  for (const auto& name : campaign.estimators)
    if (name != kOracle && !makeAnyEstimator(name, campaign.config))
      throw std::runtime_error(
          fmt::format("{}: estimators: '{}' is no estimator; known are {} and {}", options.suite, name, fmt::join(estimatorNames(), ", "), kOracle));
  makeFolder(options.out);
  const double runs = static_cast<double>(campaign.laws.size()) * campaign.runs;
  std::vector<RunResult> results;
  {
    Progress progress("benchmark", runs, runs * campaign.scenario.duration);
    results = runCampaign(campaign, options.jobs, makeAnyEstimator, [&] { progress.advance(1); });
  }
  std::string lines;
  for (const auto& result : results) lines += toJson(result).dump() + "\n";
  Table table = tabulate(campaign, results);
  writeFile(options.out + "/results.jsonl", lines);
  writeFile(options.out + "/summary.json", summary(campaign, table).dump(2) + "\n");
  print(campaign, table);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Monte Carlo over outlier laws, seeds and estimators; prints a table, writes results.jsonl (a line a run) and summary.json.", "benchmark");
  app.add_option("SUITE", options.suite, "suite to run (YAML)")->required();
  app.add_option("-o,--output", options.out, "folder for the results")->required();
  app.add_option("-j,--jobs", options.jobs, "threads (default: all cores); the results do not depend on it")->check(CLI::Range(1, 1024));
  app.add_option("--runs", options.runs, "seeds a law, instead of the suite's")->check(CLI::Range(1, 1000000));
  return runTool(app, argc, argv, [&] { run(options); });
}

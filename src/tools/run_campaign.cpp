// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// run_campaign SUITE.yaml: the worker of benchmark. Simulates, estimates and scores; prints JSON. See
// docs/benchmark.md.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numeric>
#include <thread>

#include "campaign/ordered_tasks.hpp"
#include "sas_motion/io/atomic_file.hpp"
#include "systems/registry.hpp"
#include "tools/focus_steps.hpp"
#include "tools/main_guard.hpp"

namespace {

using namespace sas_motion;
using nlohmann::json;

struct Options {
  std::string suite, tasks, images;
  int runs = 0;
  int jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  bool plan = false, bounds = false, trace = false;
};

template <class Value>
json orNull(const std::optional<Value>& value) {
  return value ? json(*value) : json();
}

json planOf(const Suite& suite) {
  json plan{{"schema", "sas_motion/plan/1"}, {"suite", suite.name}, {"version", SAS_MOTION_VERSION},
            {"config_hash", suite.hash},     {"runs", suite.runs},  {"first_seed", suite.first_seed},
            {"tasks", suite.tasks()}};
  for (std::size_t i = 0; i < suite.campaigns.size(); ++i) {
    const Campaign& s = *suite.campaigns[i];
    json laws;
    for (const auto& law : s.laws)
      laws.push_back({{"name", law.name},
                      {"description", law.description},
                      {"epsilon", orNull(law.epsilon)},
                      {"K", orNull(law.K)}});
    plan["campaigns"].push_back({{"name", s.title},
                                 {"system", s.kind},
                                 {"first_task", suite.firstTask(i)},
                                 {"duration", s.duration},
                                 {"skip", s.skip},
                                 {"dimension", s.dimension},
                                 {"particles", s.particles > 0 ? json(s.particles) : json()},
                                 {"estimators", s.estimators},
                                 {"laws", laws}});
  }
  return plan;
}

json toJson(const Named<double>& values) {
  json object = json::object();
  for (const auto& [name, value] : values) object[name] = value;  // null where it is not finite
  return object;
}

json toJson(const EstimatorReport& report) {
  json result{{"diverged", report.diverged}, {"locked_out", report.locked_out}, {"samples", report.samples}};
  for (const auto& [group, error] : report.errors)
    result[group] = {{"rmse", error.rmse}, {"p95", error.p95}, {"max", error.max}};
  for (const auto& [group, value] : report.nees) result["nees"][group] = value;
  for (const auto& [sensor, value] : report.nis) result["nis"][sensor] = value;
  result["aperture_across"] = orNull(report.aperture_across);
  result["aperture_wavelengths"] = orNull(report.aperture_wavelengths);
  result["precision"] = orNull(report.precision);
  result["recall"] = orNull(report.recall);
  if (report.effective_size) result["effective_size"] = *report.effective_size;
  if (report.convergence) result["convergence"] = {{"after", orNull(report.convergence->after)}};
  for (const auto& window : report.windows) result["windows"].push_back(toJson(window));
  return result;
}

std::string lineOf(const Suite& suite, std::size_t index) {
  const auto [campaign, law, seed] = suite.task(index);
  json line{{"task", index}, {"campaign", campaign->title}, {"law", campaign->laws[law].name},
            {"seed", seed},  {"config_hash", suite.hash},   {"version", SAS_MOTION_VERSION}};
  for (const auto& report : campaign->run(law, seed)) {
    line["results"][report.estimator] = toJson(report);
    line["cost"][report.estimator] = report.microseconds;
  }
  return line.dump();
}

void printTasks(const Suite& suite, const Options& options) {
  std::size_t first = 0, last = 0;
  if (std::sscanf(options.tasks.c_str(), "%zu:%zu", &first, &last) != 2 || first > last || last > suite.tasks())
    throw std::runtime_error(
        fmt::format("--tasks: '{}' must be FIRST:LAST with at most {} tasks", options.tasks, suite.tasks()));
  inOrder(
      first, last, options.jobs, [&](std::size_t task) { return lineOf(suite, task); },
      [](const std::string& line) {
        fmt::print("{}\n", line);
        std::fflush(stdout);
      });
}

json boundsOf(const Suite& suite) {
  constexpr std::size_t kTruths = 20;
  std::vector<std::uint64_t> seeds(std::min<std::size_t>(kTruths, static_cast<std::size_t>(suite.runs)));
  std::iota(seeds.begin(), seeds.end(), suite.first_seed);
  json all = json::object();
  for (const auto& campaign : suite.campaigns)
    for (std::size_t law = 0; law < campaign->laws.size(); ++law) {
      json groups;
      for (const auto& [group, rmse] : campaign->bound(law, seeds)) groups[group] = {{"rmse", rmse}};
      all[campaign->title][campaign->laws[law].name] = groups;
    }
  return all;
}

/// Every n-th value, so that at most 600 are left.
template <class Value>
std::vector<Value> thinned(const std::vector<Value>& values) {
  const std::size_t step = values.size() / 600 + 1;
  std::vector<Value> some;
  for (std::size_t i = 0; i < values.size(); i += step) some.push_back(values[i]);
  return some;
}

json toJson(const Trace& t) {
  json others = json::array();
  for (const auto& [group, series] : t.others)
    others.push_back({{"group", group}, {"error", thinned(series.error)}, {"sigma3", thinned(series.sigma3)}});
  return {{"time", thinned(t.time)},
          {"error", thinned(t.error)},
          {"sigma3", thinned(t.sigma3)},
          {"others", others},
          {"nees", thinned(t.nees)},
          {"nis", thinned(t.nis)},
          {"weight_time", thinned(t.weight_time)},
          {"weight", thinned(t.weight)},
          {"outlier", thinned(t.outlier)},
          {"effective_time", thinned(t.effective_time)},
          {"effective_size", thinned(t.effective_size)},
          {"nees_degrees", t.nees_degrees},
          {"nis_degrees", t.nis_degrees}};
}

json tracesOf(const Suite& suite) {
  json all = json::object();
  for (const auto& campaign : suite.campaigns)
    for (std::size_t law = 0; law < campaign->laws.size(); ++law)
      for (const auto& [name, trace] : campaign->trace(law, suite.first_seed))
        all[campaign->title][campaign->laws[law].name][name] = toJson(trace);
  return all;
}

/// A folder a campaign that makes images, and in it one a law.
void writeImages(const Suite& suite, const std::string& folder) {
  const auto named = [](std::string name) {
    std::replace(name.begin(), name.end(), '/', '_');
    return "/" + name;
  };
  for (const auto& campaign : suite.campaigns)
    for (std::size_t law = 0; law < campaign->laws.size(); ++law) {
      const std::string place = folder + named(campaign->title) + named(campaign->laws[law].name);
      const auto result = campaign->images(law, suite.first_seed, place);
      if (!result) continue;
      writeFile(place + "/focus.json", focusDocument(*result));
      fmt::print("{}", focusTable(*result));
    }
}

void run(const Options& options) {
  Suite suite = Suite::fromFile(options.suite, campaignReaders());
  if (options.runs > 0) suite.runs = options.runs;
  if (options.plan) fmt::print("{}\n", planOf(suite).dump());
  if (!options.tasks.empty()) printTasks(suite, options);
  if (options.bounds) fmt::print("{}\n", boundsOf(suite).dump());
  if (options.trace) fmt::print("{}\n", tracesOf(suite).dump());
  if (!options.images.empty()) writeImages(suite, options.images);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("The worker of benchmark: simulates, estimates and scores the runs of a suite; prints JSON.",
               "run_campaign");
  app.add_option("SUITE", options.suite, "suite (YAML)")->required();
  app.add_option("--runs", options.runs, "seeds a law, instead of the suite's")->check(CLI::Range(1, 1000000));
  app.add_option("-j,--jobs", options.jobs, "threads (default: all cores); the results do not depend on it")
      ->check(CLI::Range(1, 1024));
  auto* what = app.add_option_group("what to print");
  what->add_flag("--plan", options.plan, "what the suite holds");
  what->add_option("--tasks", options.tasks, "FIRST:LAST: the results of these runs, a line each, in order");
  what->add_flag("--bounds", options.bounds, "posterior Cramer-Rao bounds");
  what->add_flag("--trace", options.trace, "the first seed of every law over time");
  what->add_option(
      "--images", options.images,
      "folder for the images of the first seed of every law, which plot_focus.py draws; and their measures");
  what->require_option(1);
  return runTool(app, argc, argv, [&] { run(options); });
}

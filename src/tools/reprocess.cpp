// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// reprocess IN.bag...: estimators over recorded bags.
#include "bag/reprocess.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <future>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "bag/bag_reader.hpp"
#include "sas_motion/estimate/old_names.hpp"
#include "sas_motion/io/atomic_file.hpp"
#include "sas_motion/io/fingerprint.hpp"
#include "systems/registry.hpp"
#include "tools/main_guard.hpp"
#include "tools/progress.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::ros_side;
using nlohmann::json;

struct Options {
  std::vector<std::string> bags;
  std::string out = "reprocessed", config;
  std::vector<std::string> estimators;
  int jobs = 1;
  bool resume = false;
};

/// What identifies a finished bag: the same input, configuration and estimators would give the same bytes again.
json identity(const std::string& bag, const Options& options) {
  return {{"input", Fingerprint::ofFile(bag)},
          {"config", options.config.empty() ? "built in" : Fingerprint::ofFile(options.config)},
          {"estimators", options.estimators}};
}

json toJson(const ReprocessReport& report) {
  json entry{{"messages", report.messages}, {"duration", report.duration}};
  for (const auto& [name, counts] : report.sensors)
    entry["sensors"][name] = {{"messages", counts.messages},
                              {"unknown_frame", counts.unknown_frame},
                              {"unusable", counts.unusable},
                              {"lost", counts.lost}};
  for (const auto& [name, e] : report.estimators)
    entry["results"][name] = {{"estimates", e.estimates},       {"accepted", e.verdicts[0]},
                              {"down_weighted", e.verdicts[1]}, {"rejected", e.verdicts[2]},
                              {"stale", e.verdicts[3]},         {"invalid", e.verdicts[4]}};
  if (!report.warnings.empty()) entry["remarks"] = report.warnings;
  return entry;
}

json costOf(const ReprocessReport& report) {
  json cost;
  for (const auto& [name, e] : report.estimators)
    cost[name] = {{"seconds", e.lane.seconds}, {"measurements", e.lane.measurements}, {"duration", report.duration}};
  return cost;
}

void printReport(const ReprocessReport& report) {
  fmt::print("{} -> {}\n", report.input, report.output);
  for (const auto& [name, counts] : report.sensors) {
    fmt::print("  {:<14}{:>9} messages", name, counts.messages);
    if (counts.unknown_frame) fmt::print(", {} of an unknown frame", counts.unknown_frame);
    if (counts.unusable) fmt::print(", {} without a reading", counts.unusable);
    if (counts.lost) fmt::print(", {} lost before", counts.lost);
    fmt::print("\n");
  }
  for (const auto& [name, e] : report.estimators)
    fmt::print("  {:<14}{:>9} estimates, {} accepted, {} down-weighted, {} rejected, {} stale, {} invalid\n", name,
               e.estimates, e.verdicts[0], e.verdicts[1], e.verdicts[2], e.verdicts[3], e.verdicts[4]);
  for (const auto& warning : report.warnings) fmt::print("  {}\n", warning);
}

/// A smoother that found no answer is an error, though the other estimators' results stand.
void requireAnswers(const ReprocessReport& report) {
  for (const auto& [name, e] : report.estimators)
    if (!e.lane.failure.empty())
      throw std::runtime_error(fmt::format("{}: {} found no answer: {}", report.input, name, e.lane.failure));
}

/// The manifest of a folder, rewritten whole after each bag.
class Manifest {
 public:
  explicit Manifest(std::string path) : path_(std::move(path)) {
    std::ifstream stream(path_);
    if (stream) all_ = json::parse(stream, nullptr, false);
    if (!all_.is_object()) all_ = json::object();
    all_["schema"] = "sas_motion/manifest/1";
  }
  bool has(const std::string& bag, const json& identity) const {
    return all_.contains("bags") && all_["bags"].contains(bag) &&
           all_["bags"][bag].value("identity", json()) == identity;
  }
  void add(const std::string& bag, json entry) {
    all_["bags"][bag] = std::move(entry);
    writeFile(path_, all_.dump(2) + "\n");
  }

 private:
  std::string path_;
  json all_;
};

/// The outputs of two bags must not have the same name.
void requireDistinct(const std::vector<std::string>& bags) {
  std::set<std::string> files;
  for (const auto& bag : bags)
    if (!files.insert(std::filesystem::path(bag).filename()).second)
      throw std::runtime_error(
          fmt::format("{}: another bag of this name is among the inputs; reprocess it into another folder", bag));
}

void requireKnown(const std::vector<std::string>& estimators, const System& system) {
  try {
    system.require(estimators);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("--estimators: {}", error.what()));
  }
}

void run(Options options) {
  const auto system = openSystem(options.config);
  if (options.estimators.empty()) options.estimators = system->preferred;
  for (const auto& sentence :
       replaceOldNames(options.estimators, [&](const auto& name) { return system->currentName(name); }))
    fmt::print(stderr, "reprocess: {}\n", sentence);
  requireKnown(options.estimators, *system);
  requireDistinct(options.bags);
  double duration = 0;
  for (const auto& bag : options.bags) {
    const BagReader source(bag);
    duration += (source.end() - source.begin()).toSec();
  }
  makeFolder(options.out);
  Manifest manifest(options.out + "/manifest.json");
  Progress progress("reprocess", duration, duration);
  std::atomic<std::size_t> next{0};
  std::vector<std::string> failures;
  std::mutex mutex;
  const auto work = [&] {
    for (std::size_t i = next++; i < options.bags.size(); i = next++) {
      const std::string& bag = options.bags[i];
      const std::string name = std::filesystem::path(bag).filename();
      try {
        const std::shared_future<json> id =
            std::async(std::launch::async, identity, bag, options);  // while the bag is read
        if (options.resume) {
          id.wait();
          const std::lock_guard<std::mutex> lock(mutex);
          if (manifest.has(name, id.get()) && std::filesystem::exists(options.out + "/" + name)) continue;
        }
        const auto report = reprocess(bag, options.out, options.estimators, *system,
                                      [&](double seconds) { progress.advance(seconds); });
        json entry = toJson(report);
        entry["identity"] = id.get();
        const std::lock_guard<std::mutex> lock(mutex);
        writeFile(options.out + "/" + std::filesystem::path(name).stem().string() + ".cost.json",
                  costOf(report).dump(2) + "\n");
        printReport(report);
        requireAnswers(report);
        manifest.add(name, entry);
      } catch (const std::exception& error) {
        const std::lock_guard<std::mutex> lock(mutex);
        failures.emplace_back(error.what());
      }
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < options.jobs; ++i) threads.emplace_back(work);
  for (auto& thread : threads) thread.join();
  if (!failures.empty()) throw std::runtime_error(fmt::format("{}", fmt::join(failures, "\n")));
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Runs estimators over recorded bags: each IN.bag to OUT_DIR/IN.bag with estimates and audit, a TUM file an "
      "estimator, manifest.json.",
      "reprocess");
  app.add_option("BAG", options.bags, "bags to read")->required();
  app.add_option("-o,--output", options.out, "folder for the results (default: reprocessed)");
  app.add_option("--estimators", options.estimators, "names, comma-separated (default: the system's, as live)")
      ->delimiter(',');
  app.add_option("--config", options.config, "configuration (YAML; default: built in)");
  app.add_option("-j,--jobs", options.jobs, "bags at once (default 1)")->check(CLI::Range(1, 1024));
  app.add_flag("--resume", options.resume,
               "skip bags that the manifest says are done with the same input, configuration and estimators");
  return runTool(app, argc, argv, [&] { run(options); });
}

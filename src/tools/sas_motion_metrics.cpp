// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// sas_motion_metrics OUT.bag -o DIR: scores the estimates in a bag against its truth. evaluate.py calls it and draws the report.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "main_guard.hpp"
#include "sas_motion/bag/recording.hpp"
#include "sas_motion/bag/tum.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::ros_side;
using namespace sas_motion::towfish;
using nlohmann::json;

constexpr std::size_t kMostPoints = 6000;  // of one plotted series
constexpr double kShortestOutage = 30;     // a gap between fixes that is reported as an outage [s]

struct Options {
  std::string bag, out;
  double skip = 20;
  ApertureOptions aperture;
};

double rounded(double value) { return std::isfinite(value) ? std::round(value * 1e6) / 1e6 : 0; }
json orNull(const std::optional<double>& value) { return value ? json(*value) : json(nullptr); }

json toJson(const ErrorSummary& e, double unit) { return {{"rmse", e.rmse / unit}, {"p95", e.p95 / unit}, {"max", e.max / unit}}; }
json toJson(const Consistency& c) {
  return {{"mean", c.mean}, {"degrees", c.degrees}, {"lower", c.lower}, {"upper", c.upper}, {"inside", c.inside}, {"count", c.count}};
}
json toJson(const Detection& d) {
  return {{"labelled", d.labelled}, {"flagged", d.flagged}, {"hits", d.hits}, {"precision", orNull(d.precision())}, {"recall", orNull(d.recall())}};
}

/// Stretches without fixes, and the position error of the last estimate before the fixes came back.
std::vector<Outage> outages(const Recording& recording, const RecordedEstimator& estimator) {
  std::vector<Outage> found;
  for (std::size_t i = 1; i < recording.fixes.size(); ++i) {
    const Stamp from = recording.fixes[i - 1].stamp, to = recording.fixes[i].stamp;
    if (secondsBetween(from, to) < kShortestOutage) continue;
    Outage outage{secondsBetween(recording.begin, from), secondsBetween(from, to), 0, -1};
    std::optional<Vector<2>> last;
    for (const auto& truth : recording.truth) {
      if (truth.stamp < from || truth.stamp >= to) continue;
      if (last) outage.distance += (truth.reference.state.head<2>() - *last).norm();
      last = truth.reference.state.head<2>();
    }
    for (const auto& estimate : estimator.estimates)
      if (estimate.stamp > from && estimate.stamp < to)
        if (const auto truth = recording.truthAt(estimate.stamp)) outage.error_end = (estimate.belief.mean - truth->state).head<2>().norm();
    if (outage.error_end >= 0 && outage.distance > 0) found.push_back(outage);
  }
  return found;
}

/// One estimator scored: its metrics, and its scored trajectory beside truth in TUM files.
class Judge {
 public:
  Judge(const Recording& recording, const Options& options) : recording_(recording), options_(options) {}

  json metrics(const std::string& name, const RecordedEstimator& estimator, const json& cost) const {
    Scorer scorer(options_.aperture);
    TumFile tum(options_.out + "/" + name + ".tum"), truth_tum(options_.out + "/" + name + ".truth.tum");
    const Stamp from = recording_.begin + stampFromSeconds(options_.skip);
    for (const auto& estimate : estimator.estimates) {
      const auto truth = recording_.truthAt(estimate.stamp);
      if (estimate.stamp < from || !truth) continue;
      scorer.add(estimate, *truth);
      tum.write(estimate);
      truth_tum.write({estimate.stamp, {truth->state, StateMatrix::Identity()}});
    }
    for (const auto& audit : estimator.audits) {
      const auto label = recording_.outlier.find({audit.stamp, sensorName(audit.sensor)});
      if (audit.stamp >= from) scorer.add(audit, label == recording_.outlier.end() ? std::nullopt : std::optional<bool>(label->second));
    }
    tum.commit();
    truth_tum.commit();
    return describe(scorer.scores(), outages(recording_, estimator), cost);
  }

 private:
  json describe(const Scores& s, const std::vector<Outage>& gaps, const json& cost) const {
    json m{{"samples", s.samples},  {"diverged", s.diverged},     {"drift_percent", 100 * s.drift}, {"nees", json::object()},
           {"nis", json::object()}, {"outliers", json::object()}, {"outages", json::array()},       {"cost", cost}};
    for (int i = 0; i < kGroups; ++i) {
      const auto group = static_cast<Group>(i);
      const bool angle = group == kHeadingGroup;
      if (s.error[group]) m[angle ? "heading_deg" : groupName(group)] = toJson(*s.error[group], angle ? kRadPerDeg : 1);
      if (s.nees[group]) m["nees"][groupName(group)] = toJson(*s.nees[group]);
    }
    const ApertureError& a = s.aperture;
    m["aperture"] = {{"time", a.time},     {"wavelength", a.wavelength}, {"windows", a.windows},
                     {"across", a.across}, {"along", a.along},           {"across_wavelengths", a.across / a.wavelength}};
    Detection all;
    for (int i = 0; i < kSensors; ++i) {
      const char* name = sensorName(static_cast<Sensor>(i));
      const auto index = static_cast<std::size_t>(i);
      if (s.nis[index]) m["nis"][name] = toJson(*s.nis[index]);
      if (!recording_.labelled() || rowsOf(static_cast<Sensor>(i)) == 0) continue;
      m["outliers"][name] = toJson(s.detection[index]);
      all.labelled += s.detection[index].labelled;
      all.flagged += s.detection[index].flagged;
      all.hits += s.detection[index].hits;
    }
    if (recording_.labelled()) m["outliers"]["all"] = toJson(all);
    for (const auto& gap : gaps)
      m["outages"].push_back({{"begin", gap.begin},
                              {"duration", gap.duration},
                              {"distance", gap.distance},
                              {"error_end", gap.error_end},
                              {"drift_percent", 100 * gap.error_end / gap.distance}});
    m["verdicts"] = {
        {"accepted", s.verdicts[0]}, {"down_weighted", s.verdicts[1]}, {"rejected", s.verdicts[2]}, {"stale", s.verdicts[3]}, {"invalid", s.verdicts[4]}};
    return m;
  }

  const Recording& recording_;
  const Options& options_;
};

/// Named columns that grow by rows and are thinned to what a plot can show.
class Series {
 public:
  Series(std::initializer_list<const char*> names, std::size_t rows) : every_(std::max<std::size_t>(1, rows / kMostPoints)) {
    for (const char* name : names) columns_[name] = json::array();
    names_.assign(names.begin(), names.end());
  }
  /// `keep` rows are never thinned out.
  void add(std::initializer_list<double> values, bool keep = false) {
    if (count_++ % every_ != 0 && !keep) return;
    auto name = names_.begin();
    for (const double value : values) columns_[*name++].push_back(rounded(value));
  }
  const json& columns() const { return columns_; }

 private:
  std::size_t every_, count_ = 0;
  std::vector<std::string> names_;
  json columns_;
};

json seriesOf(const Recording& recording, const RecordedEstimator& estimator) {
  Series states({"t", "north", "east", "error_north", "sigma_north", "error_east", "sigma_east", "error_heading_deg", "sigma_heading_deg"},
                estimator.estimates.size());
  for (const auto& estimate : estimator.estimates) {
    const auto truth = recording.truthAt(estimate.stamp);
    if (!truth) continue;
    const StateVector error = Model::difference(estimate.belief.mean, truth->state);
    const auto& P = estimate.belief.covariance;
    states.add({secondsBetween(recording.begin, estimate.stamp), estimate.belief.mean(kNorth), estimate.belief.mean(kEast), error(kNorth),
                std::sqrt(P(kNorth, kNorth)), error(kEast), std::sqrt(P(kEast, kEast)), truth->heading_known ? error(kHeading) / kRadPerDeg : 0,
                std::sqrt(P(kHeading, kHeading)) / kRadPerDeg});
  }
  json all = states.columns();
  for (int i = 0; i < kSensors; ++i) {
    const auto sensor = static_cast<Sensor>(i);
    if (rowsOf(sensor) == 0) continue;
    Series updates({"t", "weight", "nis"}, estimator.audits.size() / 3);
    for (const auto& audit : estimator.audits)
      if (audit.sensor == sensor && audit.rows > 0) {
        const double weight = audit.weights.head(audit.rows).minCoeff();
        updates.add({secondsBetween(recording.begin, audit.stamp), weight, audit.nis}, weight < kDownWeighted);
      }
    all["updates"][sensorName(sensor)] = updates.columns();
  }
  return all;
}

json seriesOf(const Recording& recording) {
  Series truth({"t", "north", "east"}, recording.truth.size());
  for (const auto& t : recording.truth) truth.add({secondsBetween(recording.begin, t.stamp), t.reference.state(kNorth), t.reference.state(kEast)});
  json fixes{{"t", json::array()}, {"north", json::array()}, {"east", json::array()}, {"outlier", json::array()}};
  for (const auto& fix : recording.fixes) {
    const auto label = recording.outlier.find({fix.stamp, "position"});
    fixes["t"].push_back(rounded(secondsBetween(recording.begin, fix.stamp)));
    fixes["north"].push_back(rounded(fix.position(0)));
    fixes["east"].push_back(rounded(fix.position(1)));
    fixes["outlier"].push_back(label == recording.outlier.end() ? json(nullptr) : json(label->second ? 1 : 0));
  }
  json all{{"truth", truth.columns()}, {"fixes", fixes}};
  for (const auto& [name, estimator] : recording.estimators) all["estimators"][name] = seriesOf(recording, estimator);
  return all;
}

/// What reprocess said of the cost, in the file beside the bag; null for an estimator without.
json costOf(const std::string& bag, const std::string& name) {
  std::filesystem::path path = bag;
  std::ifstream stream(path.replace_extension(".cost.json"));
  const json all = stream ? json::parse(stream, nullptr, false) : json();
  if (!all.is_object() || !all.contains(name)) return nullptr;
  const double seconds = all[name].value("seconds", 0.0), measurements = all[name].value("measurements", 0.0), duration = all[name].value("duration", 0.0);
  if (!(seconds > 0) || !(measurements > 0)) return nullptr;
  return {{"seconds", seconds}, {"microseconds_per_update", 1e6 * seconds / measurements}, {"times_real_time", duration / seconds}};
}

void run(const Options& options) {
  const Recording recording = Recording::read(options.bag);
  makeFolder(options.out);
  const Judge judge(recording, options);
  double distance = 0;
  for (std::size_t i = 1; i < recording.truth.size(); ++i)
    distance += (recording.truth[i].reference.state - recording.truth[i - 1].reference.state).head<2>().norm();
  json metrics{{"schema", "sas_motion/metrics/1"},
               {"bag", std::filesystem::path(options.bag).filename().string()},
               {"truth", recording.truth_topic},
               {"duration", secondsBetween(recording.begin, recording.end)},
               {"distance", distance},
               {"skipped", options.skip}};
  for (const auto& [name, estimator] : recording.estimators) metrics["estimators"][name] = judge.metrics(name, estimator, costOf(options.bag, name));
  writeFile(options.out + "/series.json", seriesOf(recording).dump());
  writeFile(options.out + "/metrics.json", metrics.dump(2) + "\n");
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Scores the estimates in a bag against its truth: metrics.json, series.json and TUM files. evaluate.py adds table and report.",
               "sas_motion_metrics");
  app.add_option("BAG", options.bag, "bag with truth and estimates")->required();
  app.add_option("-o,--output", options.out, "folder for the results")->required();
  app.add_option("--skip", options.skip, "seconds at the start that are not scored (default 20)")->check(CLI::NonNegativeNumber);
  app.add_option("--range", options.aperture.range, "slant range of the aperture error [m] (default 100)")->check(CLI::PositiveNumber);
  app.add_option("--wavelength", options.aperture.wavelength, "wavelength of the aperture error [m] (default 0.015)")->check(CLI::PositiveNumber);
  app.add_option("--element", options.aperture.element, "array element of the aperture error [m] (default 0.1)")->check(CLI::PositiveNumber);
  return runTool(app, argc, argv, [&] { run(options); });
}

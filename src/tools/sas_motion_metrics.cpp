// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// sas_motion_metrics OUT.bag -o DIR: scores the estimates in a bag against its truth. evaluate.py calls it and draws
// the report.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "bag/recording.hpp"
#include "bag/tum.hpp"
#include "sas_motion/math/statistics.hpp"
#include "sas_motion/systems/towfish/solution.hpp"
#include "tools/main_guard.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::ros_side;
using namespace sas_motion::towfish;
using nlohmann::json;

constexpr std::size_t kMostPoints = 6000;  // of one plotted series
constexpr double kShortestOutage = 30;     // a gap between fixes that is reported as an outage [s]
constexpr double kAligned = 2;             // a heading that is off by less is aligned [deg],
constexpr double kAlignedFor = 30;         // where it stays so to the end, for this time at least [s]

struct Options {
  std::string bag, out;
  double skip = 20;
  ApertureOptions aperture;
};

double rounded(double value) { return std::isfinite(value) ? std::round(value * 1e6) / 1e6 : 0; }
json orNull(const std::optional<double>& value) { return value ? json(*value) : json(nullptr); }

json toJson(const ErrorSummary& e, double unit) {
  return {{"rmse", e.rmse / unit}, {"p95", e.p95 / unit}, {"max", e.max / unit}};
}
json toJson(const Consistency& c) {
  return {{"mean", c.mean},   {"degrees", c.degrees}, {"lower", c.lower},
          {"upper", c.upper}, {"inside", c.inside},   {"count", c.count}};
}
json toJson(const Detection& d) {
  return {{"labelled", d.labelled},
          {"flagged", d.flagged},
          {"hits", d.hits},
          {"precision", orNull(d.precision())},
          {"recall", orNull(d.recall())}};
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
        if (const auto truth = recording.truthAt(estimate.stamp))
          outage.error_end = (estimate.belief.mean - truth->state).head<2>().norm();
    if (outage.error_end >= 0 && outage.distance > 0) found.push_back(outage);
  }
  return found;
}

/// One estimator scored: its metrics, and its scored trajectory beside truth in TUM files.
class Judge {
 public:
  Judge(const Recording& recording, const Options& options)
      : recording_(recording), options_(options), begins_off_(beginsOff()) {}

  json metrics(const std::string& name, const RecordedEstimator& estimator, const json& cost) const {
    Scorer scorer(options_.aperture);
    MotionScorer motions;
    TumFile tum(options_.out + "/" + name + ".tum"), truth_tum(options_.out + "/" + name + ".truth.tum");
    const Stamp from = recording_.begin + stampFromSeconds(options_.skip);
    for (const auto& estimate : estimator.estimates) {
      auto truth = recording_.truthAt(estimate.stamp);
      if (estimate.stamp < from || !truth) continue;
      truth->heading_known &= estimate.belief.covariance(kHeading, kHeading) < kNotEstimated;
      truth->speed_known &= estimate.belief.covariance(kSpeed, kSpeed) < kNotEstimated;
      scorer.add(estimate, *truth);
      tum.write(solutionOf(estimate, nullptr));
      truth_tum.write(solutionOf({estimate.stamp, {truth->state, StateMatrix::Identity()}}, nullptr));
    }
    for (const auto& motion : estimator.motions)
      if (const auto truth = recording_.motionAt(motion.stamp); truth && motion.stamp >= from)
        motions.add(motion, *truth);
    tum.commit();
    truth_tum.commit();
    json m = describe(scorer.scores(), outages(recording_, estimator), cost);
    addMotions(motions.scores(), m);
    addAudits(estimator, from, m);
    if (const json alignment = begins_off_ ? alignmentOf(estimator) : json(); !alignment.is_null())
      m["alignment"] = alignment;
    return m;
  }

 private:
  json describe(const Scores& s, const std::vector<Outage>& gaps, const json& cost) const {
    json m{{"samples", s.samples},           {"diverged", s.diverged},
           {"drift_percent", 100 * s.drift}, {"nees", json::object()},
           {"nis", json::object()},          {"outliers", json::object()},
           {"outages", json::array()},       {"cost", cost}};
    for (int i = 0; i < kGroups; ++i) {
      const auto group = static_cast<Group>(i);
      const bool angle = group == kHeadingGroup;
      if (s.error[group]) m[angle ? "heading_deg" : groupName(group)] = toJson(*s.error[group], angle ? kRadPerDeg : 1);
      if (s.nees[group]) m["nees"][groupName(group)] = toJson(*s.nees[group]);
    }
    ApertureError a = s.aperture;
    if (a.windows == 0) a.across = a.along = std::nan("");  // too few estimates for one
    m["aperture"] = {{"time", a.time},       {"wavelength", a.wavelength},
                     {"windows", a.windows}, {"across", a.across},
                     {"along", a.along},     {"across_wavelengths", a.across / a.wavelength}};
    for (const auto& gap : gaps)
      m["outages"].push_back({{"begin", gap.begin},
                              {"duration", gap.duration},
                              {"distance", gap.distance},
                              {"error_end", gap.error_end},
                              {"drift_percent", 100 * gap.error_end / gap.distance}});
    return m;
  }

  static void addMotions(const MotionScores& scores, json& m) {
    for (std::size_t i = 0; i < kMotionGroups; ++i) {
      const std::string name = kMotionGroupNames[i];
      const bool angle = i == kTiltGroup;
      if (scores.error[i]) m[angle ? name + "_deg" : name] = toJson(*scores.error[i], angle ? kRadPerDeg : 1);
      if (scores.nees[i]) m["nees"][name] = toJson(*scores.nees[i]);
    }
  }

  /// How far the heading of an estimate is off [deg], where that is known.
  std::optional<double> headingOff(const Estimate& estimate) const {
    const auto truth = recording_.truthAt(estimate.stamp);
    if (!truth || !truth->heading_known || !(estimate.belief.covariance(kHeading, kHeading) < kNotEstimated))
      return std::nullopt;
    return std::abs(Model::difference(estimate.belief.mean, truth->state)(kHeading)) / kRadPerDeg;
  }

  /// Whether any estimator begins with a heading to be found: else nobody asks when it is aligned.
  bool beginsOff() const {
    const auto off = [&](const auto& named) {
      const auto& estimates = named.second.estimates;
      return !estimates.empty() && headingOff(estimates.front()).value_or(0) > kAligned;
    };
    return std::any_of(recording_.estimators.begin(), recording_.estimators.end(), off);
  }

  /// When the heading, skipped or not, came within kAligned for good: 0 where it always was, null where it did not.
  json alignmentOf(const RecordedEstimator& estimator) const {
    double last_off = 0;
    std::optional<double> last;
    for (const auto& estimate : estimator.estimates) {
      const auto off = headingOff(estimate);
      if (!off) continue;
      last = secondsBetween(recording_.begin, estimate.stamp);
      if (*off > kAligned) last_off = *last;
    }
    if (!last) return nullptr;
    return {{"within_deg", kAligned},
            {"after", last_off == 0 || *last - last_off >= kAlignedFor ? json(last_off) : json(nullptr)}};
  }

  /// What became of each sensor's measurements.
  void addAudits(const RecordedEstimator& estimator, Stamp from, json& m) const {
    std::map<std::string, AuditTally> tallies;
    std::map<std::string, double> degrees;
    std::array<std::size_t, 5> verdicts{};
    std::vector<double> effective_sizes;
    for (const auto& audit : estimator.audits) {
      if (audit.stamp < from) continue;
      if (audit.effective_size > 0) effective_sizes.push_back(audit.effective_size);
      ++verdicts[static_cast<std::size_t>(audit.verdict)];
      if (audit.rows == 0) continue;
      const auto label = recording_.outlier.find({audit.stamp, audit.sensor});
      tallies[audit.sensor].add(audit.verdict, audit.least_weight, audit.nis,
                                label == recording_.outlier.end() ? std::nullopt : std::optional<bool>(label->second));
      degrees[audit.sensor] = static_cast<double>(audit.rows);
    }
    const auto& motions = estimator.motions;  // a solution without covariance has no NIS to speak of
    const bool consistent =
        motions.empty() || std::any_of(motions.begin(), motions.end(),
                                       [](const MotionSample& motion) { return motion.P_position_map.has_value(); });
    Detection all;
    for (const auto& [name, tally] : tallies) {
      if (!tally.nis.empty() && consistent) m["nis"][name] = toJson(consistency(tally.nis, degrees[name]));
      if (!recording_.labelled()) continue;
      m["outliers"][name] = toJson(tally.detection);
      all.labelled += tally.detection.labelled;
      all.flagged += tally.detection.flagged;
      all.hits += tally.detection.hits;
    }
    if (recording_.labelled()) m["outliers"]["all"] = toJson(all);
    if (!effective_sizes.empty()) m["effective_particles"] = quantile(effective_sizes, 0.5);
    m["verdicts"] = {{"accepted", verdicts[0]},
                     {"down_weighted", verdicts[1]},
                     {"rejected", verdicts[2]},
                     {"stale", verdicts[3]},
                     {"invalid", verdicts[4]}};
  }

  const Recording& recording_;
  const Options& options_;
  bool begins_off_;
};

/// Named columns that grow by rows and are thinned to what a plot can show.
class Series {
 public:
  Series(std::initializer_list<const char*> names, std::size_t rows)
      : every_(std::max<std::size_t>(1, rows / kMostPoints)) {
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

/// Beside the other states, sample by sample, where there are heights.
void addHeights(const Recording& recording, const RecordedEstimator& estimator, json& all) {
  if (estimator.motions.size() != estimator.estimates.size()) return;
  Series heights({"error_up", "sigma_up"}, estimator.motions.size());
  for (const auto& motion : estimator.motions) {
    const auto truth = recording.motionAt(motion.stamp);
    if (!truth) continue;
    const double variance = motion.P_position_map ? (*motion.P_position_map)(2, 2) : 0;
    heights.add({motion.position_map.z() - truth->position_map.z(), std::sqrt(variance)});
  }
  all.update(heights.columns());
}

json seriesOf(const Recording& recording, const RecordedEstimator& estimator) {
  Series states({"t", "north", "east", "error_north", "sigma_north", "error_east", "sigma_east", "error_heading_deg",
                 "sigma_heading_deg"},
                estimator.estimates.size());
  for (const auto& estimate : estimator.estimates) {
    const auto truth = recording.truthAt(estimate.stamp);
    if (!truth) continue;
    const StateVector error = Model::difference(estimate.belief.mean, truth->state);
    const auto& P = estimate.belief.covariance;
    states.add({secondsBetween(recording.begin, estimate.stamp), estimate.belief.mean(kNorth),
                estimate.belief.mean(kEast), error(kNorth), std::sqrt(P(kNorth, kNorth)), error(kEast),
                std::sqrt(P(kEast, kEast)), truth->heading_known ? error(kHeading) / kRadPerDeg : 0,
                std::sqrt(P(kHeading, kHeading)) / kRadPerDeg});
  }
  json all = states.columns();
  addHeights(recording, estimator, all);
  std::map<std::string, Series> updates;
  for (const auto& audit : estimator.audits) {
    if (audit.rows == 0) continue;
    auto& series =
        updates
            .try_emplace(audit.sensor, std::initializer_list<const char*>{"t", "weight", "nis", "effective_size"},
                         estimator.audits.size() / 3)
            .first->second;
    series.add(
        {secondsBetween(recording.begin, audit.stamp), audit.least_weight, audit.nis.value_or(0), audit.effective_size},
        audit.least_weight < kDownWeighted);
  }
  for (const auto& [sensor, series] : updates) all["updates"][sensor] = series.columns();
  return all;
}

json seriesOf(const Recording& recording) {
  Series truth({"t", "north", "east"}, recording.truth.size());
  for (const auto& t : recording.truth)
    truth.add({secondsBetween(recording.begin, t.stamp), t.reference.state(kNorth), t.reference.state(kEast)});
  json fixes{{"t", json::array()}, {"north", json::array()}, {"east", json::array()}, {"outlier", json::array()}};
  for (const auto& fix : recording.fixes) {
    auto label = recording.outlier.find({fix.stamp, "position"});
    if (label == recording.outlier.end()) label = recording.outlier.find({fix.stamp, "gps"});
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
  const double seconds = all[name].value("seconds", 0.0), measurements = all[name].value("measurements", 0.0),
               duration = all[name].value("duration", 0.0);
  if (!(seconds > 0) || !(measurements > 0)) return nullptr;
  return {{"seconds", seconds},
          {"microseconds_per_update", 1e6 * seconds / measurements},
          {"times_real_time", duration / seconds}};
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
  for (const auto& [name, estimator] : recording.estimators)
    metrics["estimators"][name] = judge.metrics(name, estimator, costOf(options.bag, name));
  writeFile(options.out + "/series.json", seriesOf(recording).dump());
  writeFile(options.out + "/metrics.json", metrics.dump(2) + "\n");
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Scores the estimates in a bag against its truth: metrics.json, series.json and TUM files. evaluate.py adds "
      "table and report.",
      "sas_motion_metrics");
  app.add_option("BAG", options.bag, "bag with truth and estimates")->required();
  app.add_option("-o,--output", options.out, "folder for the results")->required();
  app.add_option("--skip", options.skip, "seconds at the start that are not scored (default 20)")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--range", options.aperture.range, "slant range of the aperture error [m] (default 100)")
      ->check(CLI::PositiveNumber);
  app.add_option("--wavelength", options.aperture.wavelength, "wavelength of the aperture error [m] (default 0.015)")
      ->check(CLI::PositiveNumber);
  app.add_option("--element", options.aperture.element, "array element of the aperture error [m] (default 0.1)")
      ->check(CLI::PositiveNumber);
  return runTool(app, argc, argv, [&] { run(options); });
}

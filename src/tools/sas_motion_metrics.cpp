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
#include "evaluation/outages.hpp"
#include "evaluation/solution_errors.hpp"
#include "sas_motion/math/angles.hpp"
#include "sas_motion/math/statistics.hpp"
#include "tools/main_guard.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::ros_side;
using nlohmann::json;

constexpr std::size_t kMostPoints = 6000;  // of one plotted series
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

/// How far the heading of an estimate is off [deg], where that is known.
std::optional<double> headingOff(const Recording& recording, const Solution& estimate) {
  const auto truth = recording.truth.at(estimate.stamp);
  const auto error = truth ? headingError(estimate, *truth) : std::nullopt;
  return error ? std::optional(std::abs(*error) / kRadPerDeg) : std::nullopt;
}

/// Whether any estimator begins with a wrong heading: only then is it of interest when it is aligned.
bool beginsOff(const Recording& recording) {
  const auto off = [&](const auto& named) {
    const auto& solutions = named.second.solutions;
    return !solutions.empty() && headingOff(recording, solutions.front()).value_or(0) > kAligned;
  };
  return std::any_of(recording.estimators.begin(), recording.estimators.end(), off);
}

/// When the heading, skipped or not, came within kAligned for good: 0 where it always was, null where it did not.
json alignmentOf(const Recording& recording, const RecordedEstimator& estimator) {
  double last_off = 0;
  std::optional<double> last;
  for (const auto& estimate : estimator.solutions) {
    const auto off = headingOff(recording, estimate);
    if (!off) continue;
    last = secondsBetween(recording.begin(), estimate.stamp);
    if (*off > kAligned) last_off = *last;
  }
  if (!last) return nullptr;
  return {{"within_deg", kAligned},
          {"after", last_off == 0 || *last - last_off >= kAlignedFor ? json(last_off) : json(nullptr)}};
}

/// What the estimator adds to the stamps of a sensor's readings, found from its audits.
Stamp offsetOf(const RecordedEstimator& estimator, std::string_view sensor, const std::vector<Stamp>& readings) {
  std::vector<Stamp> audits;
  for (const auto& audit : estimator.audits)
    if (audit.sensor == sensor && audit.verdict != Verdict::Stale && audit.verdict != Verdict::Invalid)
      audits.push_back(audit.stamp);
  std::sort(audits.begin(), audits.end());
  return timeOffset(readings, audits);
}

json outagesOf(const Recording& recording, const RecordedEstimator& estimator) {
  std::vector<Stamp> fixes;
  for (const auto& fix : recording.fixes) fixes.push_back(fix.stamp);
  Stamp offset = 0;
  for (const char* sensor : {"position", "gps"})
    if (offset == 0) offset = offsetOf(estimator, sensor, fixes);
  for (Stamp& fix : fixes) fix += offset;
  json all = json::array();
  for (const auto& gap : outages(fixes, recording.truth, estimator.solutions))
    all.push_back({{"begin", gap.begin},
                   {"duration", gap.duration},
                   {"distance", gap.distance},
                   {"error_end", gap.error_end},
                   {"drift_percent", 100 * gap.error_end / gap.distance}});
  return all;
}

json apertureOf(ApertureError a) {
  if (a.windows == 0) a.across = a.along = std::nan("");  // too few estimates for one
  return {{"time", a.time},     {"wavelength", a.wavelength}, {"windows", a.windows},
          {"across", a.across}, {"along", a.along},           {"across_wavelengths", a.across / a.wavelength}};
}

/// Scores the solutions, and writes the scored trajectory beside truth into TUM files.
void scoreSolutions(const Recording& recording, const Options& options, const std::string& name,
                    EstimatorScorer& scorer) {
  TumFile tum(options.out + "/" + name + ".tum"), truth_tum(options.out + "/" + name + ".truth.tum");
  const Stamp from = recording.begin() + stampFromSeconds(options.skip);
  std::optional<Vector<3>> last;
  for (const auto& estimate : recording.estimators.at(name).solutions) {
    const auto truth = recording.truth.at(estimate.stamp);
    if (estimate.stamp < from || !truth) continue;
    score(estimate, *truth, scorer);
    if (last) scorer.addDistance((truth->solution.position_map - *last).head<2>().norm());
    last = truth->solution.position_map;
    tum.write(estimate);
    truth_tum.write(truth->solution);
  }
  tum.commit();
  truth_tum.commit();
}

/// Scores what became of each sensor's measurements.
void scoreAudits(const Recording& recording, const Options& options, const RecordedEstimator& estimator,
                 EstimatorScorer& scorer) {
  std::map<std::string, Stamp, std::less<>> offsets;
  for (const auto& [sensor, labels] : recording.outliers) {
    std::vector<Stamp> readings;
    for (const auto& [stamp, outlier] : labels) readings.push_back(stamp);
    offsets[sensor] = offsetOf(estimator, sensor, readings);
  }
  const Stamp from = recording.begin() + stampFromSeconds(options.skip);
  for (const auto& audit : estimator.audits) {
    if (audit.stamp < from) continue;
    const auto offset = offsets.find(audit.sensor);
    scorer.addAudit(secondsBetween(recording.begin(), audit.stamp), audit,
                    recording.outlier(audit.sensor, audit.stamp - (offset == offsets.end() ? 0 : offset->second)));
    if (audit.effective_size > 0) scorer.trace().effective_size.push_back(audit.effective_size);
  }
}

/// One estimator's metrics.
json metricsOf(const Recording& recording, const Options& options, const std::string& name, const json& cost) {
  const RecordedEstimator& estimator = recording.estimators.at(name);
  ScorerOptions scoring;
  scoring.aperture = options.aperture;
  EstimatorScorer scorer(name, scoring);
  scoreSolutions(recording, options, name, scorer);
  scoreAudits(recording, options, estimator, scorer);
  const EstimatorReport report = scorer.report();
  const auto& verdicts = scorer.verdicts();
  json m{{"samples", report.samples},
         {"diverged", report.diverged},
         {"drift_percent", 100 * scorer.drift()},
         {"nees", json::object()},
         {"nis", json::object()},
         {"outliers", json::object()},
         {"outages", outagesOf(recording, estimator)},
         {"aperture", apertureOf(scorer.aperture())},
         {"cost", cost},
         {"verdicts",
          {{"accepted", verdicts[0]},
           {"down_weighted", verdicts[1]},
           {"rejected", verdicts[2]},
           {"stale", verdicts[3]},
           {"invalid", verdicts[4]}}}};
  for (const auto& [group, error] : report.errors) {
    const bool angle = group == "heading" || group == "tilt";
    m[angle ? group + "_deg" : group] = toJson(error, angle ? kRadPerDeg : 1);
  }
  for (const auto& [group, nees] : scorer.nees()) m["nees"][group] = toJson(nees);
  if (!report.nees.empty())  // without a covariance of its own, an estimate has no NIS either
    for (const auto& [sensor, nis] : scorer.nis()) m["nis"][sensor] = toJson(nis);
  if (!recording.outliers.empty()) {
    for (const auto& [sensor, detection] : scorer.detections()) m["outliers"][sensor] = toJson(detection);
    m["outliers"]["all"] = toJson(scorer.detection());
  }
  if (report.effective_size) m["effective_particles"] = *report.effective_size;
  if (beginsOff(recording))
    if (const json alignment = alignmentOf(recording, estimator); !alignment.is_null()) m["alignment"] = alignment;
  return m;
}

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

json seriesOf(const Recording& recording, const RecordedEstimator& estimator) {
  Series states({"t", "north", "east", "error_north", "sigma_north", "error_east", "sigma_east", "error_heading_deg",
                 "sigma_heading_deg"},
                estimator.solutions.size());
  Series heights({"error_up", "sigma_up"}, estimator.solutions.size());
  for (const auto& estimate : estimator.solutions) {
    const auto truth = recording.truth.at(estimate.stamp);
    if (!truth) continue;
    const Vector<3>& position = estimate.position_map;
    const Vector<3> error = position - truth->solution.position_map;
    const Vector<6> sigma = estimate.pose_covariance.diagonal().cwiseSqrt();
    states.add({secondsBetween(recording.begin(), estimate.stamp), position.y(), position.x(), error.y(), sigma(1),
                error.x(), sigma(0), headingError(estimate, *truth).value_or(0) / kRadPerDeg, sigma(5) / kRadPerDeg});
    if (truth->solution.has_height()) heights.add({error.z(), sigma(2)});
  }
  json all = states.columns();
  const auto& solutions = estimator.solutions;
  if (std::all_of(solutions.begin(), solutions.end(), [](const Solution& s) { return s.has_height(); }))
    all.update(heights.columns());
  std::map<std::string_view, Series> updates;
  for (const auto& audit : estimator.audits) {
    if (audit.rows == 0) continue;
    const double least_weight = audit.weights.head(audit.rows).minCoeff();
    auto& series =
        updates
            .try_emplace(audit.sensor, std::initializer_list<const char*>{"t", "weight", "nis", "effective_size"},
                         estimator.audits.size() / 3)
            .first->second;
    series.add({secondsBetween(recording.begin(), audit.stamp), least_weight, audit.nis, audit.effective_size},
               least_weight < kDownWeighted);
  }
  for (const auto& [sensor, series] : updates) all["updates"][std::string(sensor)] = series.columns();
  return all;
}

json seriesOf(const Recording& recording) {
  Series truth({"t", "north", "east"}, recording.truth.points().size());
  for (const auto& point : recording.truth.points())
    truth.add({secondsBetween(recording.begin(), point.stamp), point.position_map.y(), point.position_map.x()});
  json fixes{{"t", json::array()}, {"north", json::array()}, {"east", json::array()}, {"outlier", json::array()}};
  for (const auto& fix : recording.fixes) {
    auto label = recording.outlier("position", fix.stamp);
    if (!label) label = recording.outlier("gps", fix.stamp);
    fixes["t"].push_back(rounded(secondsBetween(recording.begin(), fix.stamp)));
    fixes["north"].push_back(rounded(fix.position_map.y()));
    fixes["east"].push_back(rounded(fix.position_map.x()));
    fixes["outlier"].push_back(label ? json(*label ? 1 : 0) : json(nullptr));
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
  double distance = 0;
  const auto& truth = recording.truth.points();
  for (std::size_t i = 1; i < truth.size(); ++i)
    distance += (truth[i].position_map - truth[i - 1].position_map).head<2>().norm();
  json metrics{{"schema", "sas_motion/metrics/1"},
               {"bag", std::filesystem::path(options.bag).filename().string()},
               {"truth", recording.truth_topic},
               {"duration", secondsBetween(recording.begin(), recording.end())},
               {"distance", distance},
               {"skipped", options.skip}};
  for (const auto& [name, estimator] : recording.estimators)
    metrics["estimators"][name] = metricsOf(recording, options, name, costOf(options.bag, name));
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

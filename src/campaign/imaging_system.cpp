// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "imaging_survey.hpp"
#include "ins_campaign.hpp"
#include "sas_motion/config/focus_config.hpp"
#include "sas_motion/imaging/focus_bench.hpp"
#include "sas_motion/io/cpu_time.hpp"
#include "systems.hpp"

namespace sas_motion {
namespace {

using namespace ins;
using imaging::FocusBench;
using imaging::FocusedImage;
using imaging::PingPose;

const std::string kErrorFree = "error_free";  // truth at the stamps of the inertial unit: what lies between these costs

/// What one estimator says near every aperture.
struct Estimate {
  std::vector<ApertureTrack> tracks;
  std::string failure;
  double seconds = 0;  // of CPU
};

/// Errors of a cut beside the same cut of the error-free image.
void addCut(Named<double>& measures, const std::string& prefix, const std::string& name, const imaging::CutMeasures& cut, const imaging::CutMeasures& reference) {
  measures.emplace_back(prefix + "pslr_" + name, cut.pslr - reference.pslr);
  measures.emplace_back(prefix + "islr_" + name, cut.islr - reference.islr);
  measures.emplace_back(prefix + "irw_" + name, cut.irw / reference.irw);
}

/// Of the first target.
void addImage(Named<double>& measures, const std::string& prefix, const FocusedImage& image, const FocusedImage& error_free) {
  const auto &target = image.targets.front(), &reference = error_free.targets.front();
  if (!target.complete) return;
  addCut(measures, prefix, "along", target.along, reference.along);
  addCut(measures, prefix, "range", target.range, reference.range);
  measures.emplace_back(prefix + "peak_loss", target.peak_loss);
  measures.emplace_back(prefix + "peak_error", target.peak_error);
}

Named<double> measuresOf(FocusBench& bench, const std::vector<PingPose>& poses) {
  const auto error = bench.error(poses);
  Named<double> measures{{"path", error.path.rms}, {"line_of_sight", error.line_of_sight.rms}, {"along", error.along.rms}, {"speed", error.along.slope}};
  const FocusedImage focused = bench.focus(poses);
  addImage(measures, "", focused, bench.errorFree());
  addImage(measures, "autofocus_", bench.autofocus(focused, poses), bench.errorFree());
  addImage(measures, "compensated_", bench.compensate(poses), bench.errorFree());
  return measures;
}

/// Of the middle of the aperture.
double horizontalError(const std::vector<PingPose>& estimate, const std::vector<PingPose>& truth) {
  Eigen::Vector2d error = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < truth.size(); ++i) error += (estimate[i].position - truth[i].position).head<2>() / static_cast<double>(truth.size());
  return error.norm();
}

/// Surveys whose judge is the image: what a synthetic aperture sonar sees on their lines with each estimate of its track.
class ImagingSystem final : public System {
 public:
  ImagingSystem(YamlSection& campaign, const std::string& folder, const EstimatorFactory& make)
      : scenarios_(readInsCampaign(campaign, folder, *this)), make_(make), trajectory_(scenarios_.front().track, duration) {
    std::string file;
    campaign.text("config", file);
    if (file.empty()) campaign.fail("config", "is missing; name a file of settings for focus");
    settings_ = imaging::readFocus((std::filesystem::path(folder) / file).string());
    int windows = 4;
    campaign.integer("windows", windows, 1, 1000);
    apertures_ = chooseApertures(scenarios_.front(), trajectory_, settings_, skip, windows);
    if (apertures_.empty()) campaign.fail("duration", fmt::format("is {} s but no aperture on a straight line is in it behind skip", duration));
    for (const auto& name : estimators)
      if (name != kErrorFree && !make(name, configOf(scenarios_.front())))
        campaign.fail("estimators", fmt::format("names '{}', which is no estimator of this system", name));
  }

  std::vector<EstimatorReport> run(std::size_t law, std::uint64_t seed) const override {
    const Recording recording = simulate(scenarios_[law], trajectory_, seed);
    std::vector<Estimate> estimates;
    for (const auto& name : estimators) estimates.push_back(name == kErrorFree ? errorFree(recording) : estimate(name, scenarios_[law], recording));
    std::vector<std::vector<double>> positions(estimators.size());
    std::vector<EstimatorReport> reports(estimators.size());
    for (std::size_t window = 0; window < apertures_.size(); ++window) {
      FocusBench bench(settings_, apertures_[window].times, apertures_[window].truth, 1);
      for (std::size_t i = 0; i < estimators.size(); ++i) {
        reports[i].windows.push_back({{"start", apertures_[window].start}});
        const auto poses = estimates[i].tracks[window].poses(settings_.sonar.altitude);
        if (!poses) continue;
        positions[i].push_back(horizontalError(*poses, apertures_[window].truth));
        for (const auto& measure : measuresOf(bench, *poses)) reports[i].windows.back().push_back(measure);
      }
    }
    for (std::size_t i = 0; i < estimators.size(); ++i) complete(reports[i], estimators[i], estimates[i], positions[i], recording.aiding.size());
    return reports;
  }

  Named<Trace> trace(std::size_t, std::uint64_t) const override { return {}; }
  Named<double> bound(std::size_t, const std::vector<std::uint64_t>&) const override { return {}; }

 private:
  static Config configOf(const Scenario& scenario) {
    Config config;
    config.parameters = scenario.parameters;
    config.imu.period = 1 / scenario.imu_rate;
    return config;
  }

  std::vector<ApertureTrack> emptyTracks() const {
    std::vector<ApertureTrack> tracks;
    for (const auto& aperture : apertures_) tracks.emplace_back(aperture, settings_.aperture.longest_gap);
    return tracks;
  }

  Estimate errorFree(const Recording& recording) const {
    Estimate result{emptyTracks(), "", 0};
    for (const auto& reading : recording.imu)
      for (auto& track : result.tracks) track.add(reading.stamp, trajectory_.at(secondsBetween(0, reading.stamp)).state);
    return result;
  }

  Estimate estimate(const std::string& name, const Scenario& scenario, const Recording& recording) const {
    Estimate result{emptyTracks(), "", 0};
    Output output;
    const auto gather = [&] {
      for (const auto& solution : output.solutions)
        for (auto& track : result.tracks) track.add(solution.stamp, solution.state);
      output.clear();
    };
    const auto estimator = make_(name, configOf(scenario));
    const double begin = cpuSeconds();
    estimator->start(recording.start, 0);
    auto next = recording.aiding.begin();
    for (const auto& reading : recording.imu) {
      for (; next != recording.aiding.end() && next->reading.stamp <= reading.stamp; ++next) estimator->process(next->reading, output);
      estimator->process(reading, output);
      gather();
    }
    estimator->finish(output);
    result.seconds = cpuSeconds() - begin;
    gather();
    result.failure = estimator->failure();
    return result;
  }

  void complete(EstimatorReport& report, const std::string& name, const Estimate& estimate, const std::vector<double>& positions, std::size_t readings) const {
    report.estimator = name;
    report.samples = positions.size();
    report.diverged = positions.empty() || !estimate.failure.empty() || !std::all_of(positions.begin(), positions.end(), [](double x) { return std::isfinite(x); });
    if (!positions.empty()) report.errors.emplace_back("position", towfish::summarize(positions));
    report.microseconds = 1e6 * estimate.seconds / static_cast<double>(std::max<std::size_t>(1, readings));
  }

  std::vector<Scenario> scenarios_;  // by law
  EstimatorFactory make_;
  Trajectory trajectory_;
  imaging::FocusSettings settings_;
  std::vector<Aperture> apertures_;
};

}  // namespace

std::unique_ptr<System> makeImagingSystem(YamlSection& campaign, const std::string& folder, const EstimatorFactory& make) {
  return std::make_unique<ImagingSystem>(campaign, folder, make);
}

}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "campaign/imaging_measures.hpp"
#include "sas_motion/imaging/focus_scene.hpp"
#include "sas_motion/systems/ins_gps_dvl/solutions.hpp"
#include "systems/ins_gps_dvl/campaign.hpp"
#include "systems/ins_gps_dvl/imaging_survey.hpp"
#include "systems/ins_gps_dvl/run_scorer.hpp"

namespace sas_motion::ins {
namespace {

using imaging::FocusBench;
using imaging::FocusResult;

const std::string kErrorFree = "error_free";  // truth at the stamps of the IMU: shows the error of interpolation

/// The solutions of one estimator near every aperture.
struct Estimate {
  std::vector<ApertureTrack> tracks;
  std::string failure;
  double seconds = 0;  // of CPU
};

/// Surveys that are scored by images: those that a synthetic aperture sonar makes on their lines with each estimate of
/// its track.
class ImagingCampaign final : public Campaign {
 public:
  ImagingCampaign(YamlSection& yaml, const std::string& folder, EstimatorFactory make) : make_(std::move(make)) {
    const auto scenario = readScenario<Scenario>(yaml, folder);
    const auto known = [&](const std::string& name) {
      return name == kErrorFree || make_(name, configOf(scenario)) != nullptr;
    };
    readScoring(yaml, 120, known, currentName);
    scenarios_ = readLaws(yaml, scenario, &readLaw);
    trajectory_.emplace(scenario.track, duration);
    settings_ = imaging::readFocus(fileOf(yaml, "config", folder));
    int windows = 4;
    yaml.integer("windows", windows, 1, 1000);
    apertures_ = chooseApertures(scenarios_.front(), *trajectory_, settings_, skip, windows);
    if (apertures_.empty())
      yaml.fail("duration", fmt::format("is {} s but no aperture on a straight line is in it behind skip", duration));
  }

  std::vector<EstimatorReport> run(std::size_t law, std::uint64_t seed) const override {
    const Recording recording = simulate(scenarios_[law], *trajectory_, seed);
    const auto estimates = estimatesOf(scenarios_[law], recording);
    std::vector<EstimatorScorer> scorers;
    for (const auto& name : estimators) scorers.emplace_back(name);
    for (std::size_t window = 0; window < apertures_.size(); ++window) {
      FocusBench bench(settings_, apertures_[window].times, apertures_[window].truth, 1);
      for (std::size_t i = 0; i < estimators.size(); ++i) {
        auto& measures = scorers[i].facts().windows.emplace_back();
        measures.emplace_back("start", apertures_[window].start);
        const auto poses = estimates[i].tracks[window].poses(settings_.sonar.altitude);
        if (!poses) continue;
        const double error = imaging::horizontalError(*poses, apertures_[window].truth);
        scorers[i].addSample(std::isfinite(error));
        scorers[i].addError("position", error);
        for (const auto& measure : imaging::imageMeasures(bench, *poses, settings_.sonar.wavelength()))
          measures.push_back(measure);
      }
    }
    std::vector<EstimatorReport> reports;
    for (std::size_t i = 0; i < estimators.size(); ++i) {
      EstimatorReport& facts = scorers[i].facts();
      facts.diverged |= facts.samples == 0 || !estimates[i].failure.empty();
      scorers[i].setCost(estimates[i].seconds, recording.aiding.size());
      reports.push_back(scorers[i].report());
    }
    return reports;
  }

  std::optional<FocusResult> images(std::size_t law, std::uint64_t seed, const std::string& folder) const override {
    const Aperture& aperture = apertures_.front();
    FocusResult result{
        title + ", " + laws[law].name, settings_, imaging::targetPlaces(settings_), windowOf(aperture), {}};
    FocusBench bench(settings_, aperture.times, aperture.truth, 1);
    result.trajectories.push_back(focusAlong(bench, aperture.truth, folder, "truth", false));
    const auto estimates = estimatesOf(scenarios_[law], simulate(scenarios_[law], *trajectory_, seed));
    for (std::size_t i = 0; i < estimators.size(); ++i) {
      const auto poses = estimates[i].tracks.front().poses(settings_.sonar.altitude);
      if (estimators[i] != kErrorFree && poses)
        result.trajectories.push_back(focusAlong(bench, *poses, folder, estimators[i], false));
    }
    return result;
  }

 private:
  static imaging::FocusWindow windowOf(const Aperture& aperture) {
    const double duration = aperture.times.back(),
                 length = (aperture.truth.back().position - aperture.truth.front().position).head<2>().norm();
    return {aperture.start,        duration,
            length / duration,     static_cast<double>(aperture.times.size() - 1) / duration,
            aperture.times.size(), aperture.frame};
  }

  std::vector<Estimate> estimatesOf(const Scenario& scenario, const Recording& recording) const {
    std::vector<Estimate> estimates;
    for (const auto& name : estimators)
      estimates.push_back(name == kErrorFree ? errorFree(recording) : estimate(name, scenario, recording));
    return estimates;
  }

  std::vector<ApertureTrack> emptyTracks() const {
    std::vector<ApertureTrack> tracks;
    for (const auto& aperture : apertures_) tracks.emplace_back(aperture, settings_.aperture.longest_gap);
    return tracks;
  }

  Estimate errorFree(const Recording& recording) const {
    Estimate result{emptyTracks(), "", 0};
    for (const auto& reading : recording.imu) {
      const NavigationState truth = trajectory_->at(secondsBetween(0, reading.stamp)).state;
      for (auto& track : result.tracks) track.add(reading.stamp, truth);
    }
    return result;
  }

  Estimate estimate(const std::string& name, const Scenario& scenario, const Recording& recording) const {
    Estimate result{emptyTracks(), "", 0};
    const auto estimator = make_(name, configOf(scenario));
    result.seconds = replay(*estimator, recording, [&](const Output& output) {
      for (const auto& solution : output.solutions)
        for (auto& track : result.tracks) track.add(solution.stamp, solution.state);
    });
    result.failure = estimator->failure();
    return result;
  }

  std::vector<Scenario> scenarios_;  // by law
  EstimatorFactory make_;
  std::optional<Trajectory> trajectory_;
  imaging::FocusSettings settings_;
  std::vector<Aperture> apertures_;
};

}  // namespace

std::unique_ptr<Campaign> readImagingCampaign(YamlSection& yaml, const std::string& folder,
                                              const EstimatorFactory& make) {
  return std::make_unique<ImagingCampaign>(yaml, folder, make);
}

}  // namespace sas_motion::ins

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Navigation, echoes and image in a loop: the echoes of a speckled bottom on the true track of a survey,
// micronavigation along the believed one, its readings fused by the same estimators, and the images of a point target
// with and without them. usage: closed_loop CONFIG_FOLDER [SEEDS [WINDOW [SURVEY]]]; micronavigation takes a window [s]
// of a survey [s].
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "campaign/imaging_measures.hpp"
#include "sas_motion/imaging/echo_simulation.hpp"
#include "sas_motion/imaging/focus_config.hpp"
#include "sas_motion/imaging/micronavigation.hpp"
#include "sas_motion/imaging/range_compression.hpp"
#include "sas_motion/math/statistics.hpp"
#include "sas_motion/parallel/threads.hpp"
#include "systems/ins_gps_dvl/campaign.hpp"
#include "systems/ins_gps_dvl/graph/smoother.hpp"
#include "systems/ins_gps_dvl/imaging_survey.hpp"
#include "systems/ins_gps_dvl/run_scorer.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::ins;
using imaging::FocusSettings;

constexpr int kThreads = 2, kImages = 3;
constexpr double kSkip = 120;   // until the filters have settled [s]
constexpr double kNoise = 0.7;  // of a raw sample
constexpr double kBeyondBeam =
    9;  // of bottom that a ping is given fore and aft, where the beam's first null is 6 m off at the far range [m]
const std::string kBelief = "smooth_robust_ckf27";
const std::array<std::string, 3> kEstimators{"robust_ckf27", kBelief, "batch"};
using Measures = std::map<std::string, std::vector<double>>;

/// Eight receivers 0.1 m apart, as micronavigation_accuracy has it, at the inertial unit: simulated receivers do not
/// turn while the echo is under way.
FocusSettings micronavigationSettings(double window) {
  FocusSettings settings;
  settings.sonar.near_range = 22;
  settings.sonar.far_range = 38;
  settings.sonar.pulse_length = 2e-3;
  settings.aperture.duration = window;
  settings.aperture.speed_locked = false;
  return settings;
}

/// What is the same for all seeds.
struct Survey {
  Scenario scenario;
  FocusSettings echoes, images;
  ins::Trajectory trajectory;
  Aperture window;
  std::vector<Aperture> apertures;  // of images, in the window
};

Survey makeSurvey(const std::string& config, double window, double duration) {
  Scenario scenario = Scenario::fromFile(config + "/scenarios/ins/survey.yaml");
  scenario.duration = duration;
  const FocusSettings echoes = micronavigationSettings(window),
                      images = imaging::readFocus(config + "/focus_survey.yaml");
  scenario.parameters.dpc_lever_body = phaseCentre(echoes.sonar);
  const ins::Trajectory trajectory(scenario.track, duration);
  const auto windows = chooseApertures(scenario, trajectory, echoes, kSkip, 1);
  if (windows.empty())
    throw std::invalid_argument(
        fmt::format("closed_loop: no line has {} s behind the first {} s of {} s", window, kSkip, duration));
  Scenario until_end = scenario;
  until_end.duration = windows.front().start + window;
  return {scenario,   echoes,          images,
          trajectory, windows.front(), chooseApertures(until_end, trajectory, images, windows.front().start, kImages)};
}

/// What an estimator says in the window and in the apertures of images.
struct Followed {
  ApertureTrack window;
  std::vector<ApertureTrack> apertures;
  std::vector<double> velocity_errors;  // in the window [m/s]
};

Followed follow(const Survey& survey, const std::string& name, const Recording& recording) {
  Followed result{ApertureTrack(survey.window, survey.images.aperture.longest_gap), {}, {}};
  for (const auto& aperture : survey.apertures)
    result.apertures.emplace_back(aperture, survey.images.aperture.longest_gap);
  const auto estimator = makeAnyEstimator(name, configOf(survey.scenario));
  replay(*estimator, recording, [&](const ins::Output& output) {
    for (const auto& solution : output.solutions) {
      const Stamp stamp = solution.stamp;
      result.window.add(stamp, solution.state);
      for (auto& track : result.apertures) track.add(stamp, solution.state);
      if (stamp >= survey.window.pings.front() && stamp <= survey.window.pings.back())
        result.velocity_errors.push_back(
            (solution.state.velocity_nav - survey.trajectory.at(secondsBetween(0, stamp)).state.velocity_nav).norm());
    }
  });
  if (!estimator->failure().empty()) fmt::print("  {}: {}\n", name, estimator->failure());
  return result;
}

/// Of the bottom's scatterers, those near a ping.
imaging::Scene near(const imaging::Scene& bottom, const imaging::PingPose& pose) {
  imaging::Scene scene;
  std::copy_if(
      bottom.scatterers.begin(), bottom.scatterers.end(), std::back_inserter(scene.scatterers),
      [&](const auto& scatterer) { return std::abs(scatterer.position.x() - pose.position.x()) < kBeyondBeam; });
  return scene;
}

/// The compressed lines of all pings of the window over one bottom.
imaging::EchoLines echoesOf(const Survey& survey, std::uint64_t seed) {
  const imaging::SonarDescription& sonar = survey.echoes.sonar;
  const std::vector<imaging::PingPose>& truth = survey.window.truth;
  imaging::SpeckleOptions options;
  options.density = 200;
  options.lower = {truth.front().position.x() - kBeyondBeam, -38, 0};  // to starboard
  options.upper = {truth.back().position.x() + kBeyondBeam, -18, 0};
  const imaging::Scene bottom = imaging::speckleScene(options, {}, seed);
  imaging::EchoOptions echoes;
  echoes.noise = kNoise;
  echoes.threads = kThreads;
  imaging::CompressionOptions compression;
  compression.threads = kThreads;
  imaging::EchoLines all;  // of the first ping, and the others' behind
  for (std::size_t i = 0; i < truth.size(); ++i) {
    echoes.seed = 1000000 * seed + i;
    const auto paths = echoPaths(sonar, {truth[i]});
    auto lines = compressRange(simulateEchoes(sonar, paths, near(bottom, truth[i]), echoes), sonar, compression);
    if (i == 0) {
      all = lines;
      continue;
    }
    all.paths.insert(all.paths.end(), lines.paths.begin(), lines.paths.end());
    all.data.insert(all.data.end(), lines.data.begin(), lines.data.end());
  }
  return all;
}

/// Errors of one row of the readings over their standard deviations.
struct RowErrors {
  std::vector<double> errors, normalised;
  void print(const char* name) const {
    fmt::print("  {:<6} error {:6.3f} mm/s RMS, NEES {:.2f}\n", name, 1e3 * rootMeanSquare(errors),
               std::pow(rootMeanSquare(normalised), 2));
  }
};

/// Micronavigation from each ping to the next along the believed track, moved up or down to where the first of the two
/// is: an altimeter tells how high.
std::vector<imaging::Micronavigation> micronavigationOf(const Survey& survey,
                                                        const std::vector<imaging::PingPose>& believed,
                                                        std::uint64_t seed) {
  const imaging::EchoLines lines = echoesOf(survey, seed);
  imaging::MicronavigationOptions options;
  options.starboard = true;
  std::vector<imaging::Micronavigation> found(believed.size() - 1);
  forEachTask(found.size(), kThreads, [&](std::size_t i) {
    imaging::PingPose first = believed[i], second = believed[i + 1];
    const double rise = survey.window.truth[i].position.z() - first.position.z();
    first.position.z() += rise;
    second.position.z() += rise;
    found[i] = micronavigate(lines, i, survey.echoes.sonar, first, second, options);
  });
  return found;
}

/// What the echoes say along the believed track, beside the truth.
std::vector<LabelledAiding> readingsOf(const Survey& survey, const ApertureTrack& believed, std::uint64_t seed) {
  const auto poses = believed.poses(survey.echoes.sonar.altitude);
  if (!poses) return {};
  const auto found = micronavigationOf(survey, *poses, seed);
  const imaging::Trajectory trajectory = believed.trajectory();
  std::vector<LabelledAiding> readings;
  std::array<RowErrors, 2> rows;
  double coherence = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i].verdict != imaging::MicronavigationVerdict::Valid) continue;
    LabelledAiding labelled;
    labelled.reading =
        dpcReading(found[i], survey.echoes.sonar, trajectory, survey.window.pings[i], survey.window.pings[i + 1]);
    const TruthSample truth = survey.trajectory.at(secondsBetween(0, labelled.reading.stamp));
    const Vector<2> error = ErrorModel(survey.scenario.parameters, truth.state)
                                .dpc(truth.state, truth.rateBody(), labelled.reading.array, Errors::Zero())
                                .innovation;
    for (int row = 0; row < 2; ++row) {
      rows[static_cast<std::size_t>(row)].errors.push_back(error(row));
      rows[static_cast<std::size_t>(row)].normalised.push_back(error(row) /
                                                               std::sqrt(labelled.reading.array.variance(row)));
    }
    coherence += found[i].coherence;
    readings.push_back(labelled);
  }
  fmt::print("seed {}: {} of {} pairs valid, coherence {:.3f}\n", seed, readings.size(), found.size(),
             coherence / static_cast<double>(readings.size()));
  rows[0].print("along");
  rows[1].print("sight");
  return readings;
}

Recording withReadings(Recording recording, const std::vector<LabelledAiding>& readings) {
  auto& all = recording.aiding;
  all.insert(all.end(), readings.begin(), readings.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const LabelledAiding& a, const LabelledAiding& b) { return a.reading.stamp < b.reading.stamp; });
  return recording;
}

void addImages(const Survey& survey, std::size_t aperture, imaging::FocusBench& bench, const Followed& followed,
               Measures& measures) {
  const auto poses = followed.apertures[aperture].poses(survey.images.sonar.altitude);
  if (!poses) return;
  for (const auto& [name, value] : imaging::imageMeasures(bench, *poses, survey.images.sonar.wavelength()))
    measures[name].push_back(value);
}

void printTable(const std::map<std::string, Measures>& measures) {
  constexpr std::array columns{"path_wavelengths",     "pslr_along",           "islr_along",         "peak_loss",
                               "autofocus_pslr_along", "autofocus_islr_along", "autofocus_peak_loss"};
  fmt::print(
      "\nvelocity RMS [mm/s]; medians of: path error RMS [wavelengths]; PSLR, ISLR along track less the error-free "
      "ones, peak loss [dB]; with autofocus\n");
  fmt::print("{:<44} velocity    path    PSLR    ISLR    loss    PSLR    ISLR    loss  images\n", "");
  for (const auto& [name, values] : measures) {
    fmt::print("{:<44} {:8.2f}", name, 1e3 * rootMeanSquare(values.at("velocity")));
    for (const char* column : columns)
      if (const auto found = values.find(column); found != values.end())
        fmt::print(" {:7.3f}", quantile(found->second, 0.5));
      else
        fmt::print(" {:>7}", "-");
    fmt::print(" {:7}\n", values.count("peak_loss") ? values.at("peak_loss").size() : 0);
  }
}

void run(const Survey& survey, std::uint64_t seed, std::map<std::string, Measures>& measures) {
  const Recording recording = simulate(survey.scenario, survey.trajectory, seed);
  std::map<std::string, Followed> all;
  for (const auto& name : kEstimators) all.emplace(name, follow(survey, name, recording));
  const Recording with = withReadings(recording, readingsOf(survey, all.at(kBelief).window, seed));
  for (const auto& name : kEstimators) all.emplace(name + " with micronavigation", follow(survey, name, with));
  for (const auto& [name, followed] : all) {
    auto& velocity = measures[name]["velocity"];
    velocity.insert(velocity.end(), followed.velocity_errors.begin(), followed.velocity_errors.end());
  }
  for (std::size_t i = 0; i < survey.apertures.size(); ++i) {
    imaging::FocusBench bench(survey.images, survey.apertures[i].times, survey.apertures[i].truth, kThreads);
    for (const auto& [name, followed] : all) addImages(survey, i, bench, followed, measures[name]);
  }
  std::fflush(stdout);
}

double argument(int argc, char** argv, int i, double standard) { return argc > i ? std::atof(argv[i]) : standard; }

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: closed_loop CONFIG_FOLDER [SEEDS [WINDOW [SURVEY]]]\n");
    return 2;
  }
  const Survey survey = makeSurvey(argv[1], argument(argc, argv, 3, 20), argument(argc, argv, 4, 600));
  std::map<std::string, Measures> measures;
  for (int seed = 1; seed <= static_cast<int>(argument(argc, argv, 2, 3)); ++seed)
    run(survey, static_cast<std::uint64_t>(seed), measures);
  printTable(measures);
}

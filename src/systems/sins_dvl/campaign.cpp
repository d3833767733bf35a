// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/sins_dvl/campaign.hpp"

#include <cmath>

#include "systems/ins_gps_dvl/run_scorer.hpp"

namespace sas_motion::sins {
namespace {

// An estimate has converged where the heading is within three standard deviations of large_angle's bound, and the
// velocity did not run away.
constexpr double kAlignedHeading = 2 * kRadPerDeg, kAlignedVelocity = 0.3;  // [rad, m/s]
constexpr double kAlignedFor = 30;                                          // to the end of the run [s]
const ApertureOptions kAperture{66, 0.015, 0.1};                            // 3.3 s at 3 m/s

/// `noise` is of the DVL; `heading_deg` is the initial misalignment of the heading.
LawInfo readLaw(YamlSection& yaml, const std::string& name, Scenario& scenario) {
  if (yaml.has("noise")) scenario.dvl.noise = ins::Scenario::readNoise(yaml, "noise");
  yaml.angle("heading_deg", scenario.parameters.start_heading, {kTiny, 90});
  return lawInfo(name, scenario.dvl.noise, {});
}

class SinsCampaign final : public Campaign {
 public:
  SinsCampaign(YamlSection& yaml, const std::string& folder, EstimatorFactory make) : make_(std::move(make)) {
    const auto scenario = readScenario<Scenario>(yaml, folder);
    yaml.integer("particles", particles_.particles, 1, 1'000'000);
    particles = particles_.particles;
    yaml.integer("threads", particles_.threads, 1, 1024);
    yaml.boolean("accelerometer_bias", accelerometer_bias_);
    dimension = accelerometer_bias_ ? kStates : kPaperStates;
    readScoring(
        yaml, 60, [&](const std::string& name) { return make_(name, {}) != nullptr; }, currentName);
    scenarios_ = readLaws(yaml, scenario, &readLaw);
  }

  Named<double> bound(std::size_t law, const std::vector<std::uint64_t>& seeds) const override {
    return sinsBound(scenarios_[law], skip, seeds);
  }

 private:
  Config configOf(const Scenario& scenario, std::uint64_t seed) const {
    Config config;
    config.parameters = scenario.parameters;
    config.imu.period = 1 / scenario.imu_rate;
    config.particles = particles_;
    config.accelerometer_bias = accelerometer_bias_;
    config.particles.seed = seed;
    return config;
  }

  std::vector<EstimatorScorer> score(std::size_t law, std::uint64_t seed) const override {
    const Scenario& scenario = scenarios_[law];
    const ins::Scenario motion = withoutGps(scenario);
    const ins::Trajectory trajectory(scenario.track, scenario.duration);
    const ins::Recording recording = sins::simulate(scenario, trajectory, seed);
    std::vector<EstimatorScorer> scorers;
    for (const auto& name : estimators) {
      double end_error = 0;
      ConvergenceWatch aligned(kAlignedFor);
      const auto watch = [&](const ins::TruthSample& truth, const ins::NavigationSolution& solution) {
        end_error = displacement(truth.state, solution.state).head<2>().norm();
        const double heading = attitudeError(solution.state.q_nav_body, truth.state.q_nav_body).z();
        const double velocity = (solution.state.velocity_nav - truth.state.velocity_nav).head<2>().norm();
        aligned.add(secondsBetween(0, solution.stamp),
                    std::abs(heading) <= kAlignedHeading && velocity <= kAlignedVelocity);
      };
      ins::RunScorer run(name, motion, trajectory, skip, ins::Sensor::Dvl, kAperture, watch);
      run.follow(*make_(name, configOf(scenario, seed)), recording);
      EstimatorScorer& scorer = scorers.emplace_back(std::move(run.scorer()));
      scorer.addError("drift_percent", 100 * end_error / (scenario.track.speed * scenario.duration));
      scorer.facts().convergence = aligned.result();
      const NamedFilter* filter = findFilter(name);
      if (filter && filter->alone) scorer.trace().effective_size.clear(), scorer.trace().effective_time.clear();
    }
    return scorers;
  }

  EstimatorFactory make_;
  UnscentedParticleOptions particles_;
  bool accelerometer_bias_ = true;
  std::vector<Scenario> scenarios_;  // by law
};

}  // namespace

std::unique_ptr<Campaign> readCampaign(YamlSection& yaml, const std::string& folder, const EstimatorFactory& make) {
  return std::make_unique<SinsCampaign>(yaml, folder, make);
}

}  // namespace sas_motion::sins

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <filesystem>

#include "campaign/systems.hpp"
#include "sas_motion/io/cpu_time.hpp"
#include "sas_motion/math/statistics.hpp"
#include "sas_motion/systems/sins_dvl/estimator.hpp"
#include "sas_motion/systems/sins_dvl/scenario.hpp"
#include "systems/ins_gps_dvl/score.hpp"

namespace sas_motion {
namespace {

using namespace sins;

constexpr double kScoreEvery = 0.1;  // [s]
// Who has converged: the heading is within three standard deviations of large_angle's bound, and the velocity did not
// run away.
constexpr double kAlignedHeading = 2 * kRadPerDeg, kAlignedVelocity = 0.3;  // [rad, m/s]
constexpr double kAlignedFor = 30;                                          // to the end of the run [s]
const towfish::ApertureOptions kAperture{66, 0.015, 0.1};                   // 3.3 s at 3 m/s

/// One law, as it is simulated and as the estimators are told.
struct Case {
  Scenario scenario;
  ins::Scenario scored;  // the same motion
};

/// One estimator over one run.
class Follower {
 public:
  /// `alone`: it is a filter of one particle, whose effective size says nothing.
  Follower(const Case& one, const ins::Trajectory& trajectory, double skip, bool alone)
      : case_(one), trajectory_(trajectory), alone_(alone), score_(one.scored, skip, kAperture, ins::Sensor::Dvl) {}

  void run(ins::Estimator& estimator, const ins::Recording& recording) {
    estimator.start(recording.start, 0);
    auto next = recording.aiding.begin();
    ins::Output output;
    auto labelled = next;
    const auto take = [&](ins::Output& said) {
      for (const auto& audit : said.audits) note(audit, *labelled++);
      for (const auto& solution : said.solutions) note(solution);
      said.clear();
    };
    double seconds = 0;
    for (const auto& reading : recording.imu) {
      const double begin = cpuSeconds();
      for (; next != recording.aiding.end() && next->reading.stamp <= reading.stamp; ++next)
        estimator.process(next->reading, output);
      estimator.process(reading, output);
      seconds += cpuSeconds() - begin;
      take(output);
    }
    const double begin = cpuSeconds();
    estimator.finish(output);
    seconds += cpuSeconds() - begin;
    take(output);
    microseconds_ = 1e6 * seconds / static_cast<double>(std::max<std::size_t>(1, recording.aiding.size()));
  }

  EstimatorReport report(const std::string& name) const {
    EstimatorReport report = score_.report(name);
    const double drift = 100 * end_error_ / (case_.scenario.track.speed * case_.scenario.duration);
    report.errors.emplace_back("drift_percent", towfish::ErrorSummary{drift, drift, drift});
    report.convergence = aligned_.result();
    report.microseconds = microseconds_;
    return report;
  }
  const Trace& trace() const { return score_.trace(); }

 private:
  void note(Audit audit, const ins::LabelledAiding& labelled) {
    if (alone_) audit.effective_size = 0;
    score_.add(audit, labelled);
  }

  void note(const ins::NavigationSolution& solution) {
    const double time = secondsBetween(0, solution.stamp), ticks = time / kScoreEvery;
    if (std::abs(ticks - std::round(ticks)) > 1e-6) return;
    const ins::TruthSample truth = trajectory_.at(time);
    score_.add(truth, solution);
    end_error_ = displacement(truth.state, solution.state).head<2>().norm();
    const double heading = attitudeError(solution.state.q_nav_body, truth.state.q_nav_body).z();
    const double velocity = (solution.state.velocity_nav - truth.state.velocity_nav).head<2>().norm();
    aligned_.add(time, std::abs(heading) <= kAlignedHeading && velocity <= kAlignedVelocity);
  }

  const Case& case_;
  const ins::Trajectory& trajectory_;
  bool alone_;
  ins::Score score_;
  ConvergenceWatch aligned_{kAlignedFor};
  double microseconds_ = 0, end_error_ = 0;
};

class SinsSystem final : public System {
 public:
  SinsSystem(YamlSection& campaign, const std::string& folder, EstimatorFactory make) : make_(std::move(make)) {
    std::string file;
    campaign.text("scenario", file);
    if (file.empty()) campaign.fail("scenario", "is missing; name a scenario file");
    Scenario scenario = Scenario::fromFile(std::filesystem::path(folder) / file);
    campaign.number("duration", scenario.duration, {1, 1e6});
    duration = scenario.duration;
    skip = 60;
    campaign.number("skip", skip, {0, 1e6});
    if (skip >= duration)
      campaign.fail("skip", fmt::format("is {} but must be less than a run, which lasts {} s", skip, duration));
    campaign.integer("particles", particles_.particles, 1, 1'000'000);
    particles = particles_.particles;
    campaign.integer("threads", particles_.threads, 1, 1024);
    campaign.boolean("accelerometer_bias", accelerometer_bias_);
    dimension = accelerometer_bias_ ? kStates : kPaperStates;
    campaign.texts("estimators", estimators);
    if (estimators.empty()) campaign.fail("estimators", "is missing; list at least one");
    for (const auto& name : estimators)
      if (!make_(name, {}))
        campaign.fail("estimators", fmt::format("names '{}', which is no estimator of this system", name));
    for (auto& item : campaign.list("laws")) readLaw(item, scenario);
    if (laws.empty()) campaign.fail("laws", "is missing; list at least one");
  }

  std::vector<EstimatorReport> run(std::size_t law, std::uint64_t seed) const override {
    std::vector<EstimatorReport> reports;
    forEachEstimator(law, seed, [&](const std::string& name, const Follower& follower) {
      reports.push_back(follower.report(name));
    });
    return reports;
  }

  Named<Trace> trace(std::size_t law, std::uint64_t seed) const override {
    Named<Trace> traces;
    forEachEstimator(law, seed, [&](const std::string& name, const Follower& follower) {
      traces.emplace_back(name, follower.trace());
    });
    return traces;
  }

  Named<double> bound(std::size_t law, const std::vector<std::uint64_t>& seeds) const override {
    return sinsBound(cases_[law].scenario, skip, seeds);
  }

 private:
  std::unique_ptr<ins::Estimator> make(const std::string& name, const Case& one, std::uint64_t seed) const {
    Mechanisation::Options imu;
    imu.period = 1 / one.scenario.imu_rate;
    Config config{one.scenario.parameters, imu, particles_, accelerometer_bias_};
    config.particles.seed = seed;
    return make_(name, config);
  }

  template <class Visit>
  void forEachEstimator(std::size_t law, std::uint64_t seed, const Visit& visit) const {
    const Case& one = cases_[law];
    const ins::Trajectory trajectory(one.scenario.track, one.scenario.duration);
    const ins::Recording recording = sins::simulate(one.scenario, trajectory, seed);
    for (const auto& name : estimators) {
      const NamedFilter* filter = findFilter(name);
      Follower follower(one, trajectory, skip, filter && filter->alone);
      follower.run(*make(name, one, seed), recording);
      visit(name, follower);
    }
  }

  /// `noise` is of the DVL; `heading_deg` is the initial misalignment of the heading.
  void readLaw(YamlSection& item, Scenario scenario) {
    std::string name;
    item.text("name", name);
    if (item.has("noise")) scenario.dvl.noise = ins::Scenario::readNoise(item, "noise");
    item.angle("heading_deg", scenario.parameters.start_heading, {kTiny, 90});
    item.finish();
    laws.push_back(lawInfo(name, scenario.dvl.noise, {}));
    cases_.push_back({scenario, withoutGps(scenario)});
  }

  EstimatorFactory make_;
  UnscentedParticleOptions particles_;
  bool accelerometer_bias_ = true;
  std::vector<Case> cases_;  // by law
};

}  // namespace

std::unique_ptr<System> makeSinsSystem(YamlSection& campaign, const std::string& folder, const EstimatorFactory& make) {
  return std::make_unique<SinsSystem>(campaign, folder, make);
}

}  // namespace sas_motion

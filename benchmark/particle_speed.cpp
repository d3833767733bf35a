// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A step of the particle filters of SINS and DVL, a prediction over a second and a reading of DVL and depth, with
// vector instructions and without; and how much faster than real time the whole estimator is at 100 Hz and 1 Hz. All
// run second by second in turns, so that they meet the same neighbours on the machine, and figures are medians over the
// seconds. usage: particle_speed CONFIG_FOLDER [SECONDS] [PARTICLES]
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <ctime>
#include <vector>

#include "parallel/instruction_sets.hpp"
#include "sas_motion/filters/particles/blocks.hpp"
#include "sas_motion/math/statistics.hpp"
#include "sas_motion/systems/sins_dvl/estimator.hpp"
#include "sas_motion/systems/sins_dvl/scenario.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::sins;

struct Time {
  double wall = 0, cpu = 0;  ///< of all threads [s]

  static Time now() {
    timespec used{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
    return {std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(),
            static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec)};
  }
};
Time operator-(const Time& a, const Time& b) { return {a.wall - b.wall, a.cpu - b.cpu}; }

struct Variant {
  std::string name;
  int states = kStates, threads = 1;
  bool vectorised = true;
};

/// One estimator on its way, and its times second by second.
class Runner {
 public:
  Runner(const Variant& variant, const Scenario& scenario, const ins::Recording& recording, int particles)
      : variant_(variant), recording_(recording), next_aiding_(recording.aiding.begin()) {
    Config config;
    config.parameters = scenario.parameters;
    config.imu.period = 1 / scenario.imu_rate;
    config.particles.particles = particles;
    config.particles.threads = variant.threads;
    config.accelerometer_bias = variant.states == kStates;
    config.vectorised = variant.vectorised;
    estimator_ = makeEstimator(variant.name, config);
    estimator_->start(recording.start, 0);
  }

  void runTo(double time) {
    Time step{}, second{};
    for (; next_ < recording_.imu.size() && secondsBetween(0, recording_.imu[next_].stamp) <= time + 1e-6; ++next_) {
      for (; next_aiding_ != recording_.aiding.end() && next_aiding_->reading.stamp <= recording_.imu[next_].stamp;
           ++next_aiding_)
        estimator_->process(next_aiding_->reading, output_);
      const Time begin = Time::now();
      estimator_->process(recording_.imu[next_], output_);
      const Time taken = Time::now() - begin;
      second = {second.wall + taken.wall, second.cpu + taken.cpu};
      if (!output_.audits.empty()) step = {step.wall + taken.wall, step.cpu + taken.cpu};
      output_.clear();
    }
    step_walls_.push_back(step.wall);
    step_cpus_.push_back(step.cpu);
    walls_.push_back(second.wall);
    cpus_.push_back(second.cpu);
  }

  const Variant& variant() const { return variant_; }
  double stepWall() const { return quantile(step_walls_, 0.5); }
  double stepCpu() const { return quantile(step_cpus_, 0.5); }
  /// As it went, and with a core to itself.
  double timesRealTime() const { return 1 / quantile(walls_, 0.5); }
  double secondsPerCpuSecond() const { return 1 / quantile(cpus_, 0.5); }

 private:
  Variant variant_;
  const ins::Recording& recording_;
  std::vector<ins::LabelledAiding>::const_iterator next_aiding_;
  std::unique_ptr<ins::Estimator> estimator_;
  std::size_t next_ = 0;
  ins::Output output_;
  std::vector<double> step_walls_, step_cpus_, walls_, cpus_;
};

/// Runs them in turns; the first is what the others are compared with.
void compare(const std::vector<Variant>& variants, const Scenario& scenario, const ins::Recording& recording,
             int particles) {
  std::vector<Runner> runners;
  for (const auto& variant : variants) runners.emplace_back(variant, scenario, recording, particles);
  for (int second = 1; second <= static_cast<int>(scenario.duration); ++second)
    for (auto& runner : runners) runner.runTo(second);
  for (const auto& runner : runners) {
    const Variant& variant = runner.variant();
    const bool blocks = variant.vectorised && findFilter(variant.name)->kind == FilterKind::SquareRoot;
    fmt::print(
        "{:9} {} states, threads: {}, {:10}  step {:6.2f} ms, {:6.2f} ms of CPU, x {:5.2f} of the first; {:5.0f} times "
        "real time, {:5.0f} s a CPU second\n",
        variant.name, variant.states, variant.threads, blocks ? blocks::target() : "one by one",
        1e3 * runner.stepWall(), 1e3 * runner.stepCpu(), runner.stepCpu() / runners.front().stepCpu(),
        runner.timesRealTime(), runner.secondsPerCpuSecond());
  }
  fmt::print("\n");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return fmt::print(stderr, "usage: particle_speed CONFIG_FOLDER [SECONDS] [PARTICLES]\n"), 2;
  Scenario scenario = Scenario::fromFile(std::string(argv[1]) + "/scenarios/sins_dvl/accuracy.yaml");
  scenario.duration = argc > 2 ? std::max(1, std::atoi(argv[2])) : 40;
  const int particles = argc > 3 ? std::max(1, std::atoi(argv[3])) : 1200;
  const ins::Recording recording = simulate(scenario, ins::Trajectory(scenario.track, scenario.duration), 1);
  fmt::print("{} particles, {:.0f} s; medians of the seconds\n", particles, scenario.duration);
  for (const int states : {kStates, kPaperStates}) {
    std::vector<Variant> variants;
    for (const int threads : {1, 2})
      for (const bool vectorised : {true, false}) variants.push_back({"ss_srupf", states, threads, vectorised});
    for (const int threads : {1, 2})
      for (const char* name : {"upf", "pf"}) variants.push_back({name, states, threads});
    compare(variants, scenario, recording, particles);
  }
  forEachInstructionSet([&] {
    compare({{"ss_srupf"}, {"ss_srupf", kStates, 1, false}}, scenario, recording, particles);
  });
}

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "campaign/systems.hpp"
#include "sas_motion/evaluation/bounds.hpp"
#include "sas_motion/evaluation/information.hpp"
#include "sas_motion/evaluation/law_aware.hpp"
#include "sas_motion/io/cpu_time.hpp"
#include "sas_motion/noise/noise_source.hpp"
#include "sas_motion/systems/constant_velocity/model.hpp"
#include "sas_motion/systems/towfish/filter_by_name.hpp"

namespace sas_motion {
namespace {

using namespace constant_velocity;
using towfish::kOracle;
using State = Vector<kStates>;

struct Law {
  NoiseMix position, velocity, process;
};

/// One epoch of a simulated run.
struct Epoch {
  double time;
  State truth;
  Vector<kRows> z;
  Vector<kRows> variance;   ///< what an oracle is told, over the good one
  double process_variance;  ///< likewise
  bool outlier;             ///< of any row
};

std::vector<Epoch> simulate(const Model& model, const Law& law, double duration, std::uint64_t seed) {
  constexpr std::uint64_t kProcessStream = 100, kSensorStream = 200;
  ProcessNoise process(law.process, kStates, seed, kProcessStream);
  std::vector<NoiseSource> sensors;
  for (std::uint64_t row = 0; row < kRows; ++row)
    sensors.emplace_back(row < 3 ? law.position : law.velocity, seed, kSensorStream + row, kSensorStream + 100);
  const auto step = model.transition(State::Zero());
  const Matrix<kStates> F = step.F, root = step.Q.llt().matrixL();
  std::vector<Epoch> run;
  State x = State::Zero();
  for (long k = 1; static_cast<double>(k) * model.step <= duration + 1e-9; ++k) {
    Epoch epoch{static_cast<double>(k) * model.step, {}, {}, {}, 1, false};
    const auto noise = process.draw(epoch.time);
    x = (F * x + root * noise.value).eval();
    epoch.truth = x;
    epoch.process_variance = noise.variance.mean();
    for (int row = 0; row < kRows; ++row) {
      const NoiseSample sample = sensors[static_cast<std::size_t>(row)].draw(epoch.time);
      const double sigma = model.sigma()(row), quantum = sigma * sample.quantum;
      epoch.z(row) = x(row) + sigma * sample.value;
      if (quantum > 0) epoch.z(row) = quantum * std::round(epoch.z(row) / quantum);
      if (sample.frozen && !run.empty()) epoch.z(row) = run.back().z(row);
      epoch.variance(row) = sample.missing ? INFINITY : sample.variance;
      epoch.outlier |= sample.outlier;
    }
    run.push_back(epoch);
  }
  return run;
}

/// Position and velocity errors of one estimator over a run.
class Score {
 public:
  Score(double skip, double epoch) : skip_(skip), lock_out_(epoch) {}

  template <class Belief>
  void add(const Epoch& epoch, const Belief& belief, double nis, double weight) {
    if (epoch.time <= skip_) return;
    const State error = gaussian(belief).mean - epoch.truth;
    const Matrix<kStates>& P = gaussian(belief).covariance;
    position_.push_back(error.head<3>().norm());
    velocity_.push_back(error.tail<3>().norm());
    nees_.push_back(error.dot(P.llt().solve(error)));
    nis_.push_back(nis);
    finite_ &= error.allFinite() && P.allFinite();
    lock_out_.add(epoch.time, (error.head<3>().array().abs() / P.diagonal().head<3>().array().sqrt()).maxCoeff());
    trace_.time.push_back(epoch.time);
    trace_.sigma3.push_back(3 * std::sqrt(P.diagonal().head<3>().sum()));
    trace_.add("velocity", velocity_.back(), P.diagonal().tail<3>().sum());
    trace_.weight.push_back(weight);
    trace_.outlier.push_back(epoch.outlier);
  }

  EstimatorReport report(const std::string& name) const {
    EstimatorReport report;
    report.estimator = name;
    report.diverged = !finite_;
    report.locked_out = lock_out_.lockedOut();
    report.samples = position_.size();
    report.errors = {{"position", towfish::summarize(position_)}, {"velocity", towfish::summarize(velocity_)}};
    report.nees = {{"full", mean(nees_) / kStates}};
    report.nis = {{"position", mean(nis_) / kRows}};
    return report;
  }

  Trace trace() const {
    Trace trace = trace_;
    trace.error = position_;
    trace.nees = nees_;
    trace.nis = nis_;
    trace.weight_time = trace.time;
    trace.nees_degrees = kStates;
    trace.nis_degrees = kRows;
    return trace;
  }

 private:
  double skip_;
  LockOut lock_out_;
  std::vector<double> position_, velocity_, nees_, nis_;
  bool finite_ = true;
  Trace trace_;
};

class ConstantVelocitySystem final : public System {
 public:
  explicit ConstantVelocitySystem(YamlSection& campaign) {
    dimension = kStates;
    duration = 150;
    skip = 10;
    campaign.number("duration", duration, {1, 1e6});
    campaign.number("skip", skip, {0, 1e6});
    if (skip >= duration)
      campaign.fail("skip", fmt::format("is {} but must be less than a run, which lasts {} s", skip, duration));
    campaign.texts("estimators", estimators);
    if (estimators.empty()) campaign.fail("estimators", "is missing; list at least one");
    config_.bank_kf.epoch = model_.step;
    auto settings = campaign.section("settings");
    readConfig(settings, config_);
    settings.finish();
    for (const auto& name : estimators)
      if (name != kOracle && name != towfish::kBayesReference && !withFilter(name, config_, [](const auto&) {}))
        campaign.fail("estimators", fmt::format("names '{}', which is no filter", name));
    for (auto& item : campaign.list("laws")) {
      std::string law_name;
      item.text("name", law_name);
      Law law;
      law.position = NoiseMix::read(item, "noise");
      law.velocity = item.has("velocity_noise") ? NoiseMix::read(item, "velocity_noise") : law.position;
      law.process = NoiseMix::read(item, "process", NoiseUse::Process);
      item.finish();
      laws.push_back(lawInfo(law_name, law.position, law.process));
      if (law.velocity.name() != law.position.name()) {
        laws.back().description += ", velocity " + law.velocity.name();
        laws.back().epsilon = laws.back().K = std::nullopt;
      }
      noise_.push_back(law);
    }
    if (laws.empty()) campaign.fail("laws", "is missing; list at least one");
  }

  std::vector<EstimatorReport> run(std::size_t law, std::uint64_t seed) const override {
    const auto epochs = simulate(model_, noise_[law], duration, seed);
    std::vector<EstimatorReport> reports;
    for (const auto& name : estimators) {
      double seconds = 0;
      const Score score = filtered(name, noise_[law], epochs, seconds);
      reports.push_back(score.report(name));
      reports.back().microseconds = 1e6 * seconds / static_cast<double>(epochs.size());
    }
    return reports;
  }

  Named<Trace> trace(std::size_t law, std::uint64_t seed) const override {
    const auto epochs = simulate(model_, noise_[law], duration, seed);
    Named<Trace> traces;
    double seconds = 0;
    for (const auto& name : estimators) traces.emplace_back(name, filtered(name, noise_[law], epochs, seconds).trace());
    return traces;
  }

  Named<double> bound(std::size_t law, const std::vector<std::uint64_t>& seeds) const override;

 private:
  /// Laws of the velocity may differ from those of the position in their spells alone; bursts are the sensor's.
  GaussianSumOptions told(const Law& law) const {
    auto options = lawAware(law.position, law.process, model_.step);
    const bool alike = law.velocity.name() == law.position.name();
    options.mode.common = true;
    options.mode.rows = alike ? 0b1111 : 0b0111;
    return options;
  }

  Score filtered(const std::string& name, const Law& law, const std::vector<Epoch>& epochs, double& seconds) const {
    Score score(skip, model_.step);
    const bool oracle = name == kOracle;
    const auto run = [&](const auto& filter) {
      using Belief = typename std::decay_t<decltype(filter)>::Belief;
      Belief belief{Gaussian<kStates>()};  // zero and the identity, as truth is zero
      const double begin = cpuSeconds();
      for (const auto& epoch : epochs) {
        auto transition = model_.transition(gaussian(belief).mean);
        if (oracle) transition.Q *= epoch.process_variance;
        belief = filter.predict(belief, transition);
        auto z = model_.measurement(epoch.z, gaussian(belief).mean, epoch.time);
        for (int row = 0; row < kRows; ++row)
          if (oracle || std::isinf(epoch.variance(row))) z.R(row, row) *= std::min(epoch.variance(row), kSaysNothing);
        auto update = filter.update(belief, z);
        belief = update.belief;
        score.add(epoch, belief, update.nis, update.weights.minCoeff());
      }
      seconds = cpuSeconds() - begin;
    };
    if (oracle)
      run(KalmanFilter<kStates>());
    else if (name == towfish::kBayesReference)
      run(GaussianSumFilter<kStates>(told(law)));
    else
      withFilter(name, config_, run);
    return score;
  }

  Model model_;
  towfish::Config config_;
  std::vector<Law> noise_;
};

/// Linear, so one truth does for what is linearised.
Named<double> ConstantVelocitySystem::bound(std::size_t law, const std::vector<std::uint64_t>& seeds) const {
  const MeasurementInformation position(noise_[law].position), velocity(noise_[law].velocity);
  const auto process = processInformation(noise_[law].process, kStates, model_.step);
  const auto step = model_.transition(State::Zero());
  MeanBound<kStates> mean;
  for (const auto seed : seeds) {
    PosteriorBound<kStates> bound(Matrix<kStates>::Identity());
    for (const auto& epoch : simulate(model_, noise_[law], duration, seed)) {
      auto transition = step;
      if (process.genie) transition.Q *= epoch.process_variance;
      bound.step({transition}, process.genie ? 1 : process.factor);
      Vector<kRows> factor;
      for (int row = 0; row < kRows; ++row)
        factor(row) =
            std::isinf(epoch.variance(row)) ? 0 : (row < 3 ? position : velocity).of(epoch.variance(row), epoch.time);
      bound.measurement<kRows>({model_.measurement(State::Zero().head<kRows>(), State::Zero(), epoch.time)}, {factor});
      if (epoch.time > skip) mean.add(bound);
    }
  }
  return boundsOf<kStates>(mean, {{"position", {0, 1, 2}}, {"velocity", {3, 4, 5}}});
}

}  // namespace

std::unique_ptr<System> makeConstantVelocitySystem(YamlSection& campaign) {
  return std::make_unique<ConstantVelocitySystem>(campaign);
}

}  // namespace sas_motion

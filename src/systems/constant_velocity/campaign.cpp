// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/constant_velocity/campaign.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "sas_motion/evaluation/bounds.hpp"
#include "sas_motion/evaluation/information.hpp"
#include "sas_motion/evaluation/law_aware.hpp"
#include "sas_motion/filters/filter_by_name.hpp"
#include "sas_motion/filters/gaussian_sum_filter.hpp"
#include "sas_motion/io/cpu_time.hpp"
#include "sas_motion/noise/noise_source.hpp"
#include "sas_motion/systems/constant_velocity/model.hpp"

namespace sas_motion::constant_velocity {
namespace {

using State = Vector<kStates>;

/// The noise of one law.
struct Law {
  NoiseMix position, velocity, process;
};

/// One epoch of a simulated run.
struct Epoch {
  double time;
  State truth;
  Vector<kRows> z;
  Vector<kRows> variance;   ///< that the noise was drawn with, over the good one
  double process_variance;  ///< the same of the process noise
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

/// Hands the errors of one epoch to a scorer and its trace.
template <class Belief>
void score(const Epoch& epoch, const Belief& belief, double nis, double weight, EstimatorScorer& scorer) {
  const State error = gaussian(belief).mean - epoch.truth;
  const Matrix<kStates>& P = gaussian(belief).covariance;
  const double position = error.head<3>().norm(), velocity = error.tail<3>().norm(),
               square = normalisedSquare<kStates>(error, P);
  scorer.addSample(error.allFinite() && P.allFinite());
  scorer.addError("position", position);
  scorer.addError("velocity", velocity);
  scorer.addNees("full", square, kStates);
  scorer.addNis("position", nis, kRows);
  scorer.addRatio(epoch.time, (error.head<3>().array().abs() / P.diagonal().head<3>().array().sqrt()).maxCoeff());
  scorer.trace().add(epoch.time, position, P.diagonal().head<3>().sum());
  scorer.trace().add("velocity", velocity, P.diagonal().tail<3>().sum());
  scorer.trace().nees.push_back(square);
  scorer.trace().addWeight(epoch.time, weight, epoch.outlier, nis);
}

/// `noise` is of the position, and of the velocity where that has none of its own.
LawInfo readLaw(YamlSection& yaml, const std::string& name, Law& law) {
  law.position = NoiseMix::read(yaml, "noise");
  law.velocity = yaml.has("velocity_noise") ? NoiseMix::read(yaml, "velocity_noise") : law.position;
  law.process = NoiseMix::read(yaml, "process", NoiseUse::Process);
  LawInfo info = lawInfo(name, law.position, law.process);
  if (law.velocity.name() != law.position.name()) {
    info.description += ", velocity " + law.velocity.name();
    info.epsilon = info.K = std::nullopt;
  }
  return info;
}

/// Monte Carlo of the textbook problem.
class ConstantVelocityCampaign final : public Campaign {
 public:
  explicit ConstantVelocityCampaign(YamlSection& yaml) {
    dimension = kStates;
    readDuration(yaml, 150);
    filters_.bank_kf.epoch = model_.step;
    readSettings(yaml.section("settings"));
    readScoring(yaml, 10, [&](const std::string& name) {
      return name == kOracle || name == kBayesReference || withFilter<kStates>(name, filters_, [](const auto&) {});
    });
    laws_ = readLaws(yaml, Law(), &readLaw);
  }

  Named<double> bound(std::size_t law, const std::vector<std::uint64_t>& seeds) const override;

 private:
  void readSettings(YamlSection settings) {
    settings.number("reset_after", filters_.reset_after, {kTiny, 1e6});
    auto filters = settings.section("estimators");
    readOptions(filters, filters_);
    filters.finish();
    settings.finish();
  }

  /// What the reference knows. Laws of the velocity may differ from those of the position in their spells alone; bursts
  /// are the sensor's.
  GaussianSumOptions lawsOf(const Law& law) const {
    auto options = lawAware(law.position, law.process, model_.step);
    const bool alike = law.velocity.name() == law.position.name();
    options.mode.common = true;
    options.mode.rows = alike ? 0b1111 : 0b0111;
    return options;
  }

  std::vector<EstimatorScorer> score(std::size_t law, std::uint64_t seed) const override {
    const auto epochs = simulate(model_, laws_[law], duration, seed);
    ScorerOptions options;
    options.epoch = model_.step;
    std::vector<EstimatorScorer> scorers;
    for (const auto& name : estimators) {
      auto& scorer = scorers.emplace_back(name, options);
      scorer.trace().nees_degrees = kStates;
      scorer.trace().nis_degrees = kRows;
      const auto run = [&](const auto& filter) { follow(filter, name == kOracle, epochs, scorer); };
      if (name == kOracle)
        run(KalmanFilter<kStates>());
      else if (name == kBayesReference)
        run(GaussianSumFilter<kStates>(lawsOf(laws_[law])));
      else
        withGuardedFilter<kStates>(name, filters_, run);
    }
    return scorers;
  }

  template <class Filter>
  void follow(const Filter& filter, bool oracle, const std::vector<Epoch>& epochs, EstimatorScorer& scorer) const {
    typename Filter::Belief belief{Gaussian<kStates>()};  // zero and the identity, as truth is zero
    const double begin = cpuSeconds();
    for (const auto& epoch : epochs) {
      auto transition = model_.transition(gaussian(belief).mean);
      if (oracle) transition.Q *= epoch.process_variance;
      belief = filter.predict(belief, transition);
      auto z = model_.measurement(epoch.z, gaussian(belief).mean, epoch.time);
      for (int row = 0; row < kRows; ++row)
        if (oracle || std::isinf(epoch.variance(row))) z.R(row, row) *= std::min(epoch.variance(row), kNoInformation);
      auto update = filter.update(belief, z);
      belief = update.belief;
      if (epoch.time > skip) constant_velocity::score(epoch, belief, update.nis, update.weights.minCoeff(), scorer);
    }
    scorer.setCost(cpuSeconds() - begin, epochs.size());
  }

  Model model_;
  FilterOptions filters_;
  std::vector<Law> laws_;
};

/// Linear, so one truth does for what is linearised.
Named<double> ConstantVelocityCampaign::bound(std::size_t law, const std::vector<std::uint64_t>& seeds) const {
  const MeasurementInformation position(laws_[law].position), velocity(laws_[law].velocity);
  const auto process = processInformation(laws_[law].process, kStates, model_.step);
  const auto step = model_.transition(State::Zero());
  MeanBound<kStates> mean;
  for (const auto seed : seeds) {
    PosteriorBound<kStates> bound(Matrix<kStates>::Identity());
    for (const auto& epoch : simulate(model_, laws_[law], duration, seed)) {
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
  return mean.rmses({{"position", {0, 1, 2}}, {"velocity", {3, 4, 5}}});
}

}  // namespace

std::unique_ptr<Campaign> readCampaign(YamlSection& yaml, const std::string&) {
  return std::make_unique<ConstantVelocityCampaign>(yaml);
}

}  // namespace sas_motion::constant_velocity

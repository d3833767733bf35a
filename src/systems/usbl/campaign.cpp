// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/usbl/campaign.hpp"

#include <fmt/format.h>

#include <cmath>

#include "sas_motion/evaluation/information.hpp"
#include "sas_motion/math/angles.hpp"

namespace sas_motion::usbl {
namespace {

constexpr double kScored = 100;    // the paper's statistics are of the last seconds [ZhangTao]
constexpr double kWrongSigma = 5;  // own standard deviations that the error at the end may have [-]

/// Sizes of an error: of the mounting angles together [rad], the lever arm [m], then of each unknown.
Named<double> sizesOf(const State& error) {
  Named<double> sizes{{"mounting", error.head<3>().norm()}, {"lever", error.tail<3>().norm()}};
  for (int i = 0; i < kStates; ++i) sizes.emplace_back(unknownNames()[static_cast<std::size_t>(i)], std::abs(error(i)));
  return sizes;
}

double timeOf(const LabelledPing& labelled) { return secondsBetween(kScenarioStart, labelled.ping.stamp); }

/// Hands the errors of one estimate to the trace and, where it is scored, to the scorer.
void score(const Estimate& estimate, const State& truth, bool scored, EstimatorScorer& scorer) {
  const Matrix<kStates>& P = estimate.belief.covariance;
  State error = estimate.belief.mean - truth;
  error.head<3>() = error.head<3>().unaryExpr(&wrapAngle);
  const double square = normalisedSquare<kStates>(error, P);
  scorer.trace().add(estimate.time, error.head<3>().norm(), P.diagonal().head<3>().sum());
  scorer.trace().add("lever", error.tail<3>().norm(), P.diagonal().tail<3>().sum());
  scorer.trace().nees.push_back(square);
  if (!scored) return;
  scorer.addSample(error.allFinite() && P.allFinite());
  for (const auto& [name, size] : sizesOf(error)) scorer.addError(name, size);
  scorer.addNees("full", square, kStates);
  for (const auto& [name, first] : {std::pair("mounting", kMountingX), std::pair("lever", kLeverX)})
    scorer.addNees(name, normalisedSquare<3>(error.segment<3>(first), P.block<3, 3>(first, first)), 3);
  scorer.facts().locked_out = (error.array().abs() > kWrongSigma * P.diagonal().array().sqrt()).any();
}

Config readSettings(YamlSection yaml) {
  Config config;
  std::string mode = modeName(config.mode);
  yaml.text("mode", mode);
  try {
    config.mode = modeFromName(mode);
  } catch (const std::invalid_argument& error) {
    yaml.fail("mode", fmt::format("cannot be: {}", error.what()));
  }
  yaml.number("start_window", config.start_window, {0, 1e6});
  yaml.number("check_window", config.check_window, {0, 1e6});
  yaml.finish();
  return config;
}

/// `noise` is of every channel.
LawInfo readLaw(YamlSection& yaml, const std::string& name, Scenario& scenario) {
  scenario.noise.fill(yaml.has("noise") ? NoiseMix::read(yaml, "noise") : NoiseMix(scenario.noise[0]));
  yaml.number("stated_factor", scenario.stated_factor, {1e-6, 1e6});
  LawInfo info = lawInfo(name, scenario.noise[0], {});
  if (scenario.stated_factor != 1)
    info.description += fmt::format(", stated variance times {:g}", scenario.stated_factor);
  return info;
}

/// Monte Carlo of one calibration.
class UsblCampaign final : public Campaign {
 public:
  UsblCampaign(YamlSection& yaml, const std::string& folder, FitterFactory fitters) : fitters_(std::move(fitters)) {
    dimension = kStates;
    const auto scenario = readScenario<Scenario>(yaml, folder);
    config_ = readSettings(yaml.section("settings"));
    readScoring(yaml, -kScored, [&](const std::string& name) { return isEstimator(name, fitters_); });
    scenarios_ = readLaws(yaml, scenario, &readLaw, "");
  }

  Named<double> bound(std::size_t law, const std::vector<std::uint64_t>& seeds) const override;

 private:
  bool scored(double time) const { return time > skip + 1e-6; }

  /// The trace has the start too: it shows how the calibration converges.
  std::vector<EstimatorScorer> score(std::size_t law, std::uint64_t seed) const override {
    const Scenario& scenario = scenarios_[law];
    const auto pings = simulatePings(scenario, seed);
    std::vector<EstimatorScorer> scorers;
    for (const auto& name : estimators) {
      auto& scorer = scorers.emplace_back(name);
      scorer.trace().nees_degrees = kStates;
      scorer.trace().nis_degrees = config_.mode == Mode::Azimuth ? 2 : kChannels;
      const Output output = estimate(config_, scenario, pings, name, fitters_);
      for (const auto& estimate : output.estimates)
        usbl::score(estimate, scenario.truth.head<kStates>(), scored(estimate.time), scorer);
      for (std::size_t k = 0; k < pings.size(); ++k) scorePing(pings[k], output.weights[k], output.nis[k], scorer);
      scorer.facts().diverged |= scorer.facts().samples == 0;
      scorer.setCost(output.seconds, pings.size());
    }
    return scorers;
  }

  void scorePing(const LabelledPing& labelled, const Vector<kChannels>& weights, double nis,
                 EstimatorScorer& scorer) const {
    const auto& outlier = labelled.outlier;
    scorer.trace().addWeight(timeOf(labelled), weights.minCoeff(), outlier[0] || outlier[1] || outlier[2], nis);
    if (scored(timeOf(labelled)) && std::isfinite(nis)) scorer.addNis("reading", nis / degreesOf(labelled), 1);
    if (config_.mode == Mode::AzimuthElevation || config_.mode == Mode::Azimuth) return;  // channels without labels
    for (int i = 0; i < kChannels; ++i)
      if (labelled.ping.reading.has(i) && std::isfinite(weights(i)))
        scorer.addDetection("reading", outlier[static_cast<std::size_t>(i)], weights(i) < kDownWeighted);
  }

  double degreesOf(const LabelledPing& labelled) const {
    const Reading reading = Model(config_.mode).convert(labelled.ping.reading);
    return std::max(1, reading.has(0) + reading.has(1) + reading.has(2));
  }

  FitterFactory fitters_;
  Config config_;
  std::vector<Scenario> scenarios_;  // by law
};

/// The bound of range and direction angles, which is the same in every mode that keeps all of their information;
/// azimuth keeps less and has no bound here. The noise of position and attitude is left out.
Named<double> UsblCampaign::bound(std::size_t law, const std::vector<std::uint64_t>& seeds) const {
  if (config_.mode == Mode::Azimuth) return {};
  const Scenario& under = scenarios_[law];
  const std::array<MeasurementInformation, kChannels> information{MeasurementInformation(under.noise[0]),
                                                                  MeasurementInformation(under.noise[1]),
                                                                  MeasurementInformation(under.noise[2])};
  Problem one{Model(), config_.prior, {}, Vector<kChannels>::Constant(1 / std::sqrt(under.stated_factor))};
  State squares = State::Zero();
  double count = 0;
  for (const auto seed : seeds) {
    Matrix<kUnknowns> data = Matrix<kUnknowns>::Zero();
    for (const auto& labelled : simulatePings(under, seed)) {
      Vector<kChannels> factor;
      for (int i = 0; i < kChannels; ++i)
        factor(i) = information[static_cast<std::size_t>(i)].of(labelled.variance(i), timeOf(labelled));
      one.pings = {labelled.ping};
      data += usbl::information(one, under.truth, factor);
      if (!scored(timeOf(labelled))) continue;
      squares += covarianceFrom(data, one.prior).diagonal().head<kStates>();
      ++count;
    }
  }
  if (count == 0) return {};
  return sizesOf((squares / count).cwiseSqrt());
}

}  // namespace

std::unique_ptr<Campaign> readCampaign(YamlSection& yaml, const std::string& folder, const FitterFactory& fitters) {
  return std::make_unique<UsblCampaign>(yaml, folder, fitters);
}

}  // namespace sas_motion::usbl

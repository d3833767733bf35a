// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "campaign/systems.hpp"
#include "sas_motion/evaluation/information.hpp"
#include "sas_motion/filters/update.hpp"
#include "sas_motion/math/angles.hpp"
#include "systems/usbl/campaign.hpp"

namespace sas_motion {
namespace {

using namespace usbl;

constexpr double kSureOfTheWrong = 5;  // own standard deviations that the error at the end may have [-]

/// Sizes of an error: of the mounting angles together [rad], the lever arm [m], then of each unknown.
Named<double> sizesOf(const State& error) {
  Named<double> sizes{{"mounting", error.head<3>().norm()}, {"lever", error.tail<3>().norm()}};
  for (int i = 0; i < kStates; ++i) sizes.emplace_back(unknownNames()[static_cast<std::size_t>(i)], std::abs(error(i)));
  return sizes;
}

State errorOf(const Gaussian<kStates>& belief, const State& truth) {
  State error = belief.mean - truth;
  error.head<3>() = error.head<3>().unaryExpr(&wrapAngle);
  return error;
}

double normalisedSquare(const Gaussian<kStates>& belief, const State& error) {
  return error.dot(belief.covariance.llt().solve(error));
}

template <int Size>
double normalisedPart(const Gaussian<kStates>& belief, const State& error, int first) {
  const Vector<Size> part = error.segment<Size>(first);
  return part.dot(Matrix<Size>(belief.covariance.block<Size, Size>(first, first)).llt().solve(part));
}

/// One estimator's errors over the scored part of a run.
class Score {
 public:
  void add(const Gaussian<kStates>& belief, const State& truth) {
    const State error = errorOf(belief, truth);
    finite_ &= error.allFinite() && belief.covariance.allFinite();
    const auto sizes = sizesOf(error);
    errors_.resize(sizes.size());
    for (std::size_t i = 0; i < sizes.size(); ++i) errors_[i].push_back(sizes[i].second);
    full_.push_back(normalisedSquare(belief, error));
    mounting_.push_back(normalisedPart<3>(belief, error, kMountingX));
    lever_.push_back(normalisedPart<3>(belief, error, kLeverX));
    wrong_at_end_ = (error.array().abs() > kSureOfTheWrong * belief.covariance.diagonal().array().sqrt()).any();
  }

  EstimatorReport report(const std::string& name) const {
    EstimatorReport report;
    report.estimator = name;
    report.diverged = errors_.empty() || !finite_;
    if (errors_.empty()) return report;
    report.locked_out = wrong_at_end_;
    report.samples = full_.size();
    const auto names = sizesOf(State::Zero());
    for (std::size_t i = 0; i < errors_.size(); ++i)
      report.errors.emplace_back(names[i].first, towfish::summarize(errors_[i]));
    report.nees = {{"full", mean(full_) / kStates}, {"mounting", mean(mounting_) / 3}, {"lever", mean(lever_) / 3}};
    return report;
  }

 private:
  std::vector<std::vector<double>> errors_;
  std::vector<double> full_, mounting_, lever_;
  bool finite_ = true, wrong_at_end_ = false;
};

class UsblSystem final : public System {
 public:
  UsblSystem(YamlSection& section, const std::string& folder, FitterFactory fitters)
      : campaign_(Campaign::read(section, folder)), fitters_(std::move(fitters)) {
    dimension = kStates;
    duration = campaign_.scenario.duration;
    skip = campaign_.skip;
    estimators = campaign_.estimators;
    for (const auto& estimator : estimators)
      if (!isEstimator(estimator, fitters_))
        section.fail("estimators", fmt::format("names '{}', which is no estimator of a calibration", estimator));
    for (const auto& law : campaign_.laws) {
      laws.push_back(lawInfo(law.name, law.noise, {}));
      if (law.stated_factor != 1)
        laws.back().description += fmt::format(", stated variance times {:g}", law.stated_factor);
    }
  }

  std::vector<EstimatorReport> run(std::size_t law, std::uint64_t seed) const override {
    const auto pings = simulatePings(scenario(law), seed);
    std::vector<EstimatorReport> reports;
    for (const auto& name : estimators) reports.push_back(reportOf(name, pings, estimated(name, law, pings)));
    return reports;
  }

  Named<Trace> trace(std::size_t law, std::uint64_t seed) const override {
    const auto pings = simulatePings(scenario(law), seed);
    Named<Trace> traces;
    for (const auto& name : estimators) traces.emplace_back(name, traceOf(pings, estimated(name, law, pings)));
    return traces;
  }

  Named<double> bound(std::size_t law, const std::vector<std::uint64_t>& seeds) const override;

 private:
  Scenario scenario(std::size_t law) const { return campaign_.scenarioUnder(campaign_.laws[law]); }
  State truth() const { return campaign_.scenario.truth.head<kStates>(); }
  bool scored(double time) const { return time > skip + 1e-6; }

  Output estimated(const std::string& name, std::size_t law, const std::vector<LabelledPing>& pings) const {
    Campaign under = campaign_;
    under.scenario = scenario(law);
    return estimate(under, pings, name, fitters_);
  }

  EstimatorReport reportOf(const std::string& name, const std::vector<LabelledPing>& pings,
                           const Output& output) const {
    Score score;
    for (const auto& estimate : output.estimates)
      if (scored(estimate.time)) score.add(estimate.belief, truth());
    EstimatorReport report = score.report(name);
    std::vector<double> nis;
    for (std::size_t k = 0; k < pings.size(); ++k)
      if (scored(timeOf(pings[k])) && std::isfinite(output.nis[k])) nis.push_back(output.nis[k] / degreesOf(pings[k]));
    if (!nis.empty()) report.nis = {{"reading", mean(nis)}};
    const towfish::Detection detection = detectionOf(pings, output);
    report.precision = detection.precision();
    report.recall = detection.recall();
    report.microseconds = 1e6 * output.seconds / static_cast<double>(std::max<std::size_t>(1, pings.size()));
    return report;
  }

  /// Of single channels, where the mode has those that the labels are of.
  towfish::Detection detectionOf(const std::vector<LabelledPing>& pings, const Output& output) const {
    towfish::Detection detection;
    if (campaign_.config.mode == Mode::AzimuthElevation || campaign_.config.mode == Mode::Azimuth) return detection;
    for (std::size_t k = 0; k < pings.size(); ++k)
      for (int i = 0; i < kChannels; ++i) {
        if (!pings[k].ping.reading.has(i) || !std::isfinite(output.weights[k](i))) continue;
        const bool labelled = pings[k].outlier[static_cast<std::size_t>(i)],
                   flagged = output.weights[k](i) < kDownWeighted;
        detection.labelled += labelled;
        detection.flagged += flagged;
        detection.hits += labelled && flagged;
      }
    return detection;
  }

  /// The whole run, the start too: how the calibration converges.
  Trace traceOf(const std::vector<LabelledPing>& pings, const Output& output) const {
    Trace trace;
    trace.nees_degrees = kStates;
    trace.nis_degrees = campaign_.config.mode == Mode::Azimuth ? 2 : kChannels;
    for (const auto& estimate : output.estimates) {
      const State error = errorOf(estimate.belief, truth());
      trace.time.push_back(estimate.time);
      trace.error.push_back(error.head<3>().norm());
      trace.sigma3.push_back(3 * std::sqrt(estimate.belief.covariance.diagonal().head<3>().sum()));
      trace.add("lever", error.tail<3>().norm(), estimate.belief.covariance.diagonal().tail<3>().sum());
      trace.nees.push_back(normalisedSquare(estimate.belief, error));
    }
    for (std::size_t k = 0; k < pings.size(); ++k) {
      trace.weight_time.push_back(timeOf(pings[k]));
      trace.weight.push_back(output.weights[k].minCoeff());
      trace.outlier.push_back(pings[k].outlier[0] || pings[k].outlier[1] || pings[k].outlier[2]);
      trace.nis.push_back(output.nis[k]);
    }
    return trace;
  }

  static double timeOf(const LabelledPing& labelled) { return secondsBetween(kScenarioStart, labelled.ping.stamp); }

  double degreesOf(const LabelledPing& labelled) const {
    const Reading reading = Model(campaign_.config.mode).convert(labelled.ping.reading);
    return std::max(1, reading.has(0) + reading.has(1) + reading.has(2));
  }

  Campaign campaign_;
  FitterFactory fitters_;
};

/// What range and direction angles tell, which is the same in every mode that keeps all of it; azimuth keeps less and
/// has no bound here. The noise of position and attitude is left out.
Named<double> UsblSystem::bound(std::size_t law, const std::vector<std::uint64_t>& seeds) const {
  if (campaign_.config.mode == Mode::Azimuth) return {};
  const Scenario under = scenario(law);
  const std::array<MeasurementInformation, kChannels> information{MeasurementInformation(under.noise[0]),
                                                                  MeasurementInformation(under.noise[1]),
                                                                  MeasurementInformation(under.noise[2])};
  Problem one{Model(), campaign_.config.prior, {}, Vector<kChannels>::Constant(1 / std::sqrt(under.stated_factor))};
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

std::unique_ptr<System> makeUsblSystem(YamlSection& campaign, const std::string& folder,
                                       const usbl::FitterFactory& fitters) {
  return std::make_unique<UsblSystem>(campaign, folder, fitters);
}

}  // namespace sas_motion

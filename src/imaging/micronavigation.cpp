// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/micronavigation.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "imaging/micronavigation_steps.hpp"
#include "sas_motion/parallel/threads.hpp"

namespace sas_motion::imaging {
namespace {

constexpr int kEnvelopeRounds = 3, kPhaseRounds = 4;

/// One pair of pings during the search for its displacement; each step moves the second pose and its echoes.
class Displacement {
 public:
  Displacement(const EchoLines& lines, std::size_t ping, const SonarDescription& sonar, const BeamCoherence& beam,
               const PingPose& first, const PingPose& second, const MicronavigationOptions& options)
      : lines_(lines),
        line_(ping * static_cast<std::size_t>(sonar.receivers)),
        sonar_(sonar),
        beam_(beam),
        options_(options),
        pair_(sonar, first, second, options),
        predicted_(second.position),
        aligned_(align(lines, line_, sonar, pair_)) {}

  MicronavigationVerdict coarse() {
    const CoarseDisplacement found = searchDisplacement(aligned_, pair_, sonar_, options_);
    lag_ = found.lag;
    const Eigen::Vector3d sight = pair_.sight(middleRange(), 0);
    move(Eigen::Vector3d(found.along, found.sight * sight.dot(pair_.across), found.sight * sight.dot(pair_.down)), 0);
    for (int round = 0; round < kEnvelopeRounds; ++round) move(envelopeDisplacement(aligned_, pair_, lag_), 0);
    fit_.parameters << 0, 0, 0, 0, 0.9 * std::min(0.99, found.coherence), 0.9;
    return found.coherence < kLeastEnvelope ? MicronavigationVerdict::Incoherent : MicronavigationVerdict::Valid;
  }

  /// Moves to the optimum of the phase, and to another wavelength where the envelope fits that better.
  MicronavigationVerdict fine() {
    double wrap = 0;
    for (int round = 0; round < kPhaseRounds; ++round) {
      SpeckleParameters start = fit_.parameters;
      start.head<4>().setZero();
      fit_ = fitSpeckle(aligned_, pair_, sonar_, beam_, start);
      if (!fit_.parameters.allFinite() || fit_.parameters(kBetweenPings) < options_.min_coherence)
        return MicronavigationVerdict::Incoherent;
      move(fit_.parameters.head<3>(), fit_.parameters(kTurn));
      const Eigen::Vector3d sight = pair_.sight(middleRange(), 0);
      const Eigen::Vector3d envelope = envelopeDisplacement(aligned_, pair_, lag_);
      const double half = sonar_.wavelength() / 2;
      wrap = half * std::round((envelope.y() * sight.dot(pair_.across) + envelope.z() * sight.dot(pair_.down)) / half);
      if (wrap == 0 && fit_.converged && settled()) return MicronavigationVerdict::Valid;
      if (wrap != 0) move(Eigen::Vector3d(0, wrap * sight.dot(pair_.across), wrap * sight.dot(pair_.down)), 0);
    }
    if (wrap != 0) return MicronavigationVerdict::Ambiguous;
    return fit_.converged ? MicronavigationVerdict::Valid : MicronavigationVerdict::Incoherent;
  }

  Micronavigation result() const {
    Micronavigation result;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(acrossCovariance());
    Eigen::Vector2d u = axes.eigenvectors().col(0);  // the least variance
    if (u.x() + u.y() < 0) u = -u;
    const Eigen::Vector3d sight = u.x() * pair_.across + u.y() * pair_.down;
    const double range = (pair_.origin.z() - pair_.bottom) / -sight.z();
    const Eigen::Vector3d displacement = pair_.displacement(range);
    result.along = displacement.x();
    result.sight = u.dot(displacement.tail<2>());
    result.turn = sight.dot(pair_.poses[1].C_local_body.col(0) - pair_.poses[0].C_local_body.col(0));
    result.along_sigma = std::sqrt(fit_.covariance(kAlong, kAlong));
    result.sight_sigma = std::sqrt(axes.eigenvalues()(0));
    result.turn_sigma = std::sqrt(fit_.covariance(kTurn, kTurn));
    result.sight_body = pair_.C_local_body.transpose() * sight;
    result.correction_body = pair_.C_local_body.transpose() * (pair_.poses[1].position - predicted_);
    result.delay = range / sonar_.sound_speed;
    result.coherence = fit_.parameters(kBetweenPings);
    result.overlap = sonar_.receivers - static_cast<int>(std::lround(std::abs(result.along) / (sonar_.spacing / 2)));
    return result;
  }

  /// Whether four standard deviations of the envelope exceed a quarter of a wavelength.
  bool ambiguous(const Micronavigation& result) const {
    const double envelope_over_phase = std::sqrt(12.0) * sonar_.carrier / sonar_.bandwidth;
    return 4 * result.sight_sigma * envelope_over_phase > sonar_.wavelength() / 4;
  }

  bool overlaps() const {
    const double advance = std::abs(pair_.displacement(middleRange()).x()) / (sonar_.spacing / 2);
    return sonar_.receivers - std::lround(advance) >= options_.min_overlap;
  }

 private:
  static constexpr double kLeastEnvelope = 0.15;  // the coherence of noise is lower

  /// Covariance of the displacement across the track, on axes that turn by half of the array's turn.
  Eigen::Matrix2d acrossCovariance() const {
    const Eigen::Vector3d sight = pair_.sight(middleRange(), 0);
    Eigen::Matrix<double, 2, 3> jacobian;  // by kAcross, kDown, kTurn
    jacobian << Eigen::Matrix2d::Identity(),
        -0.5 * pair_.displacement(middleRange()).x() * Eigen::Vector2d(sight.dot(pair_.across), sight.dot(pair_.down));
    return jacobian * fit_.covariance.block<3, 3>(kAcross, kAcross) * jacobian.transpose();
  }

  double middleRange() const { return 0.5 * (sonar_.near_range + sonar_.far_range); }

  bool settled() const {
    return (fit_.parameters.head<4>().array().abs() < 0.1 * fit_.covariance.diagonal().head<4>().array().sqrt()).all();
  }

  /// Moves the second pose by `step` on the track's axes [m] and turns its fore end towards the sight [rad].
  void move(const Eigen::Vector3d& step, double turn) {
    PingPose second = pair_.poses[1];
    const Eigen::Vector3d lever_body = (sonar_.transmitter_body + sonar_.receiver_array_body) / 2,
                          lever = second.C_local_body * lever_body;
    const Eigen::Vector3d axis = pair_.forward.cross(pair_.sight(middleRange(), 0));
    second.C_local_body = Eigen::AngleAxisd(turn, axis) * second.C_local_body;
    second.position += step.x() * pair_.forward + step.y() * pair_.across + step.z() * pair_.down + lever -
                       second.C_local_body * lever_body;
    pair_ = PingPair(sonar_, pair_.poses[0], second, options_);
    aligned_ = align(lines_, line_, sonar_, pair_);
  }

  const EchoLines& lines_;
  std::size_t line_;
  const SonarDescription& sonar_;
  const BeamCoherence& beam_;
  const MicronavigationOptions& options_;
  PingPair pair_;
  Eigen::Vector3d predicted_;
  AlignedLines aligned_;
  SpeckleEstimate fit_;
  int lag_ = 0;
};

Micronavigation measure(const EchoLines& lines, std::size_t ping, const SonarDescription& sonar,
                        const BeamCoherence& beam, const PingPose& first, const PingPose& second,
                        const MicronavigationOptions& options) {
  const auto receivers = static_cast<std::size_t>(sonar.receivers);
  Micronavigation result;
  const auto refused = [&](MicronavigationVerdict verdict) {
    result.verdict = verdict;
    return result;
  };
  if (!lines.finite(ping * receivers, 2 * receivers)) return refused(MicronavigationVerdict::NotFinite);
  Displacement displacement(lines, ping, sonar, beam, first, second, options);
  if (!displacement.overlaps()) return refused(MicronavigationVerdict::NoOverlap);
  if (const auto verdict = displacement.coarse(); verdict != MicronavigationVerdict::Valid) return refused(verdict);
  if (const auto verdict = displacement.fine(); verdict != MicronavigationVerdict::Valid) return refused(verdict);
  result = displacement.result();
  return refused(displacement.ambiguous(result) ? MicronavigationVerdict::Ambiguous : MicronavigationVerdict::Valid);
}

void check(const EchoLines& lines, const SonarDescription& sonar, const MicronavigationOptions& options,
           std::size_t pings) {
  if (sonar.receivers < 2)
    throw std::invalid_argument("micronavigate: displaced phase centres take at least two receivers");
  if (lines.data.size() < pings * static_cast<std::size_t>(sonar.receivers) * static_cast<std::size_t>(lines.samples))
    throw std::invalid_argument("micronavigate: there are fewer lines than poses times receivers");
  const double least = kCoherentSamples * lines.sound_speed / lines.sample_rate / 2 + 3 * options.search;
  if (sonar.far_range - sonar.near_range < least)
    throw std::invalid_argument(fmt::format("micronavigate: takes a swath of at least {:.3g} m", least));
}

}  // namespace

const char* describe(MicronavigationVerdict verdict) {
  switch (verdict) {
    case MicronavigationVerdict::Valid: return "valid";
    case MicronavigationVerdict::NotFinite: return "an echo is not finite";
    case MicronavigationVerdict::NoOverlap: return "the pings share too few phase centres";
    case MicronavigationVerdict::Incoherent: return "the pings are too little alike";
    case MicronavigationVerdict::Ambiguous: return "the envelope does not tell the carrier's wavelengths apart";
  }
  return "";
}

Micronavigation micronavigate(const EchoLines& lines, std::size_t ping, const SonarDescription& sonar,
                              const PingPose& first, const PingPose& second, const MicronavigationOptions& options) {
  check(lines, sonar, options, ping + 2);
  return measure(lines, ping, sonar, BeamCoherence(sonar), first, second, options);
}

std::vector<Micronavigation> micronavigate(const EchoLines& lines, const SonarDescription& sonar,
                                           const std::vector<PingPose>& poses, const MicronavigationOptions& options) {
  check(lines, sonar, options, poses.size());
  std::vector<Micronavigation> results(poses.empty() ? 0 : poses.size() - 1);
  const BeamCoherence beam(sonar);
  forEachTask(results.size(), options.threads,
              [&](std::size_t i) { results[i] = measure(lines, i, sonar, beam, poses[i], poses[i + 1], options); });
  return results;
}

}  // namespace sas_motion::imaging

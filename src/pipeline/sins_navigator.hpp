// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <deque>
#include <optional>
#include <type_traits>

#include "sas_motion/filters/particles/particle_filter.hpp"
#include "sas_motion/filters/particles/simplex_blocks.hpp"
#include "sas_motion/filters/sigma_point_filter.hpp"
#include "sas_motion/pipeline/sins_estimator.hpp"
#include "sas_motion/pipeline/smooth_track.hpp"

namespace sas_motion::sins {

/// Mechanises the inertial unit, open loop, and estimates its errors with a particle filter.
///
/// Readings that aid are held until the inertial unit has come to their stamp; those before its last stamp are stale. DVL and depth of one stamp are
/// fused together.
template <int N, class Filter>
class Navigator final : public ins::Estimator {
 public:
  Navigator(Filter filter, const Config& config, bool smooth) : filter_(std::move(filter)), config_(config), smooth_(smooth) {}

  void start(const NavigationState& state, Stamp stamp) override {
    ins_.emplace(state, stamp, config_.imu);
    const auto belief = startBelief<N>(config_.parameters, state);
    if constexpr (std::is_same_v<Filter, ParticleFilter<N>>)
      filter_.start(belief);
    else
      filter_.start(belief, startBelief<N>(ofOneParticle(config_.parameters), state).covariance);
    filter_.replace([&](const Vector<N>& x) { return View<N>(state).constrained(x); });
    predicted_from_ = state;
    felt_ = {};
    mean_ = belief.mean;
    waiting_.clear();
    track_.emplace(state, SmoothTrack::Options{});
  }

  void process(const ins::Aiding& reading, ins::Output&) override { waiting_.push_back(reading); }

  ImuVerdict process(const ImuReading& reading, ins::Output& output) override {
    if (!ins_) return ImuVerdict::OutOfOrder;
    const ImuVerdict verdict = ins_->judge(reading);
    if (verdict == ImuVerdict::Implausible || verdict == ImuVerdict::OutOfOrder) return verdict;
    std::stable_sort(waiting_.begin(), waiting_.end(), [](const ins::Aiding& a, const ins::Aiding& b) { return a.stamp < b.stamp; });
    std::optional<Matrix<9>> covariance;
    while (!waiting_.empty() && waiting_.front().stamp <= reading.stamp) {
      const Together group = takeGroup();
      if (group.stamp < ins_->stamp()) {
        for (const auto& one : group.readings) report(one, Verdict::Stale, output);
        continue;
      }
      advance(reading, group.stamp);
      predict();
      fuse(group, output);
      if (group.stamp == reading.stamp) covariance = solutionCovariance();
    }
    advance(reading, reading.stamp);
    if (smooth_)
      output.solutions.push_back({ins_->stamp(), track_->state(), true, true, std::nullopt});
    else
      output.solutions.push_back({ins_->stamp(), fused(), true, true, covariance});
    return verdict;
  }

 private:
  static constexpr double kNotRead = 1e12;
  static constexpr double kNearlyLinear = 1 * kRadPerDeg;  // an attitude error over which one Gaussian does

  static Parameters ofOneParticle(Parameters parameters) {
    parameters.start_tilt = std::min(parameters.start_tilt, kNearlyLinear);
    parameters.start_heading = std::min(parameters.start_heading, kNearlyLinear);
    return parameters;
  }

  /// Readings of one stamp, of each sensor one at most.
  struct Together {
    Stamp stamp = 0;
    std::vector<ins::Aiding> readings;
    const ins::Aiding* of(ins::Sensor sensor) const {
      const auto found = std::find_if(readings.begin(), readings.end(), [&](const ins::Aiding& one) { return one.sensor == sensor; });
      return found == readings.end() ? nullptr : &*found;
    }
  };

  Together takeGroup() {
    Together group{waiting_.front().stamp, {}};
    while (!waiting_.empty() && waiting_.front().stamp == group.stamp && !group.of(waiting_.front().sensor)) {
      group.readings.push_back(waiting_.front());
      waiting_.pop_front();
    }
    return group;
  }

  void advance(const ImuReading& reading, Stamp stamp) {
    const double dt = secondsBetween(ins_->stamp(), stamp);
    ins_->advance(reading, stamp);
    if (!(dt > 0)) return;
    felt_.add(reading.rate_body, reading.force_body, dt);
    if (felt_.duration() > config_.longest_step - 1e-9) predict();
    if (smooth_) track_->move(fused(), dt);
  }

  void predict() {
    if (!(felt_.duration() > 0)) return;
    const Motion<N> motion(config_.parameters, predicted_from_, felt_);
    filter_.predict(motion, motion.noiseRoot());
    mean_ = motion(mean_);
    predicted_from_ = ins_->state();
    felt_ = {};
  }

  NavigationState fused() const { return View<N>(ins_->state()).corrected(meanNow()); }
  /// Between predictions the mean moves as the INS does.
  Vector<N> meanNow() const { return felt_.duration() > 0 ? Motion<N>(config_.parameters, predicted_from_, felt_)(mean_) : mean_; }

  /// DVL and depth in four rows; one that was not read has a variance that hides it.
  void fuse(const Together& group, ins::Output& output) {
    const View<N> view(ins_->state());
    const Parameters& p = config_.parameters;
    const auto h = [&](const Vector<N>& x) -> Vector<4> { return (Vector<4>() << view.dvl(x, Vector<3>::Zero()), view.height(x)).finished(); };
    Vector<4> z = h(mean_), variance = Vector<4>::Constant(kNotRead);
    if (const auto* dvl = group.of(ins::Sensor::Dvl)) {
      z.head<3>() = dvl->velocity_body;
      variance.head<3>() = p.dvl_white.cwiseAbs2();
    }
    if (const auto* depth = group.of(ins::Sensor::Depth)) {
      z(3) = depth->fix.height;
      variance(3) = p.depth_white * p.depth_white;
    }
    const auto update = filter_.template update<4>(z, h, Matrix<4>(variance.asDiagonal()));
    filter_.replace([&](const Vector<N>& x) { return view.constrained(x); });
    mean_ = filter_.mean();
    if (smooth_) track_->jump(fused());
    for (const auto& one : group.readings) output.audits.push_back(auditOf(one, update));
  }

  static ins::Audit auditOf(const ins::Aiding& reading, const ParticleUpdate<4>& update) {
    ins::Audit audit{reading.stamp, reading.sensor, Verdict::Invalid};
    if (reading.sensor == ins::Sensor::Gps) return audit;  // this system has none
    const int rows = rowsOf(reading.sensor), first = reading.sensor == ins::Sensor::Dvl ? 0 : 3;
    const Eigen::VectorXd innovation = update.innovation.segment(first, rows);
    audit.verdict = update.verdict;
    audit.nis = innovation.dot(update.S.block(first, first, rows, rows).llt().solve(innovation));
    audit.weights.head(rows) = update.weights.segment(first, rows);
    audit.effective_size = update.effective_size;
    return audit;
  }
  static void report(const ins::Aiding& reading, Verdict verdict, ins::Output& output) { output.audits.push_back({reading.stamp, reading.sensor, verdict}); }

  Matrix<9> solutionCovariance() const {
    const Gaussian<N> belief = filter_.belief();
    const Matrix<9, N> T = View<N>(ins_->state()).solutionByError(belief.mean);
    return T * belief.covariance * T.transpose();
  }

  Filter filter_;
  Config config_;
  std::optional<Mechanisation> ins_;
  NavigationState predicted_from_;  // the INS at the filter's last prediction
  Preintegration felt_;             // since then
  Vector<N> mean_ = Vector<N>::Zero();
  std::deque<ins::Aiding> waiting_;
  bool smooth_;
  std::optional<SmoothTrack> track_;
};

constexpr double kCentreWeight = 0.2;  // of the simplex

/// Explicitly instantiated, each in a file of its own.
template <int N>
std::unique_ptr<ins::Estimator> makeNavigator(const NamedFilter& named, const Config& config) {
  UnscentedParticleOptions options = config.particles;
  options.weighting = named.weighting;
  if (named.alone) options.particles = 1;
  if (named.robust) options.loss = Loss(LossKind::Cauchy);
  const auto navigator = [&](auto filter) -> std::unique_ptr<ins::Estimator> {
    return std::make_unique<Navigator<N, decltype(filter)>>(std::move(filter), config, named.smooth);
  };
  switch (named.kind) {
    case FilterKind::Bootstrap: return navigator(ParticleFilter<N>(options));
    case FilterKind::Unscented: return navigator(UnscentedParticleFilter(OneByOne(UnscentedKalmanFilter<N>(unscentedPoints<N>({1, 0, 1}))), options));
    case FilterKind::SquareRoot: return navigator(UnscentedParticleFilter(SimplexBlocks<N>(simplexPoints<N>(kCentreWeight), config.vectorised), options));
  }
  return nullptr;
}

}  // namespace sas_motion::sins

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <deque>
#include <memory>
#include <optional>
#include <type_traits>

#include "sas_motion/filters/particles/particle_filter.hpp"
#include "sas_motion/filters/particles/simplex_blocks.hpp"
#include "sas_motion/filters/sigma_point_filter.hpp"
#include "sas_motion/navigation/bridged_gap.hpp"
#include "sas_motion/navigation/steady_track.hpp"
#include "sas_motion/systems/ins_gps_dvl/alignment.hpp"
#include "sas_motion/systems/sins_dvl/estimator.hpp"

namespace sas_motion::sins {

/// Mechanises the IMU, open loop, and estimates its errors with a particle filter.
///
/// Readings that aid are held until the IMU has come to their stamp; those before its last stamp are stale.
/// DVL and depth of one stamp are fused together. The covariance of a solution is that of the filter's last step. A
/// copy shares the particles until either changes them.
template <int N, class Filter>
class Navigator final : public ins::Estimator {
 public:
  Navigator(Filter filter, const Config& config, bool steady)
      : filter_(std::make_shared<Filter>(std::move(filter))), config_(config), steady_(steady) {}

  void start(const NavigationState& state, Stamp stamp) override {
    ins_.emplace(state, stamp, config_.imu);
    Filter& filter = ownFilter();
    const auto belief = startBelief<N>(config_.parameters, state);
    const bool started = [&] {
      if constexpr (std::is_same_v<Filter, ParticleFilter<N>>)
        return filter.start(belief);
      else
        return filter.start(belief, startBelief<N>(ofOneParticle(config_.parameters), state).covariance);
    }();
    if (!started) return ins_.reset();  // no covariance to draw from: all readings of the IMU are out of order then
    filter.replace([&](const Vector<N>& x) { return View<N>(state).constrained(x); });
    predicted_from_ = state;
    preintegrated_ = {};
    gap_variance_.setZero();
    mean_ = belief.mean;
    covariance_ = covarianceOf(belief);
    waiting_.clear();
    track_.emplace(state, SteadyTrack::Options{});
  }

  std::unique_ptr<ins::Estimator> clone() const override { return std::make_unique<Navigator>(*this); }

  void process(const ins::Aiding& reading, ins::Output&) override { waiting_.push_back(reading); }

  ImuVerdict process(const ImuReading& reading, ins::Output& output) override {
    if (!ins_) return ImuVerdict::OutOfOrder;
    const ImuVerdict verdict = ins_->judge(reading);
    if (verdict == ImuVerdict::Implausible || verdict == ImuVerdict::OutOfOrder) return verdict;
    std::stable_sort(waiting_.begin(), waiting_.end(),
                     [](const ins::Aiding& a, const ins::Aiding& b) { return a.stamp < b.stamp; });
    const double gap = verdict == ImuVerdict::Bridged ? secondsBetween(ins_->stamp(), reading.stamp) : 0;
    while (!waiting_.empty() && waiting_.front().stamp <= reading.stamp) {
      const Together group = takeGroup();
      if (group.stamp < ins_->stamp()) {
        for (const auto& one : group.readings)
          output.audits.push_back(ins::refusal(one, Verdict::Stale, "older than the IMU's last reading"));
        continue;
      }
      advance(reading, group.stamp, gap);
      fuse(group, output);
    }
    advance(reading, reading.stamp, gap);
    if (!steady_ && !covariance_) covariance_ = covarianceOf(filter_->belief());
    if (steady_)
      output.solutions.push_back({ins_->stamp(), track_->state(), true, true, std::nullopt, rateOverGround()});
    else
      output.solutions.push_back({ins_->stamp(), fused(), true, true, covariance_, rateOverGround()});
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
      const auto found =
          std::find_if(readings.begin(), readings.end(), [&](const ins::Aiding& one) { return one.sensor == sensor; });
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

  void advance(const ImuReading& reading, Stamp stamp, double gap) {
    const double dt = secondsBetween(ins_->stamp(), stamp);
    ins_->advance(reading, stamp);
    if (!(dt > 0)) return;
    preintegrated_.add(reading.rate_body, reading.force_body, dt);
    if (gap > 0) gap_variance_ += BridgedGap{}.variance(gap, dt);
    if (gap > 0 || preintegrated_.duration() > config_.longest_step - 1e-9) predict();
    if (steady_) track_->move(fused(), dt);
  }

  void predict() {
    if (!(preintegrated_.duration() > 0)) return;
    const Motion<N> motion(config_.parameters, predicted_from_, preintegrated_);
    const Vector<3> turned = gap_variance_.tail<3>();
    gap_variance_.tail<3>() = turned.cwiseMin(kNearlyLinear * kNearlyLinear);
    ownFilter().predict(motion, motion.noiseRoot(gap_variance_));
    mean_ = motion(mean_);
    predicted_from_ = ins_->state();
    if (turned != gap_variance_.tail<3>()) roughen(turned - gap_variance_.tail<3>());
    preintegrated_ = {};
    gap_variance_.setZero();
    covariance_.reset();
  }

  /// What one Gaussian would be too wide for is shared out among all.
  void roughen(const Vector<3>& turned) {
    Filter& filter = ownFilter();
    filter.roughen(turnRoot<N>(predicted_from_, turned));
    filter.replace([&](const Vector<N>& x) { return View<N>(predicted_from_).constrained(x); });
  }

  NavigationState fused() const { return View<N>(ins_->state()).corrected(meanNow()); }
  /// Between predictions the mean moves as the INS does.
  Vector<N> meanNow() const {
    return preintegrated_.duration() > 0 ? Motion<N>(config_.parameters, predicted_from_, preintegrated_)(mean_)
                                         : mean_;
  }
  Vector<3> rateOverGround() const { return ins::rateOverGround(ins_->state(), ins_->rate_body()); }

  /// DVL and depth in four rows; one that was not read has a variance that hides it.
  void fuse(const Together& group, ins::Output& output) {
    for (const auto& one : group.readings)
      if (!fuses(one.sensor))
        output.audits.push_back(ins::refusal(one, Verdict::Invalid, "this system does not fuse it"));
    const auto *dvl = group.of(ins::Sensor::Dvl), *depth = group.of(ins::Sensor::Depth);
    if (!dvl && !depth) return;
    predict();
    const View<N> view(ins_->state());
    Parameters& p = config_.parameters;
    Vector<4> z = Vector<4>::Zero(), variance = Vector<4>::Constant(kNotRead);
    if (dvl) {
      p.dvl_lever_body = dvl->lever_body.value_or(p.dvl_lever_body);
      z.head<3>() = dvl->velocity_body;
      variance.head<3>() = dvl->variance.value_or(p.dvl_white.cwiseAbs2());
    }
    if (depth) {
      p.depth_lever_body = depth->lever_body.value_or(p.depth_lever_body);
      z(3) = depth->fix.height;
      variance(3) = depth->variance ? depth->variance->x() : p.depth_white * p.depth_white;
    }
    const Vector<3> turning_body = rateOverGround().cross(p.dvl_lever_body);
    const auto h = [&](const Vector<N>& x) -> Vector<4> {
      return (Vector<4>() << view.dvl(x, turning_body), view.height(x, p.depth_lever_body)).finished();
    };
    const Vector<4> expected = h(mean_);
    if (!dvl) z.head<3>() = expected.head<3>();
    if (!depth) z(3) = expected(3);
    Filter& filter = ownFilter();
    const auto update = filter.template update<4>(z, h, Matrix<4>(variance.asDiagonal()));
    filter.replace([&](const Vector<N>& x) { return view.constrained(x); });
    mean_ = filter.mean();
    covariance_.reset();
    if (steady_) track_->jump(fused());
    for (const auto& one : group.readings)
      if (fuses(one.sensor)) output.audits.push_back(auditOf(one, update));
  }

  static bool fuses(ins::Sensor sensor) { return sensor == ins::Sensor::Dvl || sensor == ins::Sensor::Depth; }

  Audit auditOf(const ins::Aiding& reading, const ParticleUpdate<4>& update) const {
    const int rows = rowsOf(reading.sensor), first = reading.sensor == ins::Sensor::Dvl ? 0 : 3;
    Audit audit{reading.stamp, sensorName(reading.sensor), rows, update.verdict};
    audit.innovation.head(rows) = update.innovation.segment(first, rows);
    audit.S.topLeftCorner(rows, rows) = update.S.block(first, first, rows, rows);
    const bool readable = update.innovation.allFinite() && update.S.allFinite();
    if (!readable) {
      audit.innovation.setZero();
      audit.S.setIdentity();
    }
    audit.nis =
        audit.innovation.head(rows).dot(audit.S.topLeftCorner(rows, rows).llt().solve(audit.innovation.head(rows)));
    audit.weights.head(rows) = update.weights.segment(first, rows);
    if (filter_->particles().size() > 1) audit.effective_size = update.effective_size;
    if (update.verdict == Verdict::Invalid)
      audit.reason =
          readable ? "no particle explains it; all are kept" : "not finite, or read together with what is not";
    return audit;
  }

  Matrix<9> covarianceOf(const Gaussian<N>& belief) const {
    const Matrix<9, N> T = View<N>(predicted_from_).solutionByError(belief.mean);
    return T * belief.covariance * T.transpose();
  }

  Filter& ownFilter() {
    if (filter_.use_count() > 1) filter_ = std::make_shared<Filter>(*filter_);
    return *filter_;
  }

  std::shared_ptr<Filter> filter_;
  Config config_;
  std::optional<Mechanisation> ins_;
  NavigationState predicted_from_;              // the INS at the filter's last prediction
  Preintegration preintegrated_;                // since then
  Vector<9> gap_variance_ = Vector<9>::Zero();  // likewise, of gaps of the IMU
  Vector<N> mean_ = Vector<N>::Zero();
  std::optional<Matrix<9>> covariance_;  // of the solution
  std::deque<ins::Aiding> waiting_;
  bool steady_;
  std::optional<SteadyTrack> track_;
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
    return std::make_unique<Navigator<N, decltype(filter)>>(std::move(filter), config, named.steady);
  };
  switch (named.kind) {
    case FilterKind::Bootstrap: return navigator(ParticleFilter<N>(options));
    case FilterKind::Unscented:
      return navigator(
          UnscentedParticleFilter(OneByOne(UnscentedKalmanFilter<N>(unscentedPoints<N>({1, 0, 1}))), options));
    case FilterKind::SquareRoot:
      return navigator(
          UnscentedParticleFilter(SimplexBlocks<N>(simplexPoints<N>(kCentreWeight), config.vectorised), options));
  }
  return nullptr;
}

}  // namespace sas_motion::sins

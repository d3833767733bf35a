// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/ins_gps_dvl/aligned_estimator.hpp"

#include <algorithm>

namespace sas_motion::ins {
namespace {

constexpr double kFurthest = 1;  // beyond the newest reading of the IMU that a state is predicted to [s]

}  // namespace

AlignedEstimator::AlignedEstimator(const SessionOptions& options, const std::string& name, EstimatorFactory make)
    : options_(std::make_shared<SessionOptions>(options)),
      name_(name),
      make_(std::move(make)),
      alignment_(options.alignment, options.config.parameters) {}

AlignedEstimator::AlignedEstimator(const AlignedEstimator& other)
    : options_(other.options_),
      name_(other.name_),
      make_(other.make_),
      alignment_(other.alignment_),
      estimator_(other.estimator_ ? other.estimator_->clone() : nullptr),
      last_(other.last_) {}

std::unique_ptr<InOrder> AlignedEstimator::clone() const {
  auto copy = std::make_unique<AlignedEstimator>(*this);
  return copy->estimator_ ? std::move(copy) : nullptr;
}

void AlignedEstimator::process(const Reading& reading, Output& output) {
  events_.clear();
  alignment_.take(reading, events_);
  for (const auto& event : events_) take(event, output);
}

void AlignedEstimator::take(const Event& event, Output& output) {
  if (const auto* audit = std::get_if<Audit>(&event)) {
    output.audits.push_back(*audit);
  } else if (const auto* start = std::get_if<Start>(&event)) {
    begin(*start, output);
  } else if (const auto* aiding = std::get_if<Aiding>(&event)) {
    estimator_->process(*aiding, output);
    ++measurements_;
  } else {
    last_ = std::get<ImuReading>(event);
    count(*last_, estimator_->process(*last_, output));
  }
}

void AlignedEstimator::begin(const Start& start, Output& output) {
  finish(output);
  Config config = options_->config;
  config.parameters = start.parameters;
  estimator_ = make_(name_, config);
  estimator_->start(start.state, start.stamp);
  last_integrated_.reset();
}

void AlignedEstimator::finish(Output& output) {
  if (estimator_) estimator_->finish(output);
}

void AlignedEstimator::startAnew(Output& output) {
  finish(output);
  estimator_.reset();
  last_.reset();
  alignment_ = Alignment(options_->alignment, options_->config.parameters);
}

void AlignedEstimator::setState(const Start& start, Output& output) { begin(start, output); }

void AlignedEstimator::configure(const Config& config) {
  auto options = std::make_shared<SessionOptions>(*options_);
  options->config = config;
  options_ = std::move(options);
  if (estimator_) estimator_->configure(config);
}

std::optional<NavigationSolution> AlignedEstimator::predictedTo(Stamp stamp, const Reading* next) {
  const auto* inertial = next ? std::get_if<InertialReading>(next) : nullptr;
  const ImuReading* means = inertial ? &inertial->imu : last_ ? &*last_ : nullptr;
  if (!means || secondsBetween(means->stamp, stamp) > kFurthest) return std::nullopt;
  Output output;
  estimator_->process(ImuReading{stamp, means->rate_body, means->force_body}, output);
  if (output.solutions.empty() || output.solutions.back().stamp != stamp) return std::nullopt;
  return output.solutions.back();
}

void AlignedEstimator::count(const ImuReading& reading, ImuVerdict verdict) {
  ++inertial_.verdicts[static_cast<std::size_t>(verdict)];
  if (verdict == ImuVerdict::OutOfOrder || verdict == ImuVerdict::Implausible) return;
  if (last_integrated_) {
    const double dt = secondsBetween(*last_integrated_, reading.stamp);
    inertial_.longest_gap = std::max(inertial_.longest_gap, dt);
    inertial_.mean_period += (dt - inertial_.mean_period) / static_cast<double>(++intervals_);
  }
  last_integrated_ = reading.stamp;
}

}  // namespace sas_motion::ins

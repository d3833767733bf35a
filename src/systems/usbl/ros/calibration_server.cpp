// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/usbl/ros/calibration_server.hpp"

#include <fmt/format.h>
#include <sas_motion/FilterUpdate.h>
#include <sas_motion/UsblCalibration.h>

#include <algorithm>

#include "ros/solution_messages.hpp"
#include "ros/system_run.hpp"
#include "sas_motion/io/atomic_file.hpp"
#include "systems/usbl/graph/batch.hpp"
#include "systems/usbl/ros/calibration_result.hpp"

namespace sas_motion::ros_side {
namespace {

constexpr double kDiagnosticPeriod = 1;  // [s, wall]

FilterUpdate updateOf(const usbl::Ping& ping, const usbl::Calibrator::Report& report) {
  Audit audit{ping.stamp, "usbl", usbl::kChannels, report.verdict};
  audit.innovation = report.innovation;
  audit.S = report.S;
  audit.nis = report.nis;
  audit.weights = report.weights;
  audit.iterations = report.iterations;
  return ros_side::updateOf(audit);
}

}  // namespace

CalibrationServer::CalibrationServer(const ros::NodeHandle& node, const ros::NodeHandle& own)
    : node_(node), names_{"hvbckf"} {
  std::string config;
  double tolerance_deg = tolerance_.angle / kRadPerDeg;
  readParameter(own, "config", config);
  settings_ = UsblSettings::fromFile(config);
  readParameter(own, "estimators", names_);
  if (names_.empty()) throw std::invalid_argument("~estimators is empty; name at least one filter, such as hvbckf");
  readParameter(own, "tolerance_deg", tolerance_deg);
  tolerance_.angle = tolerance_deg * kRadPerDeg;
  readParameter(own, "tolerance", tolerance_.lever_arm);
  readParameter(own, "output", output_);
  readParameter(own, "transform_wait", transform_wait_);
  readParameter(own, "most_pings", most_pings_);
  beginAnew();

  listener_ = std::make_unique<tf2_ros::TransformListener>(transforms_, node_);
  subscribe<sensor_msgs::NavSatFix>(settings_.fix_topic, &UsblIngest::takeFix);
  subscribe<sensor_msgs::NavSatFix>(settings_.transponder_topic, &UsblIngest::takeTransponder, false);
  subscribe<sensor_msgs::Imu>(settings_.imu_topic, &UsblIngest::take);
  subscribe<UsblMeasurement>(settings_.measurement_topic, &UsblIngest::take);

  ros::NodeHandle services(own);
  services_.push_back(services.advertiseService("save", &CalibrationServer::onSave, this));
  services_.push_back(services.advertiseService("reset", &CalibrationServer::onReset, this));
  updater_ = makeUpdater(node_, own, "calibration", this, &CalibrationServer::diagnose);
  timer_ = ros::NodeHandle(own).createWallTimer(ros::WallDuration(kDiagnosticPeriod),
                                                [this](const ros::WallTimerEvent&) { updater_->force_update(); });
}

template <class Message>
void CalibrationServer::subscribe(const std::string& topic, void (UsblIngest::*take)(const Message&), bool has_frame) {
  const auto handler = [=](const typename Message::ConstPtr& m) {
    receive(has_frame ? m->header.frame_id : "", [=] { (ingest_.get()->*take)(*m); });
  };
  subscribers_.push_back(node_.subscribe<Message>(topic, kQueue, handler, {}, ros::TransportHints().tcpNoDelay()));
}

void CalibrationServer::beginAnew() {
  std::map<std::uint32_t, Geodetic> surveyed;
  if (ingest_) surveyed = ingest_->builder().transponders();
  ingest_ = std::make_unique<UsblIngest>(settings_, transforms_);
  for (const auto& [id, position] : surveyed) ingest_->builder().addTransponder(id, position);  // latched: sent once
  if (lanes_.empty())
    for (const auto& name : names_)
      lanes_.push_back({name, usbl::Calibrator(name, settings_.calibration),
                        node_.advertise<UsblCalibration>(name + "/calibration", kQueue, true),
                        node_.advertise<FilterUpdate>(name + "/update", kQueue)});
  for (auto& lane : lanes_) lane.calibrator = usbl::Calibrator(lane.name, settings_.calibration);
  pings_.clear();
  information_.setZero();
  observability_ = usbl::observability(information_, settings_.calibration.prior, 0);
}

void CalibrationServer::receive(const std::string& frame, std::function<void()> handler) {
  if (!ready_) {
    if (first_message_.isZero()) first_message_ = ros::WallTime::now();
    if (!frame.empty() && std::find(frames_.begin(), frames_.end(), frame) == frames_.end()) frames_.push_back(frame);
    waiting_.push_back(std::move(handler));
    if (!transformsReady()) return;
    ready_ = true;
    for (const auto& each : waiting_) each();
    waiting_.clear();
  } else {
    handler();
  }
  for (const auto& ping : ingest_->builder().take()) process(ping);
}

/// The array usually has no transform, but a nominal one must not be missed.
bool CalibrationServer::transformsReady() {
  if ((ros::WallTime::now() - first_message_).toSec() > transform_wait_) return true;
  return frames_.size() >= 3 && std::all_of(frames_.begin(), frames_.end(), [&](const std::string& frame) {
           return transforms_.canTransform(settings_.base_frame, frame, ros::Time(0));
         });
}

void CalibrationServer::process(const usbl::Ping& ping) {
  if (pings_.size() < static_cast<std::size_t>(most_pings_)) pings_.push_back(ping);
  for (auto& lane : lanes_) publish(lane, ping, lane.calibrator.process(ping));
  const auto& first = lanes_.front().calibrator;
  usbl::Problem one{
      usbl::Model(settings_.calibration.mode), settings_.calibration.prior, {ping}, first.noiseFactor().cwiseSqrt()};
  one.pings[0].reading = one.model.convert(ping.reading);
  information_ += usbl::information(one, usbl::Model::widened(first.belief().mean));
  observability_ = usbl::observability(information_, settings_.calibration.prior, observability_.pings + 1);
}

void CalibrationServer::publish(Lane& lane, const usbl::Ping& ping, const usbl::Calibrator::Report& report) {
  const auto& belief = lane.calibrator.belief();
  UsblCalibration message;
  message.header.stamp = timeOf(ping.stamp);
  message.header.frame_id = settings_.base_frame;
  message.child_frame_id = ingest_->arrayFrame();
  message.transform = messageOf(transformOf(usbl::corrected(ingest_->builder().nominal(), belief.mean)));
  std::copy(belief.mean.data(), belief.mean.data() + usbl::kStates, message.correction.begin());
  std::copy(belief.covariance.data(), belief.covariance.data() + belief.covariance.size(), message.covariance.begin());
  const Vector<usbl::kChannels> noise = lane.calibrator.noiseFactor().cwiseSqrt();
  std::copy(noise.data(), noise.data() + usbl::kChannels, message.noise.begin());
  message.started = lane.calibrator.started();
  message.observable = observability_.observable;
  message.within_tolerance = withinTolerance(lane.calibrator);
  message.verdict = observability_.verdict;
  message.pings = static_cast<std::uint32_t>(observability_.pings + 1);
  message.lock_ins = static_cast<std::uint32_t>(lane.calibrator.lockIns());
  lane.calibration.publish(message);
  if (message.started) lane.update.publish(updateOf(ping, report));
}

bool CalibrationServer::withinTolerance(const usbl::Calibrator& calibrator) const {
  const usbl::State sigma = calibrator.belief().covariance.diagonal().cwiseSqrt();
  return calibrator.started() && observability_.observable && 3 * sigma.head<3>().maxCoeff() <= tolerance_.angle &&
         3 * sigma.tail<3>().maxCoeff() <= tolerance_.lever_arm;
}

void CalibrationServer::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const auto& first = lanes_.front().calibrator;
  if (!first.started())
    status.summary(DiagnosticStatus::WARN,
                   observability_.pings == 0 ? "no ping yet" : "starting: the first minute is fitted together");
  else if (!observability_.observable)
    status.summary(DiagnosticStatus::WARN, observability_.verdict);
  else if (!withinTolerance(first))
    status.summary(DiagnosticStatus::OK, "converging: not yet within the tolerance");
  else
    status.summary(DiagnosticStatus::OK, "within the tolerance: ~save writes the calibration");
  const usbl::State sigma = first.belief().covariance.diagonal().cwiseSqrt();
  for (int i = 0; i < usbl::kStates; ++i) {
    status.addf(usbl::unknownNames()[i] + fmt::format(" [{}]", tableUnit(i)), "%.4f +- %.4f",
                inTableUnit(i, first.belief().mean(i)), inTableUnit(i, 3 * sigma(i)));
  }
  status.addf("pings", "%zu", observability_.pings);
  status.addf("measurements", "%lu", ingest_->builder().readings());
  for (int i = 0; i < usbl::kOmissions; ++i) {
    const auto omission = static_cast<usbl::Omission>(i);
    if (ingest_->builder().omitted(omission) > 0)
      status.addf("measurements " + usbl::omissionText(omission), "%lu", ingest_->builder().omitted(omission));
  }
  for (const auto& frame : ingest_->counts().frames)
    status.mergeSummary(DiagnosticStatus::ERROR,
                        fmt::format("frame {} has no transform to {}", frame, settings_.base_frame));
  for (const auto& lane : lanes_) status.addf(lane.name + " lock-ins", "%d", lane.calibrator.lockIns());
}

bool CalibrationServer::onSave(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  try {
    if (pings_.empty()) throw std::runtime_error("there is no ping yet, so nothing to save");
    CalibrationResult result;
    result.bag = "live";
    result.settings = settings_;
    result.recording.pings = pings_;
    result.recording.takeSummary(*ingest_);
    result.comparison = usbl::compare(pings_, settings_.calibration, names_, usbl::makeFitter);
    if (!result.comparison.failure.empty()) throw std::runtime_error(result.comparison.failure);
    writeFile(output_, calibrationDocument(result));
    response.success = result.comparison.trusted() ? 1 : 0;
    response.message = fmt::format("{} written; {}", output_, result.conclusion());
  } catch (const std::exception& error) {
    response.success = 0;
    response.message = error.what();
  }
  return true;
}

bool CalibrationServer::onReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  beginAnew();
  response.success = 1;
  response.message = "begun anew";
  return true;
}

}  // namespace sas_motion::ros_side

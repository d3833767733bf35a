// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtsam/geometry/Point3.h>

#include <cmath>

#include "graph/loss_estimator.hpp"
#include "sas_motion/math/angles.hpp"
#include "sas_motion/navigation/attitude.hpp"
#include "systems/usbl/graph/batch.hpp"

namespace sas_motion::usbl {

int firstUnknown(gtsam::Key key) { return 3 * static_cast<int>(key); }
int countUnknowns(gtsam::Key key) { return key == kRangeScaleKey ? 1 : 3; }

gtsam::KeyVector keysOf(const Prior& prior) {
  gtsam::KeyVector keys;
  for (const gtsam::Key key : {kMountingKey, kLeverKey, kTransponderKey, kRangeScaleKey}) {
    const auto* first = prior.estimated.data() + firstUnknown(key);
    if (std::find(first, first + countUnknowns(key), true) != first + countUnknowns(key)) keys.push_back(key);
  }
  return keys;
}

gtsam::Values valuesFrom(const Prior& prior, const Unknowns& x) {
  gtsam::Values values;
  for (const gtsam::Key key : keysOf(prior)) {
    if (key == kMountingKey)
      values.insert(key, gtsam::Rot3(mountingRotation(x.head<3>())));
    else if (key == kRangeScaleKey)
      values.insert(key, x(kRangeScale));
    else
      values.insert(key, gtsam::Point3(x.segment<3>(firstUnknown(key))));
  }
  return values;
}

Unknowns unknownsFrom(const gtsam::Values& values, const Unknowns& known) {
  Unknowns x = known;
  if (values.exists(kMountingKey)) x.head<3>() = mountingAngles(values.at<gtsam::Rot3>(kMountingKey));
  for (const gtsam::Key key : {kLeverKey, kTransponderKey})
    if (values.exists(key)) x.segment<3>(firstUnknown(key)) = values.at<gtsam::Point3>(key);
  if (values.exists(kRangeScaleKey)) x(kRangeScale) = values.at<double>(kRangeScaleKey);
  return x;
}

Vector<3> mountingAngles(const gtsam::Rot3& rotation) {
  const Attitude attitude = attitudeOf(rotation.matrix());
  return {attitude.pitch, attitude.roll, attitude.heading};
}

Matrix<3> mountingAnglesJacobian(const Vector<3>& angles) {
  const double cp = std::cos(angles(0)), sp = std::sin(angles(0)), cr = std::cos(angles(1)), sr = std::sin(angles(1));
  Matrix<3> rate;  // w of the angles' rates: the body rate of pitch, roll and heading
  rate << cr, 0, sr * cp, 0, 1, -sp, sr, 0, -cr * cp;
  return rate.inverse();
}

ChannelFactor::ChannelFactor(const Problem& problem, const Ping& ping, int channel, const Loss& loss,
                             const Unknowns& known)
    : NoiseModelFactor(robustNoise(loss, problem.scale(channel) * std::sqrt(ping.reading.variance(channel))),
                       keysOf(problem.prior)),
      model_(problem.model),
      ping_(ping),
      channel_(channel),
      known_(known) {}

gtsam::Vector ChannelFactor::unwhitenedError(const gtsam::Values& values,
                                             boost::optional<std::vector<gtsam::Matrix>&> H) const {
  const Unknowns x = unknownsFrom(values, known_);
  if (H) {
    Matrix<1, kUnknowns> row = model_.jacobian(x, ping_).row(channel_);
    // R Exp(w) turns the direction p in the array by p x w; dh/dp stands in the lever arm's columns as -dh/dp R^T.
    const Vector<3> p = transponderInArray(x, ping_);
    const Vector<3> gradient = -mountingRotation(x.head<3>()).transpose() * row.segment<3>(kLeverX).transpose();
    row.head<3>() = gradient.cross(p).transpose();
    for (std::size_t i = 0; i < keys().size(); ++i)
      (*H)[i] = row.segment(firstUnknown(keys()[i]), countUnknowns(keys()[i]));
  }
  return gtsam::Vector1(model_.difference(model_.predict(x, ping_), ping_.reading.value)(channel_));
}

gtsam::SharedNoiseModel priorNoise(const Prior& prior, gtsam::Key key) {
  gtsam::Vector sigmas = prior.sigma.segment(firstUnknown(key), countUnknowns(key));
  for (int i = 0; i < countUnknowns(key); ++i)
    if (!prior.estimated[static_cast<std::size_t>(firstUnknown(key) + i)]) sigmas(i) = 0;
  return gtsam::noiseModel::Diagonal::Sigmas(sigmas);
}

MountingPriorFactor::MountingPriorFactor(const Prior& prior)
    : NoiseModelFactor1(priorNoise(prior, kMountingKey), kMountingKey), mean_(prior.mean.head<3>()) {}

gtsam::Vector MountingPriorFactor::evaluateError(const gtsam::Rot3& rotation, boost::optional<gtsam::Matrix&> H) const {
  const Vector<3> angles = mountingAngles(rotation);
  if (H) *H = mountingAnglesJacobian(angles);
  return (angles - mean_).unaryExpr(&wrapAngle);
}

}  // namespace sas_motion::usbl

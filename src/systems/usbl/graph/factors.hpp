// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtsam/geometry/Rot3.h>
#include <gtsam/nonlinear/NonlinearFactor.h>

#include <boost/make_shared.hpp>

#include "sas_motion/systems/usbl/problem.hpp"

namespace sas_motion::usbl {

/// The unknowns as variables of a factor graph; one of which nothing is estimated is left out.
constexpr gtsam::Key kMountingKey = 0;     ///< Rot3: v_body = R v_array
constexpr gtsam::Key kLeverKey = 1;        ///< Point3 [m]
constexpr gtsam::Key kTransponderKey = 2;  ///< Point3 [m]
constexpr gtsam::Key kRangeScaleKey = 3;   ///< double [-]

/// The keys whose variables a prior leaves something to estimate of, in rising order.
gtsam::KeyVector keysOf(const Prior& prior);
/// The first of the unknowns that a variable holds, and how many.
int firstUnknown(gtsam::Key key);
int countUnknowns(gtsam::Key key);

/// The variables at x.
gtsam::Values valuesFrom(const Prior& prior, const Unknowns& x);
/// The unknowns of a graph's variables; what it has no variable for is as in `known`.
Unknowns unknownsFrom(const gtsam::Values& values, const Unknowns& known);

/// The mounting angles of a rotation.
Vector<3> mountingAngles(const gtsam::Rot3& rotation);
/// Their change with the rotation R Exp(w), d angles / dw.
Matrix<3> mountingAnglesJacobian(const Vector<3>& angles);

/// One channel of a ping under a loss: error h(x) - z. A factor a channel, since GTSAM gives a vector factor one
/// weight.
class ChannelFactor final : public gtsam::NoiseModelFactor {
 public:
  /// `known` holds the unknowns that the graph has no variable for.
  ChannelFactor(const Problem& problem, const Ping& ping, int channel, const Loss& loss, const Unknowns& known);
  gtsam::Vector unwhitenedError(const gtsam::Values& values,
                                boost::optional<std::vector<gtsam::Matrix>&> H = boost::none) const override;
  gtsam::NonlinearFactor::shared_ptr clone() const override { return boost::make_shared<ChannelFactor>(*this); }

 private:
  Model model_;
  Ping ping_;
  int channel_;
  Unknowns known_;
};

/// The prior on the mounting: its error is in the angles, as the prior is; an angle that is known is held.
class MountingPriorFactor final : public gtsam::NoiseModelFactor1<gtsam::Rot3> {
 public:
  explicit MountingPriorFactor(const Prior& prior);
  gtsam::Vector evaluateError(const gtsam::Rot3& rotation, boost::optional<gtsam::Matrix&> H) const override;
  gtsam::NonlinearFactor::shared_ptr clone() const override { return boost::make_shared<MountingPriorFactor>(*this); }

 private:
  Vector<3> mean_;
};

/// The prior's noise on the unknowns of a variable: none where they are known.
gtsam::SharedNoiseModel priorNoise(const Prior& prior, gtsam::Key key);

}  // namespace sas_motion::usbl

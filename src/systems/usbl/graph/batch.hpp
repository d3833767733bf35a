// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtsam/geometry/Rot3.h>
#include <gtsam/nonlinear/NonlinearFactor.h>
#include <gtsam/nonlinear/NonlinearFactorGraph.h>

#include <boost/make_shared.hpp>

#include "sas_motion/systems/usbl/problem.hpp"

namespace sas_motion::usbl {

/// The variables of a factor graph; one without an estimated unknown is left out.
constexpr gtsam::Key kMountingKey = 0;     ///< Rot3: v_body = R v_array
constexpr gtsam::Key kLeverKey = 1;        ///< Point3 [m]
constexpr gtsam::Key kTransponderKey = 2;  ///< Point3 [m]
constexpr gtsam::Key kRangeScaleKey = 3;   ///< double [-]

/// The keys of variables with an unknown to estimate, in rising order.
gtsam::KeyVector keysOf(const Prior& prior);
/// Index of the first unknown of a variable, and the number of its unknowns.
int firstUnknown(gtsam::Key key);
int countUnknowns(gtsam::Key key);

/// The variables at x.
gtsam::Values valuesFrom(const Prior& prior, const Unknowns& x);
/// The unknowns of a graph's variables; those without a variable are as in `known`.
Unknowns unknownsFrom(const gtsam::Values& values, const Unknowns& known);

/// The mounting angles of a rotation.
Vector<3> mountingAngles(const gtsam::Rot3& rotation);
/// Their derivative d angles / dw for the rotation R Exp(w).
Matrix<3> mountingAnglesJacobian(const Vector<3>& angles);

/// One channel of a ping under a loss: error h(x) - z. Each channel has a factor, since GTSAM gives a factor one
/// weight.
class ChannelFactor final : public gtsam::NoiseModelFactor {
 public:
  /// `known` holds the unknowns without a variable.
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

/// The prior on the mounting, with its error in the angles; an angle that is not estimated is fixed.
class MountingPriorFactor final : public gtsam::NoiseModelFactor1<gtsam::Rot3> {
 public:
  explicit MountingPriorFactor(const Prior& prior);
  gtsam::Vector evaluateError(const gtsam::Rot3& rotation, boost::optional<gtsam::Matrix&> H) const override;
  gtsam::NonlinearFactor::shared_ptr clone() const override { return boost::make_shared<MountingPriorFactor>(*this); }

 private:
  Vector<3> mean_;
};

/// The prior's noise on the unknowns of a variable; sigma 0 where they are not estimated.
gtsam::SharedNoiseModel priorNoise(const Prior& prior, gtsam::Key key);

/// A calibration as a factor graph; unknowns without a variable are as in `known`.
gtsam::NonlinearFactorGraph buildGraph(const Problem& problem, const Loss& loss, const Unknowns& known);

/// A Solver by Levenberg-Marquardt on the factor graph, with the covariance of solveIteratively().
Fit solveFactorGraph(const Problem& problem, const FitOptions& options, const Unknowns& start);

/// Graduated non-convexity with truncated least squares [Yang2020] on the graph without a loss: `probability` is the
/// share of good readings that it keeps; the prior is always kept. The covariance is the marginals' of what is kept.
Fit solveGnc(const Problem& problem, double probability, const Unknowns& start);

/// The marginal covariance of the unknowns at x, from the graph linearised there, with zeros for unknowns that are not
/// estimated. Throws what GTSAM throws.
Matrix<kUnknowns> marginalCovariance(const gtsam::NonlinearFactorGraph& graph, const Prior& prior, const Unknowns& x);

/// The fitters batch, by solveFactorGraph(), and gnc, by solveGnc() with batch's scale; empty for another name.
Fitter makeFitter(const std::string& name);

}  // namespace sas_motion::usbl

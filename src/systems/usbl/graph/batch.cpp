// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/usbl/graph/batch.hpp"

#include <gtsam/geometry/Point3.h>
#include <gtsam/nonlinear/GncOptimizer.h>
#include <gtsam/nonlinear/LevenbergMarquardtOptimizer.h>
#include <gtsam/nonlinear/Marginals.h>
#include <gtsam/nonlinear/PriorFactor.h>

#include "graph/levenberg_marquardt.hpp"

namespace sas_motion::usbl {
namespace {

using Factorization = gtsam::Marginals::Factorization;

/// d unknowns / d variables' tangents at x.
Matrix<kUnknowns> chart(const Unknowns& x) {
  Matrix<kUnknowns> result = Matrix<kUnknowns>::Identity();
  result.topLeftCorner<3, 3>() = mountingAnglesJacobian(x.head<3>());
  return result;
}

/// The start of a solver, and its result where it fails.
Fit beginning(const Problem& problem, const Unknowns& start) {
  Fit fit;
  fit.x = start;
  fit.scale = problem.scale;
  return fit;
}

}  // namespace

gtsam::NonlinearFactorGraph buildGraph(const Problem& problem, const Loss& loss, const Unknowns& known) {
  gtsam::NonlinearFactorGraph graph;
  const Prior& prior = problem.prior;
  for (const gtsam::Key key : keysOf(prior)) {
    if (key == kMountingKey)
      graph.emplace_shared<MountingPriorFactor>(prior);
    else if (key == kRangeScaleKey)
      graph.addPrior(key, prior.mean(kRangeScale), priorNoise(prior, key));
    else
      graph.addPrior(key, gtsam::Point3(prior.mean.segment<3>(firstUnknown(key))), priorNoise(prior, key));
  }
  for (const auto& ping : problem.pings)
    for (int channel = 0; channel < kChannels; ++channel)
      if (ping.reading.has(channel)) graph.emplace_shared<ChannelFactor>(problem, ping, channel, loss, known);
  return graph;
}

Matrix<kUnknowns> marginalCovariance(const gtsam::NonlinearFactorGraph& graph, const Prior& prior, const Unknowns& x) {
  Matrix<kUnknowns> tangent = Matrix<kUnknowns>::Zero();
  const auto keys = keysOf(prior);
  if (keys.empty()) return tangent;
  const auto joint = gtsam::Marginals(graph, valuesFrom(prior, x)).jointMarginalCovariance(keys);
  for (const gtsam::Key a : keys)
    for (const gtsam::Key b : keys)
      tangent.block(firstUnknown(a), firstUnknown(b), countUnknowns(a), countUnknowns(b)) = joint(a, b);
  return chart(x) * tangent * chart(x).transpose();
}

Fit solveFactorGraph(const Problem& problem, const FitOptions& options, const Unknowns& start) {
  Fit fit = guarded(beginning(problem, start), [&](Factorization factorization) {
    Fit found = beginning(problem, start);
    const auto graph = buildGraph(problem, options.loss, start);
    gtsam::LevenbergMarquardtOptimizer optimizer(
        graph, valuesFrom(problem.prior, start),
        levenbergMarquardt(options.max_iterations, options.tolerance, factorization));
    found.x = unknownsFrom(optimizer.optimize(), start);
    found.cost = optimizer.error();
    found.iterations = static_cast<int>(optimizer.iterations());
    found.converged = found.iterations < options.max_iterations;
    if (!found.converged) found.failure = "the fit did not converge";
    return found;
  });
  fit.covariance = influenceCovariance(problem, options.loss, fit.x);
  fit.weights = weightsAt(problem, options.loss, fit.x);
  return fit;
}

Fit solveGnc(const Problem& problem, double probability, const Unknowns& start) {
  return guarded(beginning(problem, start), [&](Factorization factorization) {
    const auto graph = buildGraph(problem, Loss(LossKind::L2), start);
    gtsam::GncParams<gtsam::LevenbergMarquardtParams> params(levenbergMarquardt(100, 1e-9, factorization));
    params.setLossType(gtsam::GncLossType::TLS);
    gtsam::GncParams<gtsam::LevenbergMarquardtParams>::IndexVector trusted;
    const std::size_t priors = keysOf(problem.prior).size();
    for (std::size_t i = 0; i < priors; ++i) trusted.push_back(i);
    params.setKnownInliers(trusted);
    gtsam::GncOptimizer<gtsam::GncParams<gtsam::LevenbergMarquardtParams>> optimizer(
        graph, valuesFrom(problem.prior, start), params);
    optimizer.setInlierCostThresholdsAtProbability(probability);

    Fit fit = beginning(problem, start);
    const gtsam::Values values = optimizer.optimize();
    fit.x = unknownsFrom(values, start);
    const gtsam::Vector weights = optimizer.getWeights();
    gtsam::NonlinearFactorGraph inliers;
    for (std::size_t i = 0; i < graph.size(); ++i)
      if (weights(static_cast<Eigen::Index>(i)) > 0.5) inliers.push_back(graph.at(i));
    fit.covariance = marginalCovariance(inliers, problem.prior, fit.x);
    fit.cost = inliers.error(values);
    fit.converged = true;
    auto factor = static_cast<Eigen::Index>(priors);
    for (const auto& ping : problem.pings) {
      fit.weights.emplace_back(Vector<kChannels>::Zero());
      for (int channel = 0; channel < kChannels; ++channel)
        if (ping.reading.has(channel)) fit.weights.back()(channel) = weights(factor++);
    }
    return fit;
  });
}

Fitter makeFitter(const std::string& name) {
  constexpr double kGoodKept = 0.99;
  const Fitter batch = [](const Problem& problem, const FitOptions& options) {
    return fit(problem, options, solveFactorGraph);
  };
  if (name == "batch") return batch;
  if (name != "gnc") return {};
  return [batch](const Problem& problem, const FitOptions& options) {
    const Fit robust = batch(problem, options);
    if (!robust.failure.empty()) return robust;
    Problem scaled = problem;
    scaled.scale = robust.scale;
    return solveGnc(scaled, kGoodKept, robust.x);
  };
}

}  // namespace sas_motion::usbl

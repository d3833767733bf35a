// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/towfish/graph/batch.hpp"

#include <gtsam/nonlinear/GncOptimizer.h>
#include <gtsam/nonlinear/LevenbergMarquardtOptimizer.h>
#include <gtsam/nonlinear/Marginals.h>

#include "graph/levenberg_marquardt.hpp"
#include "systems/towfish/graph/factors.hpp"

namespace sas_motion::towfish {
namespace {

constexpr std::size_t kLongestChain = 20000;  // nodes that elimination may recurse through

/// In time order, which is fastest. Elimination recurses along the tree, though, and a long chain would overflow the
/// stack: nested dissection then, whose tree is as deep as the logarithm.
gtsam::Ordering ordering(const gtsam::NonlinearFactorGraph& graph, std::size_t nodes) {
  return nodes > kLongestChain ? gtsam::Ordering::Metis(graph) : gtsam::Ordering::Natural(graph);
}

std::vector<StateVector> trajectoryOf(const gtsam::Values& values) {
  std::vector<StateVector> trajectory(values.size());
  for (std::size_t k = 0; k < trajectory.size(); ++k) trajectory[k] = values.at<StateVector>(k);
  return trajectory;
}

void addMarginals(const gtsam::NonlinearFactorGraph& graph, const gtsam::Values& values,
                  gtsam::Marginals::Factorization factorization, SmootherResult& result) {
  const auto order = values.size() > kLongestChain ? gtsam::Ordering::Metis(graph) : gtsam::Ordering::Colamd(graph);
  const gtsam::Marginals marginals(graph, values, order, factorization);
  const auto trajectory = trajectoryOf(values);
  result.states.resize(trajectory.size());
  for (std::size_t k = 0; k < trajectory.size(); ++k)
    result.states[k] = {trajectory[k], marginals.marginalCovariance(k)};
}

using Factorization = gtsam::Marginals::Factorization;

}  // namespace

gtsam::NonlinearFactorGraph buildGraph(const SmoothingProblem& problem, const Loss& loss) {
  gtsam::NonlinearFactorGraph graph;
  graph.emplace_shared<PriorStateFactor>(0, problem.prior);
  for (std::size_t k = 0; k < problem.nodes(); ++k) {
    if (k > 0)
      graph.emplace_shared<MotionFactor>(k - 1, k, problem.model, problem.inputs[k], problem.dt(k), problem.Q[k]);
    for (std::size_t j = problem.first[k]; j < problem.first[k + 1]; ++j)
      addRows(graph, k, problem.model, problem.measurements[j], loss);
  }
  return graph;
}

gtsam::Values initialValues(const std::vector<StateVector>& trajectory) {
  gtsam::Values values;
  for (std::size_t k = 0; k < trajectory.size(); ++k) values.insert(k, trajectory[k]);
  return values;
}

SmootherResult smoothBatch(const SmoothingProblem& problem, const SmootherOptions& options) {
  return guarded(SmootherResult(), [&](Factorization factorization) {
    SmootherResult result;
    gtsam::Values values = initialValues(problem.initial);
    std::vector<Loss> stages{options.loss};
    if (options.loss.redescending()) stages.insert(stages.begin(), Loss(LossKind::Huber));
    for (const Loss& loss : stages) {
      const auto graph = buildGraph(problem, loss);
      auto params = levenbergMarquardt(options.max_iterations, options.tolerance, factorization);
      params.ordering = ordering(graph, values.size());
      gtsam::LevenbergMarquardtOptimizer optimizer(graph, values, params);
      values = optimizer.optimize();
      result.cost = optimizer.error();
      result.iterations += static_cast<int>(optimizer.iterations());
      result.converged = optimizer.iterations() < static_cast<std::size_t>(options.max_iterations);
    }
    addMarginals(buildGraph(problem, options.loss), values, factorization, result);
    result.weights = weightsAt(problem, options.loss, trajectoryOf(values));
    return result;
  });
}

SmootherResult smoothGnc(const SmoothingProblem& problem, double probability) {
  return guarded(SmootherResult(), [&](Factorization factorization) {
    const auto graph = buildGraph(problem, Loss(LossKind::L2));
    gtsam::GncParams<gtsam::LevenbergMarquardtParams> params(levenbergMarquardt(100, 1e-7, factorization));
    params.baseOptimizerParams.ordering = ordering(graph, problem.nodes());
    params.setLossType(gtsam::GncLossType::TLS);
    gtsam::GncParams<gtsam::LevenbergMarquardtParams>::IndexVector trusted;
    for (std::size_t i = 0; i < graph.size(); ++i)
      if (!dynamic_cast<const RowFactor*>(graph.at(i).get())) trusted.push_back(i);
    params.setKnownInliers(trusted);
    gtsam::GncOptimizer<gtsam::GncParams<gtsam::LevenbergMarquardtParams>> optimizer(
        graph, initialValues(problem.initial), params);
    optimizer.setInlierCostThresholdsAtProbability(probability);
    const gtsam::Values values = optimizer.optimize();

    SmootherResult result;
    const gtsam::Vector weights = optimizer.getWeights();
    gtsam::NonlinearFactorGraph inliers;
    for (std::size_t i = 0; i < graph.size(); ++i)
      if (weights(static_cast<Eigen::Index>(i)) > 0.5) inliers.push_back(graph.at(i));
    addMarginals(inliers, values, factorization, result);
    result.cost = inliers.error(values);
    result.converged = true;
    std::size_t factor = 1;  // the prior comes first
    for (std::size_t k = 0; k < problem.nodes(); ++k) {
      if (k > 0) ++factor;
      for (std::size_t j = problem.first[k]; j < problem.first[k + 1]; ++j) {
        Vector<2> row_weights = Vector<2>::Ones();
        for (int row = 0; row < rowsOf(problem.measurements[j].sensor); ++row)
          row_weights(row) = weights(static_cast<Eigen::Index>(factor++));
        result.weights.push_back(row_weights);
      }
    }
    return result;
  });
}

}  // namespace sas_motion::towfish

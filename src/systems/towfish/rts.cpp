// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/towfish/rts.hpp"

#include <cmath>

#include "sas_motion/filters/conditioning.hpp"
#include "sas_motion/filters/kalman_filter.hpp"

namespace sas_motion::towfish {
namespace {

/// What the pass back needs of one scalar row: its H, the gain K, 1 / S and innovation / S.
struct RowMemory {
  StateVector h, K;
  double S_inverse, innovation_over_S;
};

/// What the pass back needs of one node: F on the way in, and the filtered covariance and offset from the trajectory.
struct NodeMemory {
  StateMatrix F, P;
  StateVector offset;
  std::size_t rows_end;
};

class Sweeper {
 public:
  Sweeper(const SmoothingProblem& problem, const Loss& loss) : problem_(problem), loss_(loss), nodes_(problem.nodes()) {
    rows_.resize(2 * problem.measurements.size());
    prior_root_ = problem.prior.covariance.llt();
    motion_root_.reserve(problem.nodes());
    for (const auto& Q : problem.Q) motion_root_.emplace_back(Q);
  }

  /// Filters forward about the trajectory; returns the cost there. Offsets are relative to the trajectory, so no angle
  /// wraps.
  double forward(const std::vector<StateVector>& trajectory) {
    Gaussian<kStates> belief{Model::difference(problem_.prior.mean, trajectory[0]), problem_.prior.covariance};
    double cost = 0.5 * belief.mean.dot(prior_root_.solve(belief.mean));
    std::size_t row = 0;
    for (std::size_t k = 0; k < problem_.nodes(); ++k) {
      if (k > 0) {
        auto step = problem_.model.transition(trajectory[k - 1], problem_.inputs[k], problem_.dt(k));
        const StateVector residual = Model::difference(step.mean, trajectory[k]);
        cost += 0.5 * motion_root_[k].matrixL().solve(residual).squaredNorm();
        step.mean = residual + step.F * belief.mean;
        step.Q = problem_.Q[k];
        belief = predictGaussian(belief, step);
        nodes_[k].F = step.F;
      }
      for (std::size_t j = problem_.first[k]; j < problem_.first[k + 1]; ++j)
        problem_.model.linearize(problem_.measurements[j], trajectory[k], [&](const auto& z) {
          for (int i = 0; i < z.innovation.rows(); ++i)
            cost += fuse(z.innovation(i), z.H.row(i).transpose(), z.R(i, i), belief, rows_[row++]);
        });
      nodes_[k].P = belief.covariance;
      nodes_[k].offset = belief.mean;
      nodes_[k].rows_end = row;
    }
    return cost;
  }

  /// The smoothed offsets from the trajectory of the last forward pass; with `covariances`, those too.
  void backward(std::vector<StateVector>& offsets, std::vector<Gaussian<kStates>>* covariances) const {
    StateVector lambda = StateVector::Zero();
    StateMatrix Lambda = StateMatrix::Zero();
    for (std::size_t k = problem_.nodes(); k-- > 0;) {
      const NodeMemory& node = nodes_[k];
      offsets[k] = node.offset - node.P * lambda;
      if (covariances) {
        (*covariances)[k].covariance = node.P - node.P * Lambda * node.P;
        symmetrize((*covariances)[k].covariance);
      }
      for (std::size_t row = node.rows_end; row-- > (k > 0 ? nodes_[k - 1].rows_end : 0);) {
        const RowMemory& r = rows_[row];
        lambda -= r.h * (r.K.dot(lambda) + r.innovation_over_S);
        if (covariances) {
          const StateMatrix IKH = StateMatrix::Identity() - r.K * r.h.transpose();
          Lambda = (IKH.transpose() * Lambda * IKH + r.h * r.S_inverse * r.h.transpose()).eval();
        }
      }
      if (k > 0) {
        lambda = (node.F.transpose() * lambda).eval();
        if (covariances) Lambda = (node.F.transpose() * Lambda * node.F).eval();
      }
    }
  }

 private:
  /// One weighted scalar update of the offset's belief; returns its share of the cost.
  double fuse(double residual, const StateVector& h, double variance, Gaussian<kStates>& belief,
              RowMemory& memory) const {
    const double whitened = residual / std::sqrt(variance);
    const double R = variance / std::max(loss_.weight(whitened), 1e-12);
    const StateVector Ph = belief.covariance * h;
    const double S = h.dot(Ph) + R, innovation = residual - h.dot(belief.mean);
    memory = {h, Ph / S, 1 / S, innovation / S};
    belief.mean += memory.K * innovation;
    const StateMatrix IKH_P = belief.covariance - memory.K * Ph.transpose();
    const StateVector right = IKH_P * h - memory.K * R;
    belief.covariance = IKH_P - right * memory.K.transpose();
    symmetrize(belief.covariance);
    return loss_.rho(whitened);
  }

  const SmoothingProblem& problem_;
  Loss loss_;
  Eigen::LLT<StateMatrix> prior_root_;
  std::vector<Eigen::LLT<StateMatrix>> motion_root_;
  std::vector<NodeMemory> nodes_;
  std::vector<RowMemory> rows_;
};

struct Descent {
  std::vector<StateVector> trajectory;
  double cost = 0;
  int iterations = 0;
  bool converged = false;
};

/// Iterates sweeps until the cost settles.
Descent descend(Sweeper& sweeper, std::vector<StateVector> start, const SmootherOptions& options) {
  Descent result{std::move(start), 0, 0, false};
  std::vector<StateVector> offsets(result.trajectory.size()), candidate(result.trajectory.size());
  result.cost = sweeper.forward(result.trajectory);
  while (result.iterations < options.max_iterations && !result.converged) {
    ++result.iterations;
    sweeper.backward(offsets, nullptr);
    double next = 0, step = 1;
    for (; step > 1e-3; step /= 2) {
      for (std::size_t k = 0; k < candidate.size(); ++k) candidate[k] = result.trajectory[k] + step * offsets[k];
      next = sweeper.forward(candidate);
      if (next <= result.cost * (1 + 1e-14)) break;
    }
    if (!(next <= result.cost * (1 + 1e-14))) {  // no descent left in double precision
      result.converged = std::isfinite(next);
      sweeper.forward(result.trajectory);
      break;
    }
    result.converged = result.cost - next <= options.tolerance * result.cost;
    result.cost = next;
    std::swap(result.trajectory, candidate);
  }
  return result;
}

}  // namespace

SmootherResult smoothRts(const SmoothingProblem& problem, const SmootherOptions& options) {
  std::vector<StateVector> start = problem.initial;
  SmootherResult result;
  if (options.loss.redescending()) {
    Sweeper huber(problem, Loss(LossKind::Huber));
    Descent descent = descend(huber, std::move(start), options);
    result.iterations = descent.iterations;
    start = std::move(descent.trajectory);
  }
  Sweeper sweeper(problem, options.loss);
  const Descent descent = descend(sweeper, std::move(start), options);
  result.cost = descent.cost;
  result.iterations += descent.iterations;
  result.converged = descent.converged;
  if (!std::isfinite(result.cost)) result.failure = "the cost is not finite";

  std::vector<StateVector> offsets(problem.nodes());
  result.states.resize(problem.nodes());
  sweeper.backward(offsets, &result.states);
  for (std::size_t k = 0; k < problem.nodes(); ++k) result.states[k].mean = descent.trajectory[k];
  result.weights = weightsAt(problem, options.loss, descent.trajectory);
  return result;
}

}  // namespace sas_motion::towfish

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/ins_gps_dvl/graph/window.hpp"

#include <gtsam/linear/GaussianBayesNet.h>
#include <gtsam/linear/GaussianFactorGraph.h>
#include <gtsam/nonlinear/LevenbergMarquardtOptimizer.h>
#include <gtsam/nonlinear/LinearContainerFactor.h>
#include <gtsam/nonlinear/PriorFactor.h>

#include "graph/levenberg_marquardt.hpp"
#include "sas_motion/filters/update.hpp"

namespace sas_motion::ins {
namespace {

using Factorization = gtsam::Marginals::Factorization;

/// What a solver leaves behind.
struct Optimum {
  gtsam::Values values;
  boost::shared_ptr<gtsam::GaussianBayesNet> net;  // at the values
  double cost = 0;
  std::string failure;
};

bool isNode(gtsam::Key key) { return key < kConstantsKey; }

/// The covariance of each node of a chain, last one first, from its Bayes net, whose nodes come in time order before
/// the constants: each node is known given the next one and the constants, whose covariance is known.
template <class Visit>
void visitCovariances(const gtsam::GaussianBayesNet& net, const Visit& visit) {
  std::map<gtsam::Key, Eigen::Index> place;  // of what is known in P
  gtsam::Matrix P;
  Eigen::Index kept = 0;  // the constants
  for (auto it = net.end(); it != net.begin();) {
    const gtsam::GaussianConditional& conditional = **--it;
    const gtsam::Key key = conditional.front();
    const gtsam::Matrix root = conditional.R().triangularView<Eigen::Upper>().solve(
        gtsam::Matrix::Identity(conditional.rows(), conditional.rows()));
    gtsam::Matrix gain = gtsam::Matrix::Zero(root.rows(), P.cols());
    for (auto parent = conditional.beginParents(); parent != conditional.endParents(); ++parent) {
      const auto S = conditional.S(parent);
      gain.middleCols(place.at(*parent), S.cols()) = -root * S;
    }
    const gtsam::Matrix cross = gain * P, own = root * root.transpose() + cross * gain.transpose();
    gtsam::Matrix joint(kept + own.rows(), kept + own.rows());
    joint << P.topLeftCorner(kept, kept), cross.leftCols(kept).transpose(), cross.leftCols(kept), own;
    P = joint;
    place[key] = kept;
    if (isNode(key))
      visit(key, own);
    else
      kept = P.rows();
  }
}

Matrix<9> inSiUnits(const gtsam::Matrix& covariance) {
  Vector<9> unit = Vector<9>::Ones();
  unit.segment<3>(kAttitude).setConstant(kMilliradian);
  return unit.asDiagonal() * covariance.topLeftCorner<9, 9>() * unit.asDiagonal();
}

}  // namespace

InsWindow::InsWindow(const ErrorModel& model, const Loss& loss, const NavigationState& fused,
                     const Gaussian<kStates>& belief, Stamp stamp)
    : model_(std::make_shared<const ErrorModel>(model)), loss_(loss) {
  const Parameters& p = model.parameters();
  places_.push_back({next_key_++, stamp});
  values_.insert(places_.back().key, nodeOf(fused, belief.mean));
  values_.insert(kConstantsKey, constantsOf(belief.mean));
  graph_.emplace_shared<BeliefFactor>(places_.back().key, fused, belief);
  if (p.dvl_scale > 0) {
    values_.insert(kDvlScaleKey, 0.0);
    graph_.addPrior(kDvlScaleKey, 0.0, gtsam::noiseModel::Isotropic::Sigma(1, p.dvl_scale));
  }
  addConstant(kDvlMisalignmentKey, p.dvl_misalignment);
  addConstant(kDvlLeverKey, p.dvl_lever_sigma);
}

void InsWindow::addConstant(gtsam::Key key, double sigma) {
  if (!(sigma > 0)) return;
  values_.insert(key, gtsam::Vector3(0, 0, 0));
  graph_.addPrior(key, gtsam::Vector3(0, 0, 0), gtsam::noiseModel::Isotropic::Sigma(3, sigma));
}

void InsWindow::add(const InsChain::Stop& stop) {
  if (stop.stamp > places_.back().stamp) {
    const gtsam::Key from = places_.back().key, to = next_key_++;
    places_.push_back({to, stop.stamp, stop.way});
    graph_.emplace_shared<InertialFactor>(from, to, model_, stop.way, values_.at<Node>(from), constants());
    values_.insert(to, stop.start);
  }
  for (const auto& reading : stop.readings) {
    if (reading.lever_body) place(reading.sensor, *reading.lever_body);
    Reading added{reading.stamp, reading.sensor, {}};
    for (int row = 0; row < rowsOf(reading.sensor); ++row)
      added.rows.push_back(
          boost::make_shared<AidingFactor>(places_.back().key, model_, reading, stop.rate_body, row, loss_));
    for (const auto& row : added.rows) graph_.push_back(row);
    places_.back().readings.push_back(added);
  }
}

void InsWindow::place(Sensor sensor, const Vector<3>& lever_body) {
  Parameters parameters = model_->parameters();
  if (leverOf(parameters, sensor) == lever_body) return;
  ErrorModel placed = *model_;
  placed.place(sensor, lever_body);
  model_ = std::make_shared<const ErrorModel>(placed);
}

std::string InsWindow::solve(int max_iterations, double tolerance) {
  const Optimum optimum = guarded(Optimum(), [&](Factorization factorization) {
    Optimum found;
    const bool by_qr = factorization == gtsam::Marginals::QR;
    auto params = levenbergMarquardt(max_iterations, tolerance, factorization);
    params.linearSolverType =
        by_qr ? gtsam::NonlinearOptimizerParams::SEQUENTIAL_QR : gtsam::NonlinearOptimizerParams::SEQUENTIAL_CHOLESKY;
    params.ordering = gtsam::Ordering::Natural(graph_);
    gtsam::LevenbergMarquardtOptimizer optimizer(graph_, values_, params);
    found.values = optimizer.optimize();
    found.cost = optimizer.error();
    const gtsam::GaussianFactorGraph::Eliminate eliminate =
        by_qr ? gtsam::GaussianFactorGraph::Eliminate(gtsam::EliminateQR) : gtsam::EliminatePreferCholesky;
    found.net = graph_.linearize(found.values)->eliminateSequential(*params.ordering, eliminate);
    return found;
  });
  if (!optimum.failure.empty()) return optimum.failure;
  values_ = optimum.values;
  visitCovariances(*optimum.net, [&](gtsam::Key key, const gtsam::Matrix& P) {
    places_[key - places_.front().key].covariance = inSiUnits(P);
  });
  return "";
}

void InsWindow::forget(std::size_t count) {
  if (count == 0) return;
  const gtsam::Key first_kept = places_[count].key;
  const auto forgotten = [&](gtsam::Key key) { return key < first_kept; };
  gtsam::NonlinearFactorGraph touched, kept;
  for (const auto& factor : graph_)
    (forgotten(*std::min_element(factor->begin(), factor->end())) ? touched : kept).push_back(factor);
  gtsam::KeyVector order;
  for (std::size_t k = 0; k < count; ++k) order.push_back(places_[k].key);
  const auto rest =
      touched.linearize(values_)->eliminatePartialSequential(gtsam::Ordering(order), gtsam::EliminateQR).second;
  for (const auto& factor : *rest) kept.emplace_shared<gtsam::LinearContainerFactor>(factor, values_);
  graph_ = kept;
  for (const auto key : order) values_.erase(key);
  places_.erase(places_.begin(), places_.begin() + static_cast<std::ptrdiff_t>(count));
}

std::vector<Audit> InsWindow::audits(std::size_t k) const {
  std::vector<Audit> audits;
  for (const auto& reading : places_[k].readings) {
    Audit audit{reading.stamp, sensorName(reading.sensor), rowsOf(reading.sensor)};
    for (std::size_t row = 0; row < reading.rows.size(); ++row) {
      const double residual = reading.rows[row]->residual(values_);
      audit.weights(static_cast<Eigen::Index>(row)) = loss_.weight(residual);
      audit.nis += residual * residual;
    }
    audit.verdict = verdictFromWeights(audit.weights);
    audits.push_back(audit);
  }
  return audits;
}

}  // namespace sas_motion::ins

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtsam/nonlinear/NonlinearFactorGraph.h>
#include <gtsam/nonlinear/Values.h>

#include <deque>
#include <string>

#include "sas_motion/estimate/smoother_options.hpp"
#include "systems/ins_gps_dvl/graph/chain.hpp"
#include "systems/ins_gps_dvl/graph/factors.hpp"

namespace sas_motion::ins {

/// Nodes in time order with their factors. They are solved together; the oldest are forgotten, and what they say stays
/// as a prior.
class InsWindow {
 public:
  /// Begins with a filter's belief at a stamp. Weights of readings follow the loss.
  InsWindow(const ErrorModel& model, const Loss& loss, const NavigationState& fused, const Gaussian<kStates>& belief,
            Stamp stamp);

  /// Adds a node, or readings to the last one where it has the stop's stamp.
  void add(const InsChain::Stop& stop);
  /// Levenberg-Marquardt, then the covariances. Returns in plain words why there is no solution, or nothing; what was
  /// there stays then.
  std::string solve(int max_iterations, double tolerance);
  /// Takes the first nodes out: their factors become a linear one on the next node and the constants. (marginalisation)
  void forget(std::size_t count);

  std::size_t size() const { return places_.size(); }
  Stamp stamp(std::size_t k) const { return places_[k].stamp; }
  Node node(std::size_t k) const { return values_.at<Node>(places_[k].key); }
  Constants constants() const { return values_.at<Constants>(kConstantsKey); }
  // The estimated errors of the DVL's configured scale [-], misalignment [rad] and lever arm [m]; zero for those that
  // are not estimated.
  double dvlScale() const { return values_.exists(kDvlScaleKey) ? values_.at<double>(kDvlScaleKey) : 0; }
  Vector<3> dvlMisalignment() const { return vectorAt(kDvlMisalignmentKey); }
  Vector<3> dvlLever() const { return vectorAt(kDvlLeverKey); }
  /// Of velocity, position and attitude errors by the last solution [m/s, m, rad].
  const Matrix<9>& covariance(std::size_t k) const { return places_[k].covariance; }
  /// From this node to the next.
  const InertialInterval& wayFrom(std::size_t k) const { return *places_[k + 1].way; }
  /// What became of the node's readings.
  std::vector<Audit> audits(std::size_t k) const;
  /// Readings of the last node are not audited again.
  void closeLast() { places_.back().readings.clear(); }

  const gtsam::NonlinearFactorGraph& graph() const { return graph_; }
  const gtsam::Values& values() const { return values_; }

 private:
  struct Reading {
    Stamp stamp;
    Sensor sensor;
    std::vector<boost::shared_ptr<AidingFactor>> rows;
  };
  struct Place {
    gtsam::Key key;
    Stamp stamp;
    IntervalPtr way = nullptr;
    std::vector<Reading> readings = {};
    Matrix<9> covariance = Matrix<9>::Zero();
  };

  Vector<3> vectorAt(gtsam::Key key) const {
    return values_.exists(key) ? Vector<3>(values_.at<gtsam::Vector3>(key)) : Vector<3>::Zero();
  }
  /// A constant that is zero but for a standard deviation; nothing where that is 0.
  void addConstant(gtsam::Key key, double sigma);
  /// Where a sensor is from now on; older factors keep its place at their time.
  void place(Sensor sensor, const Vector<3>& lever_body);

  ModelPtr model_;
  Loss loss_;
  gtsam::NonlinearFactorGraph graph_;
  gtsam::Values values_;
  std::deque<Place> places_;
  gtsam::Key next_key_ = 0;
};

}  // namespace sas_motion::ins

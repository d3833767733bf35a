// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/ins_gps_dvl/estimator.hpp"

#include "sas_motion/navigation/attitude.hpp"
#include "sas_motion/systems/ins_gps_dvl/solutions.hpp"

namespace sas_motion::ins {
namespace {

/// One solution of a navigator of its own.
template <class Filter>
class NavigatorEstimator final : public Estimator {
 public:
  NavigatorEstimator(const FilterKind& kind, const Filter& filter, const NavigatorOptions& options,
                     const Config& config, Source source)
      : kind_(kind), filter_(filter), options_(options), config_(config), source_(source) {}

  void start(const NavigationState& state, Stamp stamp) override {
    navigator_.emplace(filter_, config_.parameters, state, stamp, options_);
  }
  void process(const Aiding& reading, Output&) override {
    if (navigator_) navigator_->add(reading);
  }
  ImuVerdict process(const ImuReading& reading, Output& output) override {
    if (!navigator_) return ImuVerdict::OutOfOrder;
    const ImuVerdict verdict = navigator_->add(reading).verdict;
    output.audits.insert(output.audits.end(), navigator_->audits().begin(), navigator_->audits().end());
    if (const auto solution = solutionOf(*navigator_, source_)) output.solutions.push_back(*solution);
    return verdict;
  }
  void configure(const Config& config) override {
    config_ = config;
    withFilter(kind_, config, [this](const auto& filter, const NavigatorOptions&) {
      if constexpr (std::is_same_v<std::decay_t<decltype(filter)>, Filter>) {
        filter_ = filter;
        if (navigator_) navigator_->use(filter);
      }
    });
  }
  std::unique_ptr<Estimator> clone() const override { return std::make_unique<NavigatorEstimator>(*this); }

 private:
  FilterKind kind_;
  Filter filter_;
  NavigatorOptions options_;
  Config config_;
  Source source_;
  std::optional<Navigator<Filter>> navigator_;
};

}  // namespace

NavigationSolution movedBy(const NavigationSolution& solution, const Vector<3>& lever_body) {
  NavigationSolution moved = solution;
  const Eigen::Quaterniond& q = solution.state.q_nav_body;
  const Vector<3> lever = q * lever_body,
                  swing = solution.rate_body ? Vector<3>(q * solution.rate_body->cross(lever_body)) : Vector<3>::Zero();
  displace(moved.state, lever);
  moved.state.velocity_nav += swing;
  if (!solution.covariance) return moved;
  Matrix<9> J = Matrix<9>::Identity();  // C' l = C l + (C l) x phi
  J.block<3, 3>(kVelocity, kAttitude) = skew(swing);
  J.block<3, 3>(kPosition, kAttitude) = skew(lever);
  moved.covariance = J * *solution.covariance * J.transpose();
  return moved;
}

std::unique_ptr<Estimator> makeEstimator(const std::string& name, const Config& config) {
  const NamedSolution* found = findSolution(name);
  if (!found) return nullptr;
  std::unique_ptr<Estimator> estimator;
  withFilter(found->filter, config, [&](const auto& filter, const NavigatorOptions& options) {
    estimator = std::make_unique<NavigatorEstimator<std::decay_t<decltype(filter)>>>(found->filter, filter, options,
                                                                                     config, found->source);
  });
  return estimator;
}

const std::vector<std::string>& estimatorNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& solution : namedSolutions()) all.push_back(solution.name);
    return all;
  }();
  return names;
}

}  // namespace sas_motion::ins

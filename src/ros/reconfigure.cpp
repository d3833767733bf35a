// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ros/reconfigure.hpp"

namespace sas_motion::ros_side {
namespace {

/// Takes a loss and its tuning; another loss without another tuning comes with its customary one. True where something
/// changed.
bool take(const std::string& name, double& tuning, Loss& loss) {
  const LossKind kind = lossFromName(name);
  if (kind != loss.kind() && tuning == loss.tuning()) tuning = Loss::defaultTuning(kind);
  if (kind == loss.kind() && tuning == loss.tuning()) return false;
  loss = Loss(kind, tuning);
  return true;
}

void showLoss(const Loss& loss, std::string& name, double& tuning) {
  name = lossName(loss.kind());
  tuning = loss.tuning();
}

}  // namespace

Reconfigure::Reconfigure(const ros::NodeHandle& own, const Tuning& tuning, Changed changed)
    : tuning_(tuning), changed_(std::move(changed)), server_(mutex_, own) {
  EstimatorsConfig shown = EstimatorsConfig::__getDefault__();
  show(shown);
  server_.updateConfig(shown);
  server_.setCallback([this](EstimatorsConfig& wanted, std::uint32_t) { onChange(wanted); });
}

void Reconfigure::show(EstimatorsConfig& shown) const {
  showLoss(tuning_.robust_kf, shown.robust_kf_loss, shown.robust_kf_tuning);
  showLoss(tuning_.fixed_lag, shown.fixed_lag_loss, shown.fixed_lag_tuning);
  shown.gated_kf_probability = tuning_.gated_kf_probability;
}

void Reconfigure::onChange(EstimatorsConfig& wanted) {
  try {
    Tuning next = tuning_;
    bool different = take(wanted.robust_kf_loss, wanted.robust_kf_tuning, next.robust_kf);
    different = take(wanted.fixed_lag_loss, wanted.fixed_lag_tuning, next.fixed_lag) || different;
    different = wanted.gated_kf_probability != next.gated_kf_probability || different;
    next.gated_kf_probability = wanted.gated_kf_probability;
    if (different) changed_(tuning_ = next);
  } catch (const std::invalid_argument& error) {
    ROS_ERROR("dynamic_reconfigure: %s", error.what());
    show(wanted);
  }
}

}  // namespace sas_motion::ros_side

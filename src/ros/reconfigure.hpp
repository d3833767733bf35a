// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <dynamic_reconfigure/server.h>
#include <sas_motion/EstimatorsConfig.h>

#include <functional>

#include "sas_motion/session/session.hpp"

namespace sas_motion::ros_side {

/// Losses, their tuning and the gate by dynamic_reconfigure. It starts with the tuning given, not with values of
/// an earlier run.
class Reconfigure {
 public:
  using Changed = std::function<void(const Tuning&)>;

  /// Calls `changed` with a tuning in which one of them differs from before.
  Reconfigure(const ros::NodeHandle& own, const Tuning& tuning, Changed changed);

 private:
  void onChange(EstimatorsConfig& wanted);
  void show(EstimatorsConfig& shown) const;

  Tuning tuning_;
  Changed changed_;
  boost::recursive_mutex mutex_;
  dynamic_reconfigure::Server<EstimatorsConfig> server_;
};

}  // namespace sas_motion::ros_side

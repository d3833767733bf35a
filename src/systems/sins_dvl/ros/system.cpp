// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/sins_dvl/ros/system.hpp"

#include "sas_motion/systems/sins_dvl/config.hpp"
#include "systems/ins_gps_dvl/ros/system.hpp"
#include "systems/sins_dvl/graph/estimators.hpp"

namespace sas_motion::ros_side {
namespace {

class SinsDvlSystem final : public NavigationSystem {
 public:
  explicit SinsDvlSystem(YamlSection& yaml) : NavigationSystem({}, "gnss/velocity") {
    estimators = sins::anyEstimatorNames();
    preferred = {"ss_srupf"};
    sins::Settings settings;
    sins::readSettings(yaml, settings);
    estimation_ = settings.shared;
    make_ = [config = settings.config](const std::string& name, const ins::Config& found) {
      return sins::makeAnyEstimator(name, startedAt(config, found));
    };
    readRest(yaml);
  }
  std::string currentName(const std::string& estimator) const override { return sins::currentName(estimator); }
};

}  // namespace

std::unique_ptr<System> openSinsDvl(YamlSection& yaml) { return std::make_unique<SinsDvlSystem>(yaml); }

}  // namespace sas_motion::ros_side

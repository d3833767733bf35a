// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/registry.hpp"

#include <fmt/format.h>

#include "systems/constant_velocity/campaign.hpp"
#include "systems/ins_gps_dvl/campaign.hpp"
#include "systems/ins_gps_dvl/graph/smoother.hpp"
#include "systems/ins_gps_dvl/ros/recorder.hpp"
#include "systems/ins_gps_dvl/ros/system.hpp"
#include "systems/sins_dvl/campaign.hpp"
#include "systems/sins_dvl/graph/estimators.hpp"
#include "systems/sins_dvl/ros/recorder.hpp"
#include "systems/sins_dvl/ros/system.hpp"
#include "systems/towfish/campaign.hpp"
#include "systems/towfish/graph/estimators.hpp"
#include "systems/towfish/ros/recorder.hpp"
#include "systems/towfish/ros/system.hpp"
#include "systems/usbl/campaign.hpp"
#include "systems/usbl/graph/batch.hpp"
#include "systems/usbl/ros/recorder.hpp"

namespace sas_motion {
namespace {

/// Reads campaigns with the estimators of a factory.
template <class Read, class Factory>
CampaignReader campaignBy(Read read, Factory make) {
  return [=](YamlSection& yaml, const std::string& folder) { return read(yaml, folder, make); };
}

/// Plays a scenario by the recorder of its system.
template <class Scenario, class Recorder>
void record(const SimulationRequest& request, ros_side::BagOutput& bag, const SimulationProgress& progress) {
  Scenario scenario = Scenario::fromFile(request.scenario);
  if (request.duration > 0) scenario.duration = request.duration;
  Recorder recorder(scenario, request.seed, bag);
  recorder.record([&](double seconds) { progress(scenario.duration, seconds); });
}

/// The row of the system that `yaml` names, of those that have what `member` is.
template <class Member>
const SystemRow& rowOf(YamlSection& yaml, std::string name, Member SystemRow::*member) {
  yaml.text("system", name);
  std::vector<std::string> known;
  for (const auto& row : systems()) {
    if (!(row.*member)) continue;
    if (row.name == name) return row;
    known.emplace_back(row.name);
  }
  yaml.fail("system", fmt::format("is '{}' but must be one of {}", name, fmt::join(known, ", ")));
}

}  // namespace

const std::vector<SystemRow>& systems() {
  static const std::vector<SystemRow> rows{
      {"towfish", campaignBy(&towfish::readCampaign, &towfish::makeAnyEstimator), ros_side::openTowfish,
       record<towfish::Scenario, TowfishRecorder>},
      {"ins_gps_dvl", campaignBy(&ins::readCampaign, &ins::makeAnyEstimator), ros_side::openInsGpsDvl,
       record<ins::Scenario, InsRecorder>},
      {"sins_dvl", campaignBy(&sins::readCampaign, &sins::makeAnyEstimator), ros_side::openSinsDvl,
       record<sins::Scenario, SinsRecorder>},
      {"usbl", campaignBy(&usbl::readCampaign, &usbl::makeFitter), nullptr, record<usbl::Scenario, UsblRecorder>},
      {"constant_velocity", &constant_velocity::readCampaign, nullptr, nullptr},
      {"imaging", campaignBy(&ins::readImagingCampaign, &ins::makeAnyEstimator), nullptr, nullptr},
  };
  return rows;
}

std::unique_ptr<ros_side::System> openSystem(const std::string& config, const std::string& otherwise) {
  auto yaml = config.empty() ? YamlSection::fromText("{}", "the built-in settings") : YamlSection::fromFile(config);
  return rowOf(yaml, otherwise, &SystemRow::open).open(yaml);
}

CampaignReaders campaignReaders() {
  CampaignReaders readers;
  for (const auto& row : systems()) readers[row.name] = row.campaign;
  return readers;
}

void simulate(const SimulationRequest& request, ros_side::BagOutput& bag, const SimulationProgress& progress) {
  auto yaml = YamlSection::fromFile(request.scenario);
  rowOf(yaml, "towfish", &SystemRow::simulate).simulate(request, bag, progress);
}

}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>

#include "sas_motion/config/yaml_vector.hpp"
#include "sas_motion/systems/usbl/simulator.hpp"

namespace sas_motion::usbl {
namespace {

void readTrack(YamlSection yaml, Track& track) {
  const std::vector<std::string> kinds{"figure_eight", "circle", "waypoints"};
  std::string kind = kinds[static_cast<std::size_t>(track.kind)];
  yaml.text("kind", kind);
  const auto found = std::find(kinds.begin(), kinds.end(), kind);
  if (found == kinds.end())
    yaml.fail("kind", fmt::format("is '{}' but must be figure_eight, circle or waypoints", kind));
  track.kind = static_cast<Track::Kind>(found - kinds.begin());
  readVector<2>(yaml, "centre", track.centre);
  yaml.number("radius", track.radius, {1, 1e5});
  yaml.angle("heading_deg", track.heading, {-360, 360});
  yaml.number("speed", track.speed, {0.01, 50});
  yaml.angle("turn_rate_deg", track.turn_rate, {0.1, 90});
  for (auto& item : yaml.list("waypoints")) {
    Vector<2> point = Vector<2>::Zero();
    readVector<2>(item, "at", point);
    item.finish();
    track.waypoints.push_back(point);
  }
  if (track.kind == Track::Kind::Waypoints && track.waypoints.size() < 2)
    yaml.fail("waypoints", "must list at least two points");
  yaml.finish();
}

void readArray(YamlSection yaml, Scenario& scenario) {
  Vector<3> mounting = scenario.truth.head<3>() / kRadPerDeg, lever = scenario.truth.segment<3>(kLeverX);
  readVector<3>(yaml, "mounting_deg", mounting);
  readVector<3>(yaml, "lever_arm", lever);
  scenario.truth.head<3>() = mounting * kRadPerDeg;
  scenario.truth.segment<3>(kLeverX) = lever;
  yaml.number("range_scale", scenario.truth(kRangeScale), {-0.1, 0.1});
  yaml.number("rate", scenario.ping_rate, {0.01, 100});
  yaml.number("range_sigma", scenario.range_sigma, {kTiny, 1e3});
  yaml.angle("direction_sigma_deg", scenario.direction_sigma, {kTiny, 90});
  yaml.number("stated_factor", scenario.stated_factor, {1e-6, 1e6});
  scenario.noise.fill(NoiseMix::read(yaml, "noise"));
  yaml.finish();
}

}  // namespace

Unknowns Scenario::defaultTruth() {
  Unknowns truth = Unknowns::Zero();
  truth.head<kStates>() << 2 * kRadPerDeg, -2 * kRadPerDeg, 3 * kRadPerDeg, 0.5, 0.8, 1.0;
  return truth;
}

Scenario Scenario::fromFile(const std::string& file) { return read(YamlSection::fromFile(file)); }

Scenario Scenario::read(YamlSection yaml) {
  Scenario scenario;
  scenario.name = yaml.file();
  std::string system = "usbl";
  yaml.text("system", system);
  yaml.text("name", scenario.name);
  yaml.number("duration", scenario.duration, {1, 1e7});
  readGeodetic(yaml, "datum", scenario.datum);
  readVector<3>(yaml, "transponder", scenario.transponder_map);
  Vector<3> survey_error = scenario.truth.segment<3>(kTransponderX);
  readVector<3>(yaml, "transponder_error", survey_error);
  scenario.truth.segment<3>(kTransponderX) = survey_error;
  scenario.track.centre = scenario.transponder_map.head<2>();
  readTrack(yaml.section("track"), scenario.track);
  auto waves = yaml.section("waves");
  waves.angle("pitch_deg", scenario.wave_pitch, {0, 45});
  waves.angle("roll_deg", scenario.wave_roll, {0, 45});
  waves.number("period", scenario.wave_period, {0.5, 1e3});
  waves.finish();
  readArray(yaml.section("usbl"), scenario);
  auto gnss = yaml.section("gnss");
  gnss.number("rate", scenario.gnss_rate, {0.01, 1e3});
  gnss.number("sigma", scenario.gnss_sigma, {kTiny, 1e3});
  gnss.number("sigma_up", scenario.gnss_sigma_up, {kTiny, 1e3});
  readVector<3>(gnss, "lever_arm", scenario.gnss_lever_arm_body);
  gnss.finish();
  auto attitude = yaml.section("attitude");
  attitude.number("rate", scenario.attitude_rate, {0.01, 1e4});
  attitude.angle("sigma_deg", scenario.attitude_sigma, {0, 90});
  attitude.angle("heading_sigma_deg", scenario.heading_sigma, {0, 90});
  attitude.finish();
  yaml.finish();
  return scenario;
}

}  // namespace sas_motion::usbl

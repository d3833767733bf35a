// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "sas_motion/math/random.hpp"
#include "sas_motion/navigation/attitude.hpp"
#include "sas_motion/systems/sins_dvl/scenario.hpp"

namespace sas_motion::sins {
namespace {

constexpr std::uint64_t kStartStream = 1, kDvlStream = 11;

Vector<3> gaussians(Random& random) {
  const double x = random.gaussian(), y = random.gaussian();
  return {x, y, random.gaussian()};
}

NavigationState wrongStart(const NavigationState& truth, const Scenario& scenario, std::uint64_t seed) {
  const Parameters& p = scenario.parameters;
  Random random(seed, kStartStream);
  NavigationState start = truth;
  displace(start, p.start_position.cwiseProduct(gaussians(random)));
  start.velocity_nav += p.start_velocity * gaussians(random);
  Vector<3> draw = gaussians(random);
  if (scenario.misaligned_by_sigma) draw = draw.cwiseSign();
  const Vector<3> phi = Vector<3>(p.start_tilt, p.start_tilt, p.start_heading).cwiseProduct(draw);
  start.q_nav_body = quaternionOf(-phi) * truth.q_nav_body;
  return start;
}

/// The errors of one DVL: offset and drift angle wander, the scale stays. (B.4)
class Dvl {
 public:
  Dvl(const Parameters& p, double period, std::uint64_t seed)
      : p_(p), period_(period), random_(seed, kDvlStream), errors_(Vector<kPaperStates>::Zero()) {
    errors_(kDvlOffset) = p.dvl_offset * random_.gaussian();
    errors_(kDvlScale) = p.dvl_scale * random_.gaussian();
    errors_(kDvlAngle) = p.dvl_angle * random_.gaussian();
  }

  ins::Aiding read(const ins::TruthSample& truth, const Vector<3>& noise) {
    wander(errors_(kDvlOffset), p_.dvl_offset, p_.dvl_offset_time);
    wander(errors_(kDvlAngle), p_.dvl_angle, p_.dvl_angle_time);
    const Vector<3> turning_body = ins::rateOverGround(truth.state, truth.rateBody()).cross(p_.dvl_lever_body);
    ins::Aiding reading;
    reading.velocity_body =
        View<kPaperStates>(truth.state).dvl(errors_, turning_body) + p_.dvl_white.cwiseProduct(noise);
    reading.variance = p_.dvl_white.cwiseAbs2();
    return reading;
  }

 private:
  void wander(double& error, double sigma, double time) {  // (0.5)
    const double decay = std::exp(-period_ / time);
    error = decay * error + sigma * std::sqrt(1 - decay * decay) * random_.gaussian();
  }

  Parameters p_;
  double period_;
  Random random_;
  Vector<kPaperStates> errors_;
};

/// Appends the readings of one sensor; `make(truth, noise)` reads it.
template <class Make>
void readAlong(const ins::Trajectory& trajectory, double duration, const ins::Scenario::Readings& readings,
               ins::Sensor sensor, std::uint64_t seed, Make make, std::vector<ins::LabelledAiding>& all) {
  ins::AidingSource source(readings, sensor, seed);
  for (long k = 1; static_cast<double>(k) / readings.rate <= duration + 1e-9; ++k) {
    const double time = static_cast<double>(k) / readings.rate;
    const ins::TruthSample truth = trajectory.at(time);
    source.read(
        time, [&](const Vector<3>& noise) { return make(truth, noise); }, all);
  }
}

}  // namespace

ins::Scenario withoutGps(const Scenario& scenario) {
  ins::Scenario other;
  other.name = scenario.name;
  other.duration = scenario.duration;
  other.track = scenario.track;
  other.imu_rate = scenario.imu_rate;
  other.sensor(ins::Sensor::Dvl) = scenario.dvl;
  other.sensor(ins::Sensor::Depth) = scenario.depth;
  other.parameters = inSmallAngles(scenario.parameters);
  other.parameters.dvl_rate = scenario.dvl.rate;
  return other;
}

ins::Recording simulate(const Scenario& scenario, const ins::Trajectory& trajectory, std::uint64_t seed) {
  const Parameters& p = scenario.parameters;
  ins::Recording run;
  run.start = wrongStart(trajectory.at(0).state, scenario, seed);
  run.imu = ins::perfectImu(trajectory, scenario.imu_rate, scenario.duration);
  ins::Parameters unit = withoutGps(scenario).parameters;
  unit.gyro_markov = 0;
  ins::addImuErrors(run.imu, unit, seed);
  Dvl dvl(p, 1 / scenario.dvl.rate, seed);
  const auto read_dvl = [&](const ins::TruthSample& truth, const Vector<3>& noise) { return dvl.read(truth, noise); };
  readAlong(trajectory, scenario.duration, scenario.dvl, ins::Sensor::Dvl, seed, read_dvl, run.aiding);
  const auto read_depth = [&](const ins::TruthSample& truth, const Vector<3>& noise) {
    ins::Aiding reading;
    reading.fix = truth.state;
    reading.fix.height += (truth.state.q_nav_body * p.depth_lever_body).z() + p.depth_white * noise(0);
    return reading;
  };
  readAlong(trajectory, scenario.duration, scenario.depth, ins::Sensor::Depth, seed, read_depth, run.aiding);
  ins::sortByStamp(run.aiding);
  return run;
}

}  // namespace sas_motion::sins

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/ins_gps_dvl/simulator.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sas_motion/math/random.hpp"
#include "sas_motion/navigation/earth.hpp"

namespace sas_motion::ins {
namespace {

constexpr std::uint64_t kStartStream = 1, kImuStream = 2, kMarkovStream = 10, kRowStream = 20, kSpellStream = 40,
                        kDvlMountingStream = 60;

Vector<3> gaussians(Random& random) {
  const double x = random.gaussian(), y = random.gaussian();
  return {x, y, random.gaussian()};
}

/// Three independent first-order Gauss-Markov processes of variance 1. (0.5)
class Markov {
 public:
  explicit Markov(Random& random) : value_(gaussians(random)) {}
  const Vector<3>& step(double T, double time_constant, Random& random) {
    const double decay = std::exp(-T / time_constant);
    return value_ = decay * value_ + std::sqrt(1 - decay * decay) * gaussians(random);
  }

 private:
  Vector<3> value_;
};

NavigationState wrongStart(const NavigationState& truth, const Parameters& p, std::uint64_t seed) {
  Random random(seed, kStartStream);
  NavigationState start = truth;
  displace(start, p.start_position.cwiseProduct(gaussians(random)));
  start.velocity_nav += p.start_velocity * gaussians(random);
  const Vector<3> phi = Vector<3>(p.start_tilt, p.start_tilt, p.start_heading).cwiseProduct(gaussians(random));
  start.q_nav_body = Eigen::Quaterniond(Eigen::AngleAxisd(-phi.norm(), phi.normalized())) * truth.q_nav_body;
  return start;
}

/// How this run's DVL is scaled and mounted.
struct DvlMounting {
  Matrix<3> distortion;
  Vector<3> lever_body;  ///< from the INS [m]
};

DvlMounting drawnMounting(const Parameters& p, std::uint64_t seed) {
  Random random(seed, kDvlMountingStream);
  const double scale = p.dvl_scale * random.gaussian();
  const Matrix<3> distortion = dvlDistortion(scale, p.dvl_misalignment * gaussians(random));
  return {distortion, p.dvl_lever_body + p.dvl_lever_sigma * gaussians(random)};
}

/// Reads the truth with a sensor's coloured errors.
class AidingModel {
 public:
  AidingModel(const Scenario& scenario, const Trajectory& trajectory, Sensor sensor, std::uint64_t seed)
      : parameters_(scenario.parameters),
        dpc_(scenario.dpc),
        trajectory_(trajectory),
        period_(1 / scenario.sensor(sensor).rate),
        sensor_(sensor),
        mounting_(drawnMounting(scenario.parameters, seed)),
        random_(seed, kMarkovStream + static_cast<std::uint64_t>(sensor)),
        markov_(random_) {}

  Aiding read(const TruthSample& truth, double time, const Vector<3>& noise) {
    const Parameters& p = parameters_;
    switch (sensor_) {
      case Sensor::Gps:
        return gps(truth, p.gps_markov.cwiseProduct(markov_.step(period_, p.gps_time, random_)) +
                              p.gps_white.cwiseProduct(noise));
      case Sensor::Dvl:
        return dvl(truth, p.dvl_markov * markov_.step(period_, p.dvl_time, random_) + p.dvl_white.cwiseProduct(noise));
      case Sensor::Depth: return depth(truth, p.depth_white * noise(0));
      case Sensor::Dpc: return dpc(truth, time, {dpc_.white_along * noise(0), dpc_.white_sight * noise(1)});
    }
    return {};
  }

 private:
  Aiding gps(const TruthSample& truth, const Vector<3>& error) const {
    Aiding reading;
    reading.fix = truth.state;
    displace(reading.fix, truth.state.q_nav_body * parameters_.gps_lever_body + error);
    return reading;
  }
  Aiding dvl(const TruthSample& truth, const Vector<3>& error) const {
    const auto& state = truth.state;
    const Vector<3> rate = truth.rateBody() - state.q_nav_body.conjugate() * earth::rotationRate(state.latitude);
    Aiding reading;
    reading.velocity_body =
        mounting_.distortion * (state.q_nav_body.conjugate() * state.velocity_nav + rate.cross(mounting_.lever_body)) +
        error;
    return reading;
  }
  /// From a ping half an interval earlier to one half an interval later; on the axes between.
  Aiding dpc(const TruthSample& truth, double time, const Vector<2>& error) const {
    const double half = 0.5 * period_;
    const auto array = [&](double t) {
      NavigationState state = trajectory_.at(t).state;
      displace(state, state.q_nav_body * parameters_.dpc_lever_body);
      return state;
    };
    const Vector<3> moved_body =
        truth.state.q_nav_body.conjugate() * displacement(array(time - half), array(time + half));
    Aiding reading;
    reading.array.sight_body = dpc_.sightBody();
    reading.array.velocity = Vector<2>(moved_body.y(), moved_body.dot(reading.array.sight_body)) / period_ + error;
    reading.array.variance << dpc_.white_along * dpc_.white_along, dpc_.white_sight * dpc_.white_sight;
    return reading;
  }
  Aiding depth(const TruthSample& truth, double error) const {
    Aiding reading;
    reading.fix = truth.state;
    reading.fix.height += (truth.state.q_nav_body * parameters_.depth_lever_body).z() + error;
    return reading;
  }

  const Parameters& parameters_;
  const Scenario::Dpc& dpc_;
  const Trajectory& trajectory_;
  double period_;  // of the readings [s]
  Sensor sensor_;
  DvlMounting mounting_;
  Random random_;
  Markov markov_;
};

}  // namespace

void addImuErrors(std::vector<ImuReading>& readings, const Parameters& p, std::uint64_t seed) {
  Random random(seed, kImuStream);
  const Vector<3> gyro_constant = p.gyro_constant * gaussians(random),
                  bias = p.accelerometer_constant * gaussians(random);
  Markov drift(random);
  for (std::size_t k = 1; k < readings.size(); ++k) {
    const double T = secondsBetween(readings[k - 1].stamp, readings[k].stamp);
    readings[k].rate_body += gyro_constant + p.gyro_markov * drift.step(T, p.gyro_time, random) +
                             p.angle_random_walk / std::sqrt(T) * gaussians(random);
    readings[k].force_body += bias + p.velocity_random_walk / std::sqrt(T) * gaussians(random);
  }
}

AidingSource::AidingSource(const Scenario::Readings& readings, Sensor sensor, std::uint64_t seed)
    : readings_(readings), sensor_(sensor) {
  const auto first = kRowStream + 4 * static_cast<std::uint64_t>(sensor);
  for (int row = 0; row < rowsOf(sensor); ++row)
    rows_.emplace_back(readings_.noise, seed, first + static_cast<std::uint64_t>(row),
                       kSpellStream + static_cast<std::uint64_t>(sensor));
}

void AidingSource::read(double time, const std::function<Aiding(const Vector<3>&)>& make,
                        std::vector<LabelledAiding>& all) {
  LabelledAiding labelled;
  Vector<3> noise = Vector<3>::Zero();
  bool missing = false, frozen = false;
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    const NoiseSample sample = rows_[row].draw(time);
    const auto axis = static_cast<Eigen::Index>(row);
    noise(axis) = sample.value;
    labelled.outlier[row] = sample.outlier;
    labelled.variance(axis) = sample.variance;
    missing |= sample.missing;
    frozen |= sample.frozen;
  }
  labelled.reading = make(noise);
  if (frozen && last_) labelled.reading = *last_;
  labelled.reading.stamp = stampFromSeconds(time);
  labelled.reading.sensor = sensor_;
  last_ = labelled.reading;
  const auto in = [&](const Outage& outage) { return time >= outage.begin && time <= outage.end; };
  if (!missing && std::none_of(readings_.outages.begin(), readings_.outages.end(), in)) all.push_back(labelled);
}

void sortByStamp(std::vector<LabelledAiding>& aiding) {
  std::stable_sort(aiding.begin(), aiding.end(),
                   [](const LabelledAiding& a, const LabelledAiding& b) { return a.reading.stamp < b.reading.stamp; });
}

std::vector<ImuReading> perfectImu(const Trajectory& trajectory, double rate, double duration) {
  std::vector<ImuReading> readings{{}};  // the first only marks the begin of time
  for (long k = 1; static_cast<double>(k) / rate <= duration + 1e-9; ++k)
    readings.push_back(trajectory.imu(static_cast<double>(k - 1) / rate, static_cast<double>(k) / rate));
  return readings;
}

Recording simulate(const Scenario& scenario, const Trajectory& trajectory, std::uint64_t seed) {
  Recording run;
  run.start = wrongStart(trajectory.at(0).state, scenario.parameters, seed);
  run.imu = perfectImu(trajectory, scenario.imu_rate, scenario.duration);
  addImuErrors(run.imu, scenario.parameters, seed);
  for (const auto sensor : {Sensor::Gps, Sensor::Dvl, Sensor::Depth, Sensor::Dpc}) {
    const double rate = scenario.sensor(sensor).rate;
    if (!(rate > 0)) continue;
    AidingSource source(scenario.sensor(sensor), sensor, seed);
    AidingModel model(scenario, trajectory, sensor, seed);
    const double early = sensor == Sensor::Dpc ? 0.5 / rate : 0;  // the middle between two pings
    for (long k = 1; static_cast<double>(k) / rate <= scenario.duration + 1e-9; ++k) {
      const double time = static_cast<double>(k) / rate - early;
      source.read(
          time, [&](const Vector<3>& noise) { return model.read(trajectory.at(time), time, noise); }, run.aiding);
    }
  }
  sortByStamp(run.aiding);
  return run;
}

}  // namespace sas_motion::ins

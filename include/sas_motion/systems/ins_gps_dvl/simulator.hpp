// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "sas_motion/noise/noise_source.hpp"
#include "sas_motion/systems/ins_gps_dvl/scenario.hpp"

namespace sas_motion::ins {

/// A reading with the simulator's labels.
struct LabelledAiding {
  Aiding reading;
  std::array<bool, 3> outlier{};
  Vector<3> variance = Vector<3>::Ones();  ///< of this draw's white noise, over the good one [-]
};

/// All that was recorded of one simulated run; stamps are since its start.
struct Recording {
  NavigationState start;  ///< the INS's when it starts
  std::vector<ImuReading> imu;
  std::vector<LabelledAiding> aiding;  ///< in time order
};

/// The IMU along a trajectory without any error.
std::vector<ImuReading> perfectImu(const Trajectory& trajectory, double rate, double duration);

/// Adds constants, a Gauss-Markov drift and white noise to what an IMU reads. (C.1)
void addImuErrors(std::vector<ImuReading>& readings, const Parameters& parameters, std::uint64_t seed);

/// One of the sensors that aid: its rows of white noise, when it is silent, and when it repeats its last reading.
class AidingSource {
 public:
  AidingSource(const Scenario::Readings& readings, Sensor sensor, std::uint64_t seed);

  /// Appends the reading at a time, unless there is none. `make(noise)` reads with white noise of variance 1.
  void read(double time, const std::function<Aiding(const Vector<3>&)>& make, std::vector<LabelledAiding>& all);

 private:
  Scenario::Readings readings_;
  Sensor sensor_;
  std::vector<NoiseSource> rows_;
  std::optional<Aiding> last_;
};

/// In the order of their stamps; those of one stamp stay as they are.
void sortByStamp(std::vector<LabelledAiding>& aiding);

/// Draws a run: (0.4) with the errors of (C.1), (C.3), (C.4). The same scenario and seed give the same numbers; sensors
/// have streams of their own.
Recording simulate(const Scenario& scenario, const Trajectory& trajectory, std::uint64_t seed);

}  // namespace sas_motion::ins

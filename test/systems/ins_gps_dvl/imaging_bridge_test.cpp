// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/ins_gps_dvl/imaging_bridge.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sas_motion/navigation/earth.hpp"
#include "sas_motion/systems/ins_gps_dvl/simulator.hpp"

namespace sas_motion::ins {
namespace {

constexpr double kPingRate = 8;  // [Hz]

imaging::SonarDescription arraySonar() {
  imaging::SonarDescription sonar;
  sonar.ping_rate = kPingRate;
  sonar.transmitter_body = {1.2, -0.4, -0.3};
  sonar.receiver_array_body = {0.8, -0.6, -0.3};
  return sonar;
}

/// Ten seconds of the default track in its waves, with what a displaced phase centre antenna says without any error.
class WavySurvey {
 public:
  WavySurvey() {
    for (double time = 0; time <= 10; time += 0.01) poses_.push_back(pose(time));
    believed = imaging::Trajectory(poses_);
  }

  /// Between pings at a time and one interval later.
  imaging::Micronavigation found(double time) const {
    imaging::Micronavigation result;
    result.verdict = imaging::MicronavigationVerdict::Valid;
    result.delay = 0.02;
    result.sight_body = {0, -std::cos(0.35), -std::sin(0.35)};
    result.along_sigma = 1e-4;
    result.sight_sigma = 5e-6;
    const Eigen::Quaterniond half = pose(time).q_local_body.slerp(0.5, pose(time + 1 / kPingRate).q_local_body);
    const Eigen::Vector3d moved_body =
        half.conjugate() * (phaseCentreOf(time + 1 / kPingRate, result.delay) - phaseCentreOf(time, result.delay));
    result.along = moved_body.x();
    result.sight = moved_body.dot(result.sight_body);
    return result;
  }

  Aiding reading(double time, const imaging::Trajectory& belief) const {
    return dpcReading(found(time), arraySonar(), belief, stampFromSeconds(time),
                      stampFromSeconds(time + 1 / kPingRate));
  }

  /// Of the phase centre, forward and along the sight.
  Vector<2> trueVelocity(const Aiding& reading) const {
    const TruthSample truth = trajectory.at(secondsBetween(0, reading.stamp));
    const Eigen::Quaterniond C_body_nav = truth.state.q_nav_body.conjugate();
    const Vector<3> rate = truth.rateBody() - C_body_nav * earth::rotationRate(truth.state.latitude);
    const Vector<3> velocity_body = C_body_nav * truth.state.velocity_nav + rate.cross(phaseCentre(arraySonar()));
    return {velocity_body.y(), velocity_body.dot(reading.array.sight_body)};
  }

  /// A belief that is off by 0.1 m/s, a constant of 30 m and a heading of 2 mrad.
  imaging::Trajectory wrongBelief() const {
    std::vector<imaging::TimedPose> poses = poses_;
    const Eigen::Quaterniond turned(Eigen::AngleAxisd(2e-3, Eigen::Vector3d::UnitZ()));
    for (auto& each : poses) {
      each.position += Eigen::Vector3d(30, 0, 0) + Eigen::Vector3d(0.06, -0.08, 0) * secondsBetween(0, each.stamp);
      each.q_local_body = turned * each.q_local_body;
    }
    return imaging::Trajectory(poses);
  }

  Trajectory trajectory{{}, 20};
  imaging::Trajectory believed;

 private:
  imaging::TimedPose pose(double time) const { return poseIn(map_, stampFromSeconds(time), trajectory.at(time).state); }
  Eigen::Vector3d place(double time, const Eigen::Vector3d& lever_body) const {
    const auto here = pose(time);
    return here.position + here.q_local_body * lever_body;
  }
  /// Between the transmitter at transmission and the receivers at reception.
  Eigen::Vector3d phaseCentreOf(double ping, double delay) const {
    return (place(ping, arraySonar().transmitter_body) + place(ping + 2 * delay, arraySonar().receiver_array_body)) / 2;
  }

  LocalFrame map_{Track().start};
  std::vector<imaging::TimedPose> poses_;
};

TEST(ImagingBridge, TurnsForwardPortUpToStarboardForwardUp) {
  EXPECT_TRUE(phaseCentre(arraySonar()).isApprox(Vector<3>(0.5, 1, -0.3)));
  const NavigationState level;  // faces north
  const auto pose = poseIn(LocalFrame(Geodetic{0, 0, 0}), 0, level);
  EXPECT_TRUE((pose.q_local_body * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY()));   // forward
  EXPECT_TRUE((pose.q_local_body * Eigen::Vector3d::UnitY()).isApprox(-Eigen::Vector3d::UnitX()));  // port
}

TEST(ImagingBridge, ReadsTheVelocityInTheMiddleOfADisplacement) {
  const WavySurvey survey;
  double unturned = 0;
  for (double time = 1; time < 9; time += 0.37) {
    const Aiding reading = survey.reading(time, survey.believed);
    EXPECT_EQ(reading.sensor, Sensor::Dpc);
    EXPECT_NEAR(secondsBetween(0, reading.stamp), time + 0.5 / kPingRate + 0.02, 1e-8);
    const Vector<2> error = reading.array.velocity - survey.trueVelocity(reading);
    EXPECT_LT(error.norm(), 5e-5) << time;  // what lies between poses 10 ms apart
    unturned = std::max(unturned, std::abs(survey.found(time).sight * kPingRate - survey.trueVelocity(reading)(1)));
    EXPECT_DOUBLE_EQ(reading.array.variance(0), 1e-8 * kPingRate * kPingRate);
    EXPECT_DOUBLE_EQ(reading.array.variance(1), 25e-12 * kPingRate * kPingRate);
  }
  EXPECT_GT(unturned, 1e-3);  // what the displacement over T alone would be off by along the sight
}

TEST(ImagingBridge, ReadsTheSameFromAWrongBelief) {
  const WavySurvey survey;
  const imaging::Trajectory wrong = survey.wrongBelief();
  for (double time = 1; time < 9; time += 0.37)
    EXPECT_LT(
        (survey.reading(time, wrong).array.velocity - survey.reading(time, survey.believed).array.velocity).norm(),
        1e-4);
}

TEST(ImagingBridge, ReadsWhatTheSimulatorReads) {
  WavySurvey survey;
  Scenario scenario;
  scenario.duration = 10;
  scenario.sensor(Sensor::Dpc).rate = kPingRate;
  scenario.dpc = {0, 0, 0.35, true};
  scenario.parameters.dpc_lever_body = phaseCentre(arraySonar());
  int compared = 0;
  for (const auto& simulated : simulate(scenario, survey.trajectory, 1).aiding) {
    const double middle = secondsBetween(0, simulated.reading.stamp);
    if (simulated.reading.sensor != Sensor::Dpc || middle < 1 || middle > 9) continue;
    const Aiding reading = survey.reading(middle - 0.5 / kPingRate - 0.02, survey.believed);
    EXPECT_LT((reading.array.sight_body - simulated.reading.array.sight_body).norm(), 1e-12);
    EXPECT_LT((reading.array.velocity - simulated.reading.array.velocity).norm(),
              3e-4);  // the simulator's is the mean over T, v'' T^2 / 24 away
    ++compared;
  }
  EXPECT_EQ(compared, 64);
}

TEST(ImagingBridge, RefusesABeliefThatEndsBeforeTheEcho) {
  const WavySurvey survey;
  EXPECT_THROW(survey.reading(9.86, survey.believed), std::invalid_argument);
}

}  // namespace
}  // namespace sas_motion::ins

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Errors of micronavigate() on simulated speckle beside the standard deviations it reports: bias, spread and mean
// normalised squared error. usage: micronavigation_accuracy [PAIRS]
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "sas_motion/imaging/echo_lines.hpp"
#include "sas_motion/imaging/echo_simulation.hpp"
#include "sas_motion/imaging/micronavigation.hpp"
#include "sas_motion/io/cpu_time.hpp"
#include "sas_motion/math/angles.hpp"
#include "sas_motion/math/random.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::imaging;

constexpr int kThreads = 2;

/// Under way 10 m over the bottom, in waves of about 6 s.
PingPose waves(double t, double speed) {
  const auto position = [speed](double s) {
    return Eigen::Vector3d(speed * s + 0.02 * std::sin(1.3 * s), 0.15 * std::sin(1.05 * s + 0.4),
                           10 + 0.2 * std::sin(1.05 * s));
  };
  PingPose pose;
  pose.position = position(t);
  pose.velocity = (position(t + 1e-4) - position(t - 1e-4)) / 2e-4;
  pose.C_local_body = (Eigen::AngleAxisd(0.02 * std::sin(0.7 * t), Eigen::Vector3d::UnitZ()) *
                       Eigen::AngleAxisd(0.02 * std::sin(1.05 * t + 1), Eigen::Vector3d::UnitY()) *
                       Eigen::AngleAxisd(0.04 * std::sin(1.2 * t + 2), Eigen::Vector3d::UnitX()))
                          .toRotationMatrix();
  return pose;
}

struct Statistics {
  int count = 0;
  double sum = 0, squares = 0, normalised = 0, sigma = 0;
  void add(double error, double s) {
    ++count;
    sum += error;
    squares += error * error;
    normalised += error * error / (s * s);
    sigma += s;
  }
  void print(const char* name, double unit, const char* unit_name) const {
    const double mean = sum / count, deviation = std::sqrt(squares / count - mean * mean);
    fmt::print("  {:<6} bias {:8.2f} +- {:.2f}, spread {:8.2f}, sigma {:8.2f} {}, NEES {:.2f}\n", name, mean / unit,
               deviation / unit / std::sqrt(count), deviation / unit, sigma / count / unit, unit_name,
               normalised / count);
  }
};

struct Case {
  const char* name;
  double noise;        // of a raw sample
  bool believed_true;  // else a straight track at the mean speed, with the attitude of the truth
};

void run(const Case& setting, int pairs) {
  SonarDescription sonar;
  sonar.near_range = 22;
  sonar.far_range = 38;
  sonar.pulse_length = 2e-3;
  Statistics along, sight, turn;
  double coherence = 0, seconds = 0;
  int refused = 0;
  for (int i = 0; i < pairs; ++i) {
    const double t = 1.37 * i, speed = 1.2 + 0.6 * std::fmod(0.618 * i, 1.0);  // any share of a phase centre
    const std::vector<PingPose> truth{waves(t, speed), waves(t + 1 / sonar.ping_rate, speed)};
    SpeckleOptions bottom;
    bottom.density = 200;
    bottom.lower = truth[0].position + Eigen::Vector3d(-8, 18, -truth[0].position.z());
    bottom.upper = bottom.lower + Eigen::Vector3d(16, 20, 0);
    EchoOptions echoes;
    echoes.noise = setting.noise;
    echoes.seed = static_cast<std::uint64_t>(i);
    echoes.threads = kThreads;
    CompressionOptions compression;
    compression.threads = kThreads;
    const EchoLines lines = compressRange(
        simulateEchoes(sonar, echoPaths(sonar, truth), speckleScene(bottom, {}, static_cast<std::uint64_t>(i)), echoes),
        sonar, compression);
    std::vector<PingPose> believed = truth;
    if (!setting.believed_true) {
      believed[0].velocity = believed[1].velocity = {speed, 0, 0};
      believed[1].position = believed[0].position + believed[0].velocity / sonar.ping_rate;
    }
    const double begin = cpuSeconds();
    const Micronavigation found = micronavigate(lines, 0, sonar, believed[0], believed[1], {});
    seconds += cpuSeconds() - begin;
    if (found.verdict != MicronavigationVerdict::Valid) {
      ++refused;
      fmt::print("  refused: {}\n", describe(found.verdict));
      continue;
    }
    const Eigen::Matrix3d C = Eigen::Quaterniond(truth[0].C_local_body)
                                  .slerp(0.5, Eigen::Quaterniond(truth[1].C_local_body))
                                  .toRotationMatrix();
    const Eigen::Vector3d moved =
        C.transpose() * (truth[1].position - truth[0].position + (truth[1].velocity - truth[0].velocity) * found.delay);
    along.add(found.along - moved.x(), found.along_sigma);
    sight.add(found.sight - moved.dot(found.sight_body), found.sight_sigma);
    turn.add(found.turn -
                 (C.transpose() * (truth[1].C_local_body.col(0) - truth[0].C_local_body.col(0))).dot(found.sight_body),
             found.turn_sigma);
    coherence += found.coherence;
  }
  fmt::print("{}: coherence {:.3f}, {} refused, {:.0f} ms of CPU a pair\n", setting.name, coherence / along.count,
             refused, 1e3 * seconds / pairs);
  along.print("along", 1e-6, "um");
  sight.print("sight", 1e-6, "um");
  turn.print("turn", 1e-6, "urad");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const int pairs = argc > 1 ? std::atoi(argv[1]) : 24;
  for (const Case& setting :
       {Case{"true path believed, no noise", 0, true}, Case{"straight path believed, no noise", 0, false},
        Case{"true path believed, noise", 0.7, true}, Case{"straight path believed, noise", 0.7, false},
        Case{"straight path believed, much noise", 2, false}})
    run(setting, pairs);
}

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/micronavigation.hpp"

#include <Eigen/Geometry>
#include <limits>

#include "imaging/imaging_support.hpp"

namespace sas_motion::imaging::testing {
namespace {

SonarDescription arraySonar() {
  SonarDescription sonar;
  sonar.receivers = 6;
  sonar.pulse_length = 1e-3;
  sonar.near_range = 24;
  sonar.far_range = 34;
  return sonar;
}

/// In waves of about 6 s.
PingPose wavering(double t, double speed = 1.3) {
  const auto position = [speed](double s) {
    return Eigen::Vector3d(speed * s, 0.15 * std::sin(1.05 * s + 0.4), 10 + 0.2 * std::sin(1.05 * s));
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

std::vector<PingPose> waveringPair(double t, double speed = 1.3) {
  return {wavering(t, speed), wavering(t + 1 / arraySonar().ping_rate, speed)};
}

Scene bottomUnder(const PingPose& pose, std::uint64_t seed) {
  SpeckleOptions options;
  options.density = 150;
  options.lower = pose.position + Eigen::Vector3d(-7, 20, -pose.position.z());
  options.upper = options.lower + Eigen::Vector3d(14.5, 15, 0);
  return speckleScene(options, {}, seed);
}

EchoLines echoes(const SonarDescription& sonar, const std::vector<PingPose>& poses, std::uint64_t seed,
                 EchoOptions options = {}) {
  options.seed = seed;
  return compressedEchoes(sonar, echoPaths(sonar, poses), bottomUnder(poses[0], seed), options, RangeFilter::Matched);
}

/// On body axes half-way, of the array's middle.
Eigen::Vector3d trueDisplacement(const std::vector<PingPose>& poses, double delay) {
  const Eigen::Matrix3d C = Eigen::Quaterniond(poses[0].C_local_body)
                                .slerp(0.5, Eigen::Quaterniond(poses[1].C_local_body))
                                .toRotationMatrix();
  return C.transpose() * (poses[1].position - poses[0].position + delay * (poses[1].velocity - poses[0].velocity));
}

struct ErrorStatistics {
  double sum = 0, normalised = 0;
  int count = 0;
  void add(double error, double sigma) {
    sum += error / sigma;
    normalised += error * error / (sigma * sigma);
    ++count;
  }
  /// A bias far below the standard deviation, and a mean normalised squared error inside the 99.8 % band of 20 draws.
  void expectConsistent(const char* name) const {
    EXPECT_LT(std::abs(sum / count), 3.1 / std::sqrt(count)) << name;
    EXPECT_GT(normalised / count, 0.29) << name;
    EXPECT_LT(normalised / count, 2.29) << name;
  }
};

TEST(Micronavigation, ErrorsAreWhatItsStandardDeviationsSay) {
  const SonarDescription sonar = arraySonar();
  ErrorStatistics along, sight, turn;
  EchoOptions noisy;
  noisy.noise = 0.7;
  for (int i = 0; i < 20; ++i) {
    const auto poses = waveringPair(1.37 * i, 1.0 + 0.5 * std::fmod(0.618 * i, 1.0));  // any share of a phase centre
    const auto found =
        micronavigate(echoes(sonar, poses, static_cast<std::uint64_t>(i), noisy), 0, sonar, poses[0], poses[1], {});
    ASSERT_EQ(found.verdict, MicronavigationVerdict::Valid);
    const Eigen::Vector3d moved = trueDisplacement(poses, found.delay);
    along.add(found.along - moved.x(), found.along_sigma);
    sight.add(found.sight - moved.dot(found.sight_body), found.sight_sigma);
    const Eigen::Vector3d fore =
        poses[0].C_local_body.transpose() * poses[1].C_local_body.col(0);  // on the first ping's axes
    turn.add(found.turn - fore.dot(found.sight_body), found.turn_sigma);
    EXPECT_LT(found.along_sigma, 1e-3);
    EXPECT_LT(found.sight_sigma, 0.1e-3);
    EXPECT_NEAR(found.sight_body.norm(), 1, 1e-9);
    EXPECT_NEAR(found.delay, 29 / sonar.sound_speed, 2e-3);
  }
  along.expectConsistent("along");
  sight.expectConsistent("sight");
  turn.expectConsistent("turn");
}

TEST(Micronavigation, FindsTheSameFromAWrongBelief) {
  const SonarDescription sonar = arraySonar();
  const auto poses = waveringPair(2);
  const EchoLines lines = echoes(sonar, poses, 3);
  const auto right = micronavigate(lines, 0, sonar, poses[0], poses[1], {});
  for (const Eigen::Vector3d& error :
       {Eigen::Vector3d(0.03, 0.05, -0.02), Eigen::Vector3d(-0.1, -0.06, 0), Eigen::Vector3d(0, 0.0075, 0)}) {
    PingPose wrong = poses[1];
    wrong.position += error;
    const auto found = micronavigate(lines, 0, sonar, poses[0], wrong, {});
    ASSERT_EQ(found.verdict, MicronavigationVerdict::Valid) << describe(found.verdict);
    EXPECT_NEAR(found.along, right.along, 0.3 * right.along_sigma);
    EXPECT_NEAR(found.sight, right.sight, 0.3 * right.sight_sigma);
    EXPECT_NEAR(found.turn, right.turn, 0.3 * right.turn_sigma);
  }
}

TEST(Micronavigation, LooksToStarboardAsToPort) {
  const SonarDescription sonar = arraySonar();
  std::vector<PingPose> poses(2);
  poses[0].position = {0, 0, 10};
  poses[1].position = {0.16, -0.01, 10.004};
  poses[0].velocity = poses[1].velocity = {1.3, 0, 0};
  Scene scene = bottomUnder(poses[0], 5);
  for (auto& scatterer : scene.scatterers) scatterer.position.y() *= -1;
  MicronavigationOptions options;
  options.starboard = true;
  const auto found = micronavigate(compressedEchoes(sonar, echoPaths(sonar, poses), scene, {}, RangeFilter::Matched), 0,
                                   sonar, poses[0], poses[1], options);
  ASSERT_EQ(found.verdict, MicronavigationVerdict::Valid);
  EXPECT_LT(found.sight_body.y(), -0.9);
  EXPECT_LT(found.sight_body.z(), -0.3);
  EXPECT_NEAR(found.sight, (poses[1].position - poses[0].position).dot(found.sight_body), 5 * found.sight_sigma);
}

TEST(Micronavigation, DoesNotFeelADelayCommonToBothPings) {
  const SonarDescription sonar = arraySonar();
  const auto poses = waveringPair(1);
  const auto plain = micronavigate(echoes(sonar, poses, 4), 0, sonar, poses[0], poses[1], {});
  EchoOptions late;
  late.slant_errors.assign(12, 0.05);
  const auto common = micronavigate(echoes(sonar, poses, 4, late), 0, sonar, poses[0], poses[1], {});
  EXPECT_NEAR(common.along, plain.along, plain.along_sigma);
  EXPECT_NEAR(common.sight, plain.sight, 3 * plain.sight_sigma);
  for (std::size_t i = 0; i < 6; ++i) late.slant_errors[i] = 0;
  const auto second = micronavigate(echoes(sonar, poses, 4, late), 0, sonar, poses[0], poses[1], {});
  ASSERT_EQ(second.verdict, MicronavigationVerdict::Valid);
  EXPECT_NEAR(second.sight, plain.sight - 0.05,
              1e-3);  // a delay is the same at all ranges, a displacement is not quite
}

TEST(Micronavigation, RefusesWhatIsNotAlike) {
  const SonarDescription sonar = arraySonar();
  const auto poses = waveringPair(0);
  EchoLines lines = echoes(sonar, poses, 1);
  const EchoLines others = echoes(sonar, poses, 2);
  std::copy(others.line(6), others.line(6) + 6 * others.samples,
            lines.line(6));  // the second ping heard another bottom
  EXPECT_EQ(micronavigate(lines, 0, sonar, poses[0], poses[1], {}).verdict, MicronavigationVerdict::Incoherent);
  EchoOptions noise;
  noise.noise = 1;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    noise.seed = seed;
    const EchoLines noise_only = compressedEchoes(sonar, echoPaths(sonar, poses), {}, noise, RangeFilter::Matched);
    EXPECT_EQ(micronavigate(noise_only, 0, sonar, poses[0], poses[1], {}).verdict, MicronavigationVerdict::Incoherent);
  }
  std::fill(lines.data.begin(), lines.data.end(), 0);
  EXPECT_EQ(micronavigate(lines, 0, sonar, poses[0], poses[1], {}).verdict, MicronavigationVerdict::Incoherent);
}

TEST(Micronavigation, RefusesPingsWithoutOverlapAndEchoesThatAreNotFinite) {
  const SonarDescription sonar = arraySonar();
  auto poses = waveringPair(0);
  EchoLines lines = echoes(sonar, poses, 1);
  PingPose far = poses[1];
  far.position.x() += 0.2;
  EXPECT_EQ(micronavigate(lines, 0, sonar, poses[0], far, {}).verdict, MicronavigationVerdict::NoOverlap);
  lines.line(7)[100] = {std::numeric_limits<float>::quiet_NaN(), 0};
  const auto refused = micronavigate(lines, 0, sonar, poses[0], poses[1], {});
  EXPECT_EQ(refused.verdict, MicronavigationVerdict::NotFinite);
  EXPECT_STREQ(describe(refused.verdict), "an echo is not finite");
}

TEST(Micronavigation, RefusesABandTooNarrowToTellWavelengthsApart) {
  SonarDescription sonar = arraySonar();
  sonar.bandwidth = 8e3;
  sonar.pulse_length = 4e-3;
  const auto poses = waveringPair(0);
  EchoOptions noisy;
  noisy.noise = 1.5;
  EXPECT_EQ(micronavigate(echoes(sonar, poses, 1, noisy), 0, sonar, poses[0], poses[1], {}).verdict,
            MicronavigationVerdict::Ambiguous);
}

TEST(Micronavigation, OfAllPingsIsTheSameForAnyNumberOfThreads) {
  const SonarDescription sonar = arraySonar();
  const std::vector<PingPose> poses{wavering(0), wavering(0.125), wavering(0.25), wavering(0.375)};
  const EchoLines lines = echoes(sonar, poses, 8);
  MicronavigationOptions options;
  const auto one = micronavigate(lines, sonar, poses, options);
  options.threads = 3;
  const auto three = micronavigate(lines, sonar, poses, options);
  ASSERT_EQ(one.size(), 3u);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].verdict, MicronavigationVerdict::Valid);
    EXPECT_EQ(one[i].along, three[i].along);
    EXPECT_EQ(one[i].sight, three[i].sight);
    EXPECT_EQ(one[i].sight, micronavigate(lines, i, sonar, poses[i], poses[i + 1], options).sight);
  }
}

TEST(Micronavigation, NeedsAnArrayAndItsLines) {
  SonarDescription sonar = arraySonar();
  const auto poses = waveringPair(0);
  const EchoLines lines = echoes(sonar, poses, 1);
  EXPECT_THROW(micronavigate(lines, 1, sonar, poses[0], poses[1], {}), std::invalid_argument);
  EXPECT_THROW(micronavigate(lines, sonar, {poses[0], poses[1], poses[1]}, {}), std::invalid_argument);
  EXPECT_TRUE(micronavigate(lines, sonar, {poses[0]}, {}).empty());
  SonarDescription short_swath = sonar;
  short_swath.far_range = sonar.near_range + 1.5;
  EXPECT_THROW(micronavigate(lines, 0, short_swath, poses[0], poses[1], {}), std::invalid_argument);
  sonar.receivers = 1;
  EXPECT_THROW(micronavigate(lines, 0, sonar, poses[0], poses[1], {}), std::invalid_argument);
}

}  // namespace
}  // namespace sas_motion::imaging::testing

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Several instruments of a kind.
#include "sas_motion/config/source_options.hpp"
#include "systems/towfish/feeding.hpp"

namespace sas_motion::towfish {
namespace {

/// The paper's motion, seen by two GNSS receivers, one of them 2 m before the reference point, and two gyrocompasses.
Scenario twoOfEach(double duration) {
  Scenario scenario = testing::zhu2007(duration);
  scenario.source(Sensor::Position).lever_arm_body << 2, 0;
  for (const Sensor kind : {Sensor::Position, Sensor::Heading}) {
    SimulatedSource second = scenario.source(kind);
    second.sensor = kind;
    second.name = kind == Sensor::Position ? "gnss_aft" : "gyro_2";
    second.lever_arm_body.setZero();
    second.sigma *= 1.5;
    scenario.sources.push_back(second);
  }
  return scenario;
}

TEST(Sources, ErrorsWithTwoOfAKindAreWhatTheCovariancePredicts) {
  constexpr int kRuns = 100;
  const Scenario scenario = twoOfEach(100);
  const Config config = testing::configFor(scenario);
  std::cout << "seeds 1 to " << kRuns << "\n";
  double nees = 0, squares = 0, predicted = 0, with_one = 0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const auto run = testing::simulate(scenario, seed);
    const Estimate last = testing::feed("kf", config, run.measurements).solutions.back();
    const StateVector error = Model::difference(last.belief.mean, run.truthAt(last.stamp));
    nees += error.dot(last.belief.covariance.llt().solve(error)) / kRuns;
    squares += error.head<2>().squaredNorm() / kRuns;
    predicted += last.belief.covariance.diagonal().head<2>().sum() / kRuns;
    auto first_alone = run.measurements;
    first_alone.erase(
        std::remove_if(first_alone.begin(), first_alone.end(), [](const auto& z) { return sourceOf(z) >= kSensors; }),
        first_alone.end());
    with_one +=
        testing::feed("kf", config, first_alone).solutions.back().belief.covariance.diagonal().head<2>().sum() / kRuns;
  }
  std::cout << "NEES " << nees << ", position RMSE " << std::sqrt(squares) << " m of " << std::sqrt(predicted)
            << " m predicted; " << std::sqrt(with_one) << " m by one of each\n";
  const Band band = averageChiSquaredBand(kStates, kRuns, 0.999);
  EXPECT_GT(nees, band.lower);
  EXPECT_LT(nees, band.upper);
  EXPECT_NEAR(squares / predicted, 1, 4 * std::sqrt(1.0 / kRuns));  // a chi-squared of two degrees over 100 runs
  EXPECT_LT(predicted, 0.9 * with_one);
}

TEST(Sources, EachIsAuditedByItsOwnNameAndAFaultyOneLeavesTheOtherAlone) {
  // GIVEN two GNSS receivers, WHEN one of them is 50 m off for 15 s, less than it takes to be accepted again, THEN it
  // alone is down-weighted, by its name, and the estimate stays
  const Scenario scenario = twoOfEach(100);
  const auto faulty = [](Stamp stamp) {
    const double t = secondsBetween(Simulator::kStart, stamp);
    return t > 50 && t < 65;
  };
  auto run = testing::simulate(scenario, 7);
  for (auto& z : run.measurements)
    if (sourceName(z) == std::string("gnss_aft") && faulty(z.stamp)) z.value(0) += 50;
  const auto output = testing::feed("mixture_kf", testing::configFor(scenario), run.measurements);
  std::map<std::string, std::pair<int, int>> of;  // measurements and those that were not accepted, in these seconds
  for (const auto& audit : output.audits)
    if (faulty(audit.stamp)) {
      auto& [all, refused] = of[std::string(audit.sensor)];
      ++all;
      refused += audit.verdict != Verdict::Accepted;
    }
  ASSERT_EQ(of.count("gnss_aft"), 1u);
  ASSERT_EQ(of.count("gyro_2"), 1u);
  EXPECT_EQ(of["gnss_aft"].first, of["position"].first);
  EXPECT_GT(of["gnss_aft"].second, 0.9 * of["gnss_aft"].first);
  EXPECT_LT(of["position"].second, 0.2 * of["position"].first);
  for (const auto& estimate : output.solutions)
    if (faulty(estimate.stamp)) {
      ASSERT_LT(testing::positionError(estimate, run), 2) << secondsBetween(Simulator::kStart, estimate.stamp);
    }
}

TEST(Sources, OrderOfArrivalDoesNotMatterToSourcesOfOneStamp) {
  const Scenario scenario = twoOfEach(40);
  const auto measurements = testing::simulate(scenario, 3).measurements;
  auto reversed = measurements;  // within each stamp
  for (auto begin = reversed.begin(); begin != reversed.end();) {
    const auto end = std::find_if(begin, reversed.end(), [&](const auto& z) { return z.stamp != begin->stamp; });
    std::reverse(begin, end);
    begin = end;
  }
  const Config config = testing::configFor(scenario);
  const auto straight = testing::feed("robust_kf", config, measurements);
  testing::expectSameEstimates(straight, testing::feed("robust_kf", config, reversed), "reversed");
  EXPECT_EQ(testing::count(straight, Verdict::Invalid), 0u);  // none takes another for a duplicate
}

std::string refusalOfSources(const std::string& text) {
  try {
    auto yaml = YamlSection::fromText(text, "vessel.yaml");
    Config config;
    readConfig(yaml, config);
    yaml.finish();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(Sources, AListSaysWhatIsWrongInIt) {
  const std::string fix = "{name: bow, topic: bow/fix, measures: [position]}",
                    gyro = "{name: gyro, topic: imu, measures: [heading]}";
  const auto list = [](const std::vector<std::string>& items) {
    std::string text = "sources:\n";
    for (const auto& item : items) text += "  - " + item + "\n";
    return text;
  };
  EXPECT_EQ(refusalOfSources(list({fix, gyro})), "");
  const std::vector<std::pair<std::string, std::string>> wrong{
      {list({fix, gyro, fix}), "which another source has"},
      {list({fix, gyro, "{name: aft, topic: bow/fix, measures: [position]}"}), "leave one of the two out"},
      {list({fix}), "has none that measures heading"},
      {list({fix, gyro, "{name: log, topic: log, measures: [sped]}"}), "may have position, heading, speed"},
      {list({fix, gyro, "{name: log, topic: log}"}), "is missing"},
      {list({fix, gyro, "{name: ../log, topic: log, measures: [speed]}"}), "letters, digits and _"},
      {list({fix, gyro, "{name: log, topic: log, measures: [speed, position]}"}), "only heading and turn_rate"},
      {list({fix, gyro, "{name: log, topic: log, measures: [speed], mounting: {}}"}), "not available yet"},
      {list({fix, gyro, "{name: log, topic: log, measures: [speed], sigma_deg: 1}"}), "sigma_deg"},
      {list({fix, gyro}) + "sensors: {}\n", "two ways to say the same"}};
  for (const auto& [text, sentence] : wrong)
    EXPECT_NE(refusalOfSources(text).find(sentence), std::string::npos) << text << refusalOfSources(text);
}

}  // namespace
}  // namespace sas_motion::towfish

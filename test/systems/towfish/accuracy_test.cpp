// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Monte Carlo on the paper's scenario: consistency on clean data, and what robustness is worth on contaminated data.
#include <cmath>

#include "campaign/suites.hpp"
#include "systems/towfish/feeding.hpp"

namespace sas_motion::towfish {
namespace {

TEST(Accuracy, NormalisedErrorsOfTheKalmanFilterLieInTheirBands) {
  const int runs = 100;
  const auto scenario = testing::zhu2007(100);
  const Config config = testing::configFor(scenario);
  std::cout << "seeds 1 to " << runs << "\n";
  const std::vector<const char*> names{"position", "heading", "speed", "current"};
  const std::vector<std::vector<int>> groups{{kNorth, kEast}, {kHeading}, {kSpeed}, {kCurrentNorth, kCurrentEast}};
  for (const char* name : {"kf", "robust_kf", "mixture_kf"}) {
    std::vector<double> nees(groups.size(), 0);
    double full = 0;
    for (int seed = 1; seed <= runs; ++seed) {
      const auto run = testing::simulate(scenario, static_cast<std::uint64_t>(seed));
      const Estimate last =
          testing::feed(name, config, run.measurements).solutions.back();  // one sample a run: independent
      const StateVector error = Model::difference(last.belief.mean, run.truthAt(last.stamp));
      full += error.dot(last.belief.covariance.llt().solve(error)) / runs;
      for (std::size_t g = 0; g < groups.size(); ++g) {
        const auto size = static_cast<Eigen::Index>(groups[g].size());
        Eigen::MatrixXd P(size, size);
        Eigen::VectorXd e(size);
        for (Eigen::Index i = 0; i < size; ++i) {
          e(i) = error(groups[g][static_cast<std::size_t>(i)]);
          for (Eigen::Index j = 0; j < size; ++j)
            P(i, j) =
                last.belief.covariance(groups[g][static_cast<std::size_t>(i)], groups[g][static_cast<std::size_t>(j)]);
        }
        nees[g] += e.dot(P.llt().solve(e)) / runs;
      }
    }
    // Robust filters give up a little efficiency on clean data without saying so in P: their bands end 10 % higher.
    const double slack = std::string(name) == "kf" ? 1 : 1.1;
    const Band band = averageChiSquaredBand(kStates, runs, 0.999);
    EXPECT_GT(full, band.lower / slack) << name;
    EXPECT_LT(full, band.upper * slack) << name;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const Band own = averageChiSquaredBand(static_cast<double>(groups[g].size()), runs, 0.999);
      EXPECT_GT(nees[g], own.lower / slack) << name << ", " << names[g];
      EXPECT_LT(nees[g], own.upper * slack) << name << ", " << names[g];
    }
  }
}

TEST(Accuracy, InnovationsOfTheKalmanFilterAreWhiteEnoughForTheirBand) {
  const auto scenario = testing::zhu2007(300);
  std::cout << "seed 1\n";
  const auto output = testing::feed("kf", testing::configFor(scenario), testing::simulate(scenario, 1).measurements);
  std::map<std::string_view, std::vector<double>> nis;
  for (const auto& audit : output.audits)
    if (secondsBetween(Simulator::kStart, audit.stamp) > 20) nis[audit.sensor].push_back(audit.nis);
  for (const Sensor sensor : {Sensor::Position, Sensor::Heading, Sensor::Speed}) {
    const auto& values = nis[sensorName(sensor)];
    const Band band = averageChiSquaredBand(rowsOf(sensor), static_cast<double>(values.size()), 0.999);
    EXPECT_GT(mean(values), band.lower) << sensorName(sensor);
    EXPECT_LT(mean(values), band.upper) << sensorName(sensor);
  }
}

TEST(Accuracy, RobustnessCostsLittleAndGainsMuch) {
  const auto suite = sas_motion::testing::suiteOf(
      sas_motion::testing::zhuSuite(150, 10, "[kf, oracle_kf, robust_kf, mixture_kf, bank_kf, student_t_kf]",
                                    "[{name: clean}, {name: '0.1, 10', noise: {law: contaminated, epsilon: 0.1, K: "
                                    "10}}, {name: '0.2, 20', noise: {law: contaminated, epsilon: 0.2, K: 20}}]"));
  const auto runs = sas_motion::testing::runAll(suite);
  for (const auto& run : runs)
    for (const auto& report : run) EXPECT_FALSE(report.diverged);
  const auto ratio = [&](const char* law, const char* estimator, const char* over) {
    return sas_motion::testing::rmse(suite, runs, law, estimator) / sas_motion::testing::rmse(suite, runs, law, over);
  };
  EXPECT_LE(ratio("clean", "robust_kf", "kf"), 1.05);
  EXPECT_LE(ratio("0.1, 10", "robust_kf", "kf"), 0.45);
  EXPECT_LE(ratio("0.2, 20", "robust_kf", "kf"), 0.20);
  for (const char* law : {"clean", "0.1, 10", "0.2, 20"}) {
    for (const char* best : {"mixture_kf", "bank_kf"}) {
      EXPECT_GE(ratio(law, best, kOracle), 0.97) << law << ", " << best;  // nothing beats what knows the outliers
      EXPECT_LE(ratio(law, best, kOracle), 1.10) << law << ", " << best;
    }
    EXPECT_LE(ratio(law, "student_t_kf", kOracle), 1.25) << law;
  }
}

}  // namespace
}  // namespace sas_motion::towfish

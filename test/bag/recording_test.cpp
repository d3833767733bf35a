// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bag/recording.hpp"

#include <gtest/gtest.h>
#include <sas_motion/MeasurementLabel.h>

#include "bag/bag_support.hpp"
#include "bag/bag_writer.hpp"
#include "ros/solution_messages.hpp"

namespace sas_motion::ros_side {
namespace {

Solution at(double seconds, double east) {
  Solution solution;
  solution.stamp = stampFromSeconds(seconds);
  solution.position_map.x() = east;
  return solution;
}

/// A bag of an estimator whose present answers are at 1 m east and whose settled ones, if there are any, at 2 m.
void writeRecording(const std::string& path, bool settled, bool truth = true) {
  BagWriter bag(path);
  const Geodetic datum{54, 10, 0};
  const ros::Time time(100);
  bag.write("/datum", time, fixAt(datum, time, "map"));
  if (truth) bag.write("/truth/fix", time, fixAt(datum, time, "map"));
  bag.write("/gnss/fix", time, fixAt(datum, time, "gnss_link"));
  bag.write("/kf/odometry", time, odometryOf(at(100, 1), {}));
  Solution with_current = at(100, 2);
  with_current.current = Current{{0.5, 0.25}, Matrix<2>::Identity()};
  if (settled) {
    bag.write("/kf/settled", time, odometryOf(with_current, {}));
    bag.write("/kf/settled_current", time, currentOf(with_current, {}));
  }
  for (const char* sensor : {"position", "heading"}) {
    Audit audit;
    audit.stamp = stampOf(time);
    audit.sensor = sensor;
    audit.rows = 1;
    audit.nis = 2;
    if (audit.sensor == "position") audit.S(0, 0) = 1;
    bag.write("/kf/update", time, updateOf(audit));
  }
  sas_motion::MeasurementLabel label;
  label.header.stamp = time;
  label.sensor = "position";
  label.outlier = {false, true};
  bag.write("/truth/label", time, label);
  bag.close();
}

TEST(Recording, TakesSettledSolutionsWhereTheBagHasThem) {
  for (const bool settled : {false, true}) {
    const TemporaryFile file("recording.bag");
    writeRecording(file.path(), settled);
    const Recording recording = Recording::read(file.path());
    const auto& estimator = recording.estimators.at("kf");
    ASSERT_EQ(estimator.solutions.size(), 1u);
    EXPECT_EQ(estimator.solutions[0].position_map.x(), settled ? 2 : 1);
    EXPECT_EQ(estimator.solutions[0].current.has_value(), settled);
    ASSERT_EQ(recording.fixes.size(), 1u) << "neither truth nor datum is a receiver's";
  }
}

TEST(Recording, AnAuditHasANisOnlyWithTheCovarianceOfItsInnovation) {
  const TemporaryFile file("recording.bag");
  writeRecording(file.path(), false);
  const Recording recording = Recording::read(file.path());
  const auto& audits = recording.estimators.at("kf").audits;
  ASSERT_EQ(audits.size(), 2u);
  EXPECT_EQ(audits[0].sensor, "position");
  EXPECT_EQ(audits[0].nis, 2);
  EXPECT_EQ(audits[1].sensor, "heading");
  EXPECT_EQ(audits[1].nis, 0);
  EXPECT_EQ(recording.outlier("position", stampFromSeconds(100)), true) << "one row of two";
  EXPECT_FALSE(recording.outlier("heading", stampFromSeconds(100)));
}

TEST(Recording, TruthThatIsAFixAloneHasNeitherHeadingNorSpeed) {
  const TemporaryFile file("recording.bag");
  writeRecording(file.path(), false);
  const Recording recording = Recording::read(file.path());
  EXPECT_EQ(recording.truth_topic, "truth/fix");
  ASSERT_EQ(recording.truth.points().size(), 1u);
  const Solution& point = recording.truth.points()[0];
  EXPECT_FALSE(point.has_heading() || point.has_velocity() || point.has_height() || point.current);
}

TEST(Recording, SaysWhatIsMissing) {
  const TemporaryFile file("recording.bag");
  writeRecording(file.path(), false, false);
  try {
    Recording::read(file.path());
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("truth/fix"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace sas_motion::ros_side

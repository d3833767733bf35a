// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bag/bag_reader.hpp"

#include <gtest/gtest.h>

#include "bag/bag_support.hpp"

namespace sas_motion::ros_side {
namespace {

class EveryCompression : public testing::TestWithParam<rosbag::CompressionType> {};

TEST_P(EveryCompression, GivesWhatViewGives) {
  for (const double delay : {0.0, 0.5, 30.0}) {  // chunks one after the other, overlapping, all over each other
    const TemporaryFile file("whole.bag");
    writeBag(file.path(), {GetParam(), 2000, 6, delay, 1});
    const auto expected = seenByView(file.path());
    ASSERT_EQ(expected.size(), 2000U);
    EXPECT_EQ(seenByReader(file.path()), expected) << delay;
  }
}

INSTANTIATE_TEST_SUITE_P(BagReader, EveryCompression,
                         testing::Values(rosbag::compression::Uncompressed, rosbag::compression::BZ2,
                                         rosbag::compression::LZ4));

TEST(BagReader, KeepsTheOrderOfViewWithUpTo16Connections) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const TemporaryFile file("order.bag");
    writeBag(file.path(), {rosbag::compression::Uncompressed, 500, 1 + static_cast<int>(seed % 16), 0.2, seed});
    EXPECT_EQ(seenByReader(file.path()), seenByView(file.path())) << seed;
  }
}

TEST(BagReader, GivesTheSampleBagsAsViewDoes) {
  for (const char* name : {"survey", "survey_outliers_20"}) {
    const std::string path = fmt::format("{}/bags/{}.bag", SAS_MOTION_SOURCE_DIR, name);
    EXPECT_EQ(seenByReader(path), seenByView(path));
  }
}

TEST(BagReader, KnowsBeginAndEndAndConnections) {
  const TemporaryFile file("ends.bag");
  writeBag(file.path(), {});
  const auto expected = seenByView(file.path());
  const BagReader reader(file.path());
  EXPECT_EQ(reader.begin(), expected.front().time);
  EXPECT_EQ(reader.end(), expected.back().time);
  ASSERT_EQ(reader.connections().size(), 6U);
  for (std::uint32_t i = 0; i < 6; ++i) EXPECT_EQ(reader.connections()[i].index, i);
}

TEST(BagReader, ReadsAnEmptyBag) {
  const TemporaryFile file("empty.bag");
  rosbag::Bag(file.path(), rosbag::bagmode::Write).close();
  BagReader reader(file.path());
  EXPECT_EQ(reader.next(), nullptr);
  EXPECT_EQ(reader.next(), nullptr);
  EXPECT_EQ(reader.end() - reader.begin(), ros::Duration(0));
}

TEST(BagReader, DeserialisesByType) {
  const TemporaryFile file("types.bag");
  writeBag(file.path(), {});
  BagReader reader(file.path());
  sensor_msgs::Imu imu;
  sas_motion::FilterUpdate update;
  int count = 0;
  while (const BagMessage* m = reader.next()) {
    const bool is_imu = m->connection->type == "sensor_msgs/Imu";
    EXPECT_EQ(reader.get(*m, imu), is_imu);
    EXPECT_EQ(reader.get(*m, update), !is_imu);
    if (is_imu) {
      EXPECT_EQ(imu.header.frame_id, "imu_link");
    }
    ++count;
  }
  EXPECT_EQ(count, 2000);
}

std::size_t mostHeld(const std::string& path) {
  BagReader reader(path);
  std::size_t most = 0;
  while (reader.next()) most = std::max(most, reader.bytesHeld());
  return most;
}

TEST(BagReader, HoldsNoMoreOfALongerBag) {
  const TemporaryFile brief("brief.bag"), extended("extended.bag");
  writeBag(brief.path(), {rosbag::compression::LZ4, 2000, 6, 0.5, 1});
  writeBag(extended.path(), {rosbag::compression::LZ4, 40000, 6, 0.5, 1});
  EXPECT_LT(mostHeld(extended.path()), 1.5 * static_cast<double>(mostHeld(brief.path())));
  EXPECT_LT(mostHeld(extended.path()), 200'000U);  // chunks are of 8 kB
}

}  // namespace
}  // namespace sas_motion::ros_side

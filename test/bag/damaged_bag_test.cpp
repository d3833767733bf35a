// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A damaged bag gives its messages or one plain sentence that names it, never a crash or memory without end.
#include <gtest/gtest.h>

#include "bag/bag_support.hpp"

namespace sas_motion::ros_side {
namespace {

/// Reads all there is. Empty where that went well, else what was thrown.
std::string complaintOf(const std::string& path) {
  try {
    BagReader reader(path);
    sensor_msgs::Imu imu;
    while (const BagMessage* m = reader.next()) reader.get(*m, imu);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

class EveryDamage : public testing::TestWithParam<rosbag::CompressionType> {
 protected:
  std::string wholeBag() const {
    writeBag(file_.path(), {GetParam(), 400, 6, 0.5, 1});
    return file_.read();
  }
  /// Flips 1 to 4 bytes between two places, 300 times over.
  void damage(const std::string& whole, std::size_t begin, std::size_t end) const {
    std::mt19937 random(7);
    for (int run = 0; run < 300; ++run) {
      std::string damaged = whole;
      for (auto left = 1 + random() % 4; left > 0; --left)
        damaged[begin + random() % (end - begin)] ^= static_cast<char>(1 + random() % 255);
      file_.write(damaged);
      const std::string complaint = complaintOf(file_.path());
      EXPECT_TRUE(complaint.empty() || complaint.rfind(file_.path() + ": ", 0) == 0) << complaint;
      EXPECT_EQ(complaint.find('\n'), std::string::npos) << complaint;
    }
  }
  TemporaryFile file_{"damaged.bag"};
};

std::size_t indexPosition(const std::string& bag) {
  std::uint64_t position = 0;
  std::memcpy(&position, bag.data() + bag.find("index_pos=") + 10, sizeof position);
  return position;
}

TEST_P(EveryDamage, FlippedAnywhere) {
  const std::string whole = wholeBag();
  damage(whole, 0, whole.size());
}

TEST_P(EveryDamage, FlippedInTheFileHeader) { damage(wholeBag(), 0, 90); }

TEST_P(EveryDamage, FlippedInTheIndex) {
  const std::string whole = wholeBag();
  damage(whole, indexPosition(whole), whole.size());
}

TEST_P(EveryDamage, FlippedInTheFirstChunk) { damage(wholeBag(), 4117, 4117 + 400); }

TEST_P(EveryDamage, CutShort) {
  const std::string whole = wholeBag();
  for (std::size_t size = 0; size < whole.size(); size += 1 + whole.size() / 200) {
    file_.write(whole.substr(0, size));
    EXPECT_NE(complaintOf(file_.path()).find("rosbag reindex"), std::string::npos) << size;
  }
}

INSTANTIATE_TEST_SUITE_P(DamagedBag, EveryDamage,
                         testing::Values(rosbag::compression::Uncompressed, rosbag::compression::BZ2,
                                         rosbag::compression::LZ4));

/// A bag in which one text is replaced by another as long.
std::string complaintAfter(const std::string& from, const std::string& to) {
  const TemporaryFile file("replaced.bag");
  writeBag(file.path(), {});
  std::string bytes = file.read();
  for (auto at = bytes.find(from); at != std::string::npos; at = bytes.find(from, at + 1))
    bytes.replace(at, to.size(), to);
  file.write(bytes);
  return complaintOf(file.path());
}

TEST(DamagedBag, SaysWhatIsWrong) {
  EXPECT_NE(complaintAfter("compression=none", "compression=lzma").find("compressed by neither"), std::string::npos);
  EXPECT_NE(complaintAfter("#ROSBAG V2.0", "#ROSBAG V1.2").find("rosbag fix"), std::string::npos);
  EXPECT_NE(complaintAfter("start_time=", "start_tima=").find("'start_time'"), std::string::npos);
  EXPECT_NE(complaintAfter("#ROSBAG V2.0", "#PNGBAG V2.0").find("no whole rosbag"), std::string::npos);
}

TEST(DamagedBag, MissingOrNoFile) {
  EXPECT_NE(complaintOf("/nowhere/survey.bag").find("/nowhere/survey.bag: no such file; check the path"),
            std::string::npos);
  EXPECT_NE(complaintOf("/tmp").find("/tmp: is no whole rosbag"), std::string::npos);
}

TEST(DamagedBag, AMessageTooShortForItsTypeIsNamed) {
  const TemporaryFile file("short.bag");
  {
    rosbag::Bag bag(file.path(), rosbag::bagmode::Write);
    const auto header = boost::make_shared<ros::M_string>();
    *header = {{"topic", "/imu"},
               {"type", "sensor_msgs/Imu"},
               {"md5sum", ros::message_traits::md5sum<sensor_msgs::Imu>()},
               {"message_definition", "-"}};
    bag.write("/imu", ros::Time(1), sas_motion::FilterUpdate(), header);
  }
  EXPECT_NE(complaintOf(file.path()).find("is damaged"), std::string::npos) << complaintOf(file.path());
}

}  // namespace
}  // namespace sas_motion::ros_side

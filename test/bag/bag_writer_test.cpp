// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bag/bag_writer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "bag/bag_support.hpp"

namespace sas_motion::ros_side {
namespace {

/// In an order that does not depend on how the connections are numbered.
std::vector<Seen> sorted(std::vector<Seen> seen) {
  const auto key = [](const Seen& m) { return std::tie(m.time, m.caller, m.bytes); };
  std::sort(seen.begin(), seen.end(), [&](const Seen& a, const Seen& b) { return key(a) < key(b); });
  return seen;
}

TEST(BagWriter, ACopyIsReadByViewAsTheOriginal) {
  const TemporaryFile from("from.bag"), to("to.bag");
  writeBag(from.path(), {rosbag::compression::BZ2, 20000, 6, 0.5, 1});
  BagWriter writer(to.path());
  BagReader reader(from.path());
  while (const BagMessage* m = reader.next()) writer.write(writer.connect(*m->connection), m->time, m->bytes);
  writer.close();
  EXPECT_EQ(seenByReader(to.path()), seenByView(to.path()));
  EXPECT_EQ(sorted(seenByView(to.path())), sorted(seenByView(from.path())));
}

TEST(BagWriter, WritesMessagesLargerThanAChunk) {
  const TemporaryFile file("large.bag");
  sas_motion::FilterUpdate update;
  update.weights.assign(300'000, 0.5);  // 2.4 MB
  {
    BagWriter writer(file.path());
    for (int i = 1; i <= 3; ++i) writer.write("large/update", ros::Time(i), update);
    writer.close();
  }
  const auto seen = seenByView(file.path());
  ASSERT_EQ(seen.size(), 3U);
  EXPECT_EQ(seenByReader(file.path()), seen);
}

TEST(BagWriter, AnEmptyBagIsABag) {
  const TemporaryFile file("none.bag");
  BagWriter writer(file.path());
  writer.close();
  EXPECT_TRUE(seenByView(file.path()).empty());
  EXPECT_TRUE(seenByReader(file.path()).empty());
}

}  // namespace
}  // namespace sas_motion::ros_side

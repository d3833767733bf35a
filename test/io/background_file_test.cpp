// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/io/background_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace sas_motion {
namespace {

TEST(BackgroundFile, WritesBlocksInTheirOrder) {
  const std::string path = ::testing::TempDir() + "blocks." + std::to_string(::getpid());
  std::string expected;
  {
    BackgroundFile file(path);
    Block block;
    for (int i = 0; i < 500; ++i) {
      const std::string text(static_cast<std::size_t>(1 + 97 * i % 5000), static_cast<char>('a' + i % 26));
      block.append(text);
      expected += text;
      if (i % 3 == 0) file.write(block);
    }
    file.write(block);
    expected.replace(1, 3, "XYZ");
    file.close(1, "XYZ");
  }
  std::ifstream stream(path, std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), expected);
  std::filesystem::remove(path);
}

TEST(BackgroundFile, AFailedWriteReachesTheCaller) {
  Block block;
  const auto fill = [&](BackgroundFile& file) {
    for (int i = 0; i < 3; ++i) {
      block.append(std::string(100'000, 'x'));
      file.write(block);
    }
  };
  BackgroundFile full("/dev/full");
  EXPECT_THROW(fill(full), std::runtime_error);
  BackgroundFile full_at_the_end("/dev/full");
  block.append("x");
  full_at_the_end.write(block);
  EXPECT_THROW(full_at_the_end.close(0, ""), std::runtime_error);
  EXPECT_THROW(BackgroundFile("/nowhere/file"), std::runtime_error);
}

TEST(BackgroundFile, LeftWithoutCloseEndsItsThread) {
  BackgroundFile file("/dev/null");
  Block block;
  block.append("x");
  file.write(block);
}

}  // namespace
}  // namespace sas_motion

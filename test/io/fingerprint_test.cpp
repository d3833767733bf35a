// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/io/fingerprint.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <set>

namespace sas_motion {
namespace {

TEST(Fingerprint, OfAFileIsThatOfItsBytesWhateverItsLength) {
  for (const std::size_t size : {0, 1, 31, 32, 33, 262143, 262144, 262145, 600000}) {
    std::string bytes(size, '\0');
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<char>(i * 37 + i / 251);
    const std::string path = ::testing::TempDir() + "fingerprint.bin";
    std::ofstream(path, std::ios::binary) << bytes;
    EXPECT_EQ(Fingerprint::ofFile(path), Fingerprint::ofText(bytes)) << size;
    std::remove(path.c_str());
  }
}

TEST(Fingerprint, AnyByteAndTheLengthCount) {
  const std::string text(100, 'a');
  std::set<std::string> seen{Fingerprint::ofText(text), Fingerprint::ofText(text + '\0')};
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string other = text;
    other[i] = 'b';
    seen.insert(Fingerprint::ofText(other));
  }
  EXPECT_EQ(seen.size(), text.size() + 2);
}

}  // namespace
}  // namespace sas_motion

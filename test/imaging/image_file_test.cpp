// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "imaging/imaging_support.hpp"
#include "sas_motion/imaging/image.hpp"

namespace sas_motion::imaging::testing {
namespace {

std::string contents(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(ImageFile, IsANumpyArrayWithItsAxesBeside) {
  const auto folder = std::filesystem::temp_directory_path() / "sas_motion_image_file_test";
  std::filesystem::create_directories(folder);
  Image image{gridAround({0, 29, 0}, 2, 3), {{1, 2}, {3, 4}, {5, 6}, {7, 8}, {9, 10}, {11, 12}}};
  writeImage((folder / "image").string(), image);
  const std::string npy = contents((folder / "image.npy").string());
  ASSERT_GT(npy.size(), 10u);
  EXPECT_EQ(npy.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const std::size_t header = 10 + static_cast<unsigned char>(npy[8]) + 256 * static_cast<unsigned char>(npy[9]);
  EXPECT_EQ(header % 64, 0u);
  EXPECT_NE(npy.find("'descr': '<c8', 'fortran_order': False, 'shape': (2, 3)"), std::string::npos);
  ASSERT_EQ(npy.size(), header + 6 * 8);
  float last = 0;
  std::memcpy(&last, npy.data() + npy.size() - 4, 4);
  EXPECT_EQ(last, 12);
  const std::string axes = contents((folder / "image.json").string());
  for (const char* part : {"\"range_step\": 0.0080", "\"rows\": 2", "\"along_axis\": [1, 0, 0]"})
    EXPECT_NE(axes.find(part), std::string::npos) << axes;
  std::filesystem::remove_all(folder);
  EXPECT_THROW(writeImage((folder / "image").string(), image), std::runtime_error);
}

}  // namespace
}  // namespace sas_motion::imaging::testing

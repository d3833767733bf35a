// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/io/atomic_file.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "support.hpp"

namespace sas_motion {
namespace {

class Files : public ::testing::Test {
 protected:
  Files() {
    std::string pattern = ::testing::TempDir() + "sas_motion_XXXXXX";
    folder_ = ::mkdtemp(pattern.data());
  }
  ~Files() override { std::filesystem::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  static std::string contents(const std::string& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }
  std::size_t filesInFolder() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder_), std::filesystem::directory_iterator()));
  }
  std::filesystem::path folder_;
};

TEST_F(Files, NotCommittedLeavesTheOldFileAndNothingBeside) {
  writeFile(path("metrics.json"), "old");
  {
    AtomicFile file(path("metrics.json"));
    std::ofstream(file.temporary()) << "half of the ne";
    EXPECT_EQ(contents(path("metrics.json")), "old");
  }
  EXPECT_EQ(contents(path("metrics.json")), "old");
  EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(Files, CommittedReplacesTheOldFile) {
  writeFile(path("metrics.json"), "old");
  AtomicFile file(path("metrics.json"));
  std::ofstream(file.temporary()) << "new";
  file.commit();
  EXPECT_EQ(contents(path("metrics.json")), "new");
  EXPECT_EQ(filesInFolder(), 1u);
}

/// The message of what `act` throws.
template <class Act>
std::string messageOf(Act act) {
  try {
    act();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST_F(Files, AFolderThatCannotBeWrittenIsNamed) {
  writeFile(path("file"), "not a folder");
  const std::string below = path("file") + "/metrics.json", nowhere = path("nowhere") + "/metrics.json";
  EXPECT_NE(messageOf([&] { writeFile(below, "x"); }).find(below), std::string::npos);
  EXPECT_NE(messageOf([&] { AtomicFile file(nowhere); }).find(nowhere), std::string::npos);
  EXPECT_NE(messageOf([&] { makeFolder(below); }).find(below), std::string::npos);
  EXPECT_EQ(contents(path("file")), "not a folder");
}

TEST_F(Files, ATargetThatIsAFolderIsNamedAndNothingIsLeft) {
  makeFolder(path("results"));
  EXPECT_NE(messageOf([&] { writeFile(path("results"), "x"); }).find(path("results")), std::string::npos);
  EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(Files, WhatWasWrittenAndIsGoneIsReported) {
  AtomicFile file(path("metrics.json"));
  std::filesystem::remove(file.temporary());
  EXPECT_NE(messageOf([&] { file.commit(); }).find(path("metrics.json")), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(path("metrics.json")));
}

TEST_F(Files, FoldersAreMadeWithTheirParentsAndMayExist) {
  makeFolder(path("a/b/c"));
  makeFolder(path("a/b/c"));
  EXPECT_TRUE(std::filesystem::is_directory(path("a/b/c")));
}

}  // namespace
}  // namespace sas_motion

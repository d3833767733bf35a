// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/io/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace sas_motion {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& doing) {
  throw std::runtime_error(fmt::format("{}: could not be {}: {}", path, doing, std::strerror(errno)));
}

void flushToDisk(const std::string& path, const std::string& name) {
  const int descriptor = ::open(path.c_str(), O_RDONLY);
  if (descriptor < 0) fail(name, "written");
  const int status = ::fsync(descriptor);
  ::close(descriptor);
  if (status != 0) fail(name, "flushed to disk");
}

}  // namespace

AtomicFile::AtomicFile(std::string path)
    : path_(std::move(path)), temporary_(fmt::format("{}.{}.part", path_, ::getpid())) {
  std::FILE* probe = std::fopen(temporary_.c_str(), "wb");
  if (!probe) fail(path_, "created");
  std::fclose(probe);
}

AtomicFile::~AtomicFile() {
  if (!committed_) std::remove(temporary_.c_str());
}

void AtomicFile::commit() {
  flushToDisk(temporary_, path_);
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail(path_, "put in place");
  committed_ = true;
}

void writeFile(const std::string& path, const std::string& text) {
  AtomicFile file(path);
  std::ofstream stream(file.temporary(), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) fail(path, "written");
  file.commit();
}

void makeFolder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw std::runtime_error(fmt::format("{}: the folder could not be made: {}", path, error.message()));
}

}  // namespace sas_motion

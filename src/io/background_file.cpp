// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/io/background_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace sas_motion {
namespace {

/// Returns 0 or errno.
int writeAll(int descriptor, const std::uint8_t* data, std::size_t size, std::uint64_t position) {
  while (size > 0) {
    const ssize_t written = ::pwrite(descriptor, data, size, static_cast<off_t>(position));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return written < 0 ? errno : EIO;
    data += written;
    size -= static_cast<std::size_t>(written);
    position += static_cast<std::uint64_t>(written);
  }
  return 0;
}

void require(int error) {
  if (error != 0) throw std::runtime_error(std::strerror(error));
}

}  // namespace

BackgroundFile::BackgroundFile(const std::string& path)
    : descriptor_(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) require(errno);
  thread_ = std::thread([this] { work(); });
}

BackgroundFile::~BackgroundFile() {
  stop();
  if (descriptor_ >= 0) ::close(descriptor_);
}

void BackgroundFile::write(Block& block) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return !busy_; });
  require(error_);
  std::swap(block, block_);
  block.size = 0;
  busy_ = true;
  changed_.notify_all();
}

void BackgroundFile::work() {
  std::uint64_t position = 0;
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return busy_ || stopping_; });
    if (!busy_) return;
    lock.unlock();
    const int error = writeAll(descriptor_, block_.bytes.data(), block_.size, position);
    position += block_.size;
    lock.lock();
    if (error_ == 0) error_ = error;
    busy_ = false;
    changed_.notify_all();
  }
}

void BackgroundFile::stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
    changed_.notify_all();
  }
  if (thread_.joinable()) thread_.join();
}

void BackgroundFile::close(std::uint64_t position, std::string_view text) {
  stop();
  require(error_);
  require(writeAll(descriptor_, reinterpret_cast<const std::uint8_t*>(text.data()), text.size(), position));
  if (::close(std::exchange(descriptor_, -1)) != 0) require(errno);
}

}  // namespace sas_motion

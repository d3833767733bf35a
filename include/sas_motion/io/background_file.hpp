// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace sas_motion {

/// A buffer of bytes that keeps its capacity.
struct Block {
  std::vector<std::uint8_t> bytes;
  std::size_t size = 0;  ///< bytes in use

  /// Appends room for `more` bytes and returns its place.
  std::uint8_t* extend(std::size_t more) {
    if (size + more > bytes.size()) bytes.resize(std::max(size + more, 2 * bytes.size()));
    std::uint8_t* place = bytes.data() + size;
    size += more;
    return place;
  }
  void append(std::string_view text) { std::copy(text.begin(), text.end(), extend(text.size())); }
};

/// A file that a thread of its own writes from front to back, while the caller computes.
class BackgroundFile {
 public:
  /// All functions throw std::runtime_error with the system's reason. The next write() or close() reports a failed
  /// write.
  explicit BackgroundFile(const std::string& path);
  ~BackgroundFile();
  BackgroundFile(const BackgroundFile&) = delete;
  BackgroundFile& operator=(const BackgroundFile&) = delete;

  /// Takes a block to write and leaves an empty one. Waits while the previous block is being written.
  void write(Block& block);
  /// Waits for the last block, then overwrites the bytes at `position` with `text`. No write may follow.
  void close(std::uint64_t position, std::string_view text);

 private:
  void work();
  void stop();

  int descriptor_;
  Block block_;  // the thread's while busy_
  std::mutex mutex_;
  std::condition_variable changed_;
  bool busy_ = false, stopping_ = false;
  int error_ = 0;  // errno of the first failed write
  std::thread thread_;
};

}  // namespace sas_motion

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

/// Bytes with room behind them, which is kept from use to use.
struct Block {
  std::vector<std::uint8_t> bytes;
  std::size_t size = 0;  ///< of what is filled in

  /// Where to put `more` bytes.
  std::uint8_t* extend(std::size_t more) {
    if (size + more > bytes.size()) bytes.resize(std::max(size + more, 2 * bytes.size()));
    std::uint8_t* place = bytes.data() + size;
    size += more;
    return place;
  }
  void append(std::string_view text) { std::copy(text.begin(), text.end(), extend(text.size())); }
};

/// A file written front to back by a thread of its own, so that the caller computes while the system copies.
class BackgroundFile {
 public:
  /// Functions throw std::runtime_error with the system's reason; a write that failed is thrown by the next write() or
  /// by close().
  explicit BackgroundFile(const std::string& path);
  ~BackgroundFile();
  BackgroundFile(const BackgroundFile&) = delete;
  BackgroundFile& operator=(const BackgroundFile&) = delete;

  /// Takes a block to be written and leaves an empty one. Waits for the block before it where the disk is slower than
  /// the caller.
  void write(Block& block);
  /// Waits for the last block, then writes `text` over what is at `position`. Nothing may be written after it.
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

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace sas_motion {

/// A hash of bytes, to tell whether something is still the same: FNV-1a over words of 8 bytes, in four strands that the
/// processor takes side by side, then over the strands and the size. The shift lets high bits count. No protection
/// against forgery.
class Fingerprint {
 public:
  static constexpr std::size_t kBlock = 32;

  /// Takes bytes; all calls but the last must have a multiple of kBlock.
  void add(const char* data, std::size_t size);
  /// 16 hexadecimal digits.
  std::string hex() const;

  static std::string ofText(const std::string& text);
  /// Of a file's bytes; that of nothing where it cannot be read.
  static std::string ofFile(const std::string& path);

 private:
  std::array<std::uint64_t, 4> strands_{1, 2, 3, 4};
  std::uint64_t size_ = 0;
};

}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace sas_motion {

/// A hash that shows whether bytes have changed: FNV-1a over words of 8 bytes in four independent strands, then over
/// the strands and the size. The shift mixes in the high bits. The hash does not protect against forgery.
class Fingerprint {
 public:
  static constexpr std::size_t kBlock = 32;

  /// Adds bytes. All calls but the last must add a multiple of kBlock.
  void add(const char* data, std::size_t size);
  /// Returns 16 hexadecimal digits.
  std::string hex() const;

  static std::string ofText(const std::string& text);
  /// The fingerprint of a file's bytes, or of no bytes where it cannot be read.
  static std::string ofFile(const std::string& path);

 private:
  std::array<std::uint64_t, 4> strands_{1, 2, 3, 4};
  std::uint64_t size_ = 0;
};

}  // namespace sas_motion

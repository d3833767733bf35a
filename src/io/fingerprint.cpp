// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/io/fingerprint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <vector>

namespace sas_motion {
namespace {

void mix(std::uint64_t& hash, std::uint64_t word) {
  hash = (hash ^ word) * 1099511628211ULL;
  hash ^= hash >> 32U;
}

}  // namespace

void Fingerprint::add(const char* data, std::size_t size) {
  for (std::size_t i = 0; i < size; i += kBlock) {
    std::array<std::uint64_t, 4> words{};  // what is missing of the last ones is zero
    static_assert(sizeof words == kBlock);
    std::memcpy(words.data(), data + i, std::min(kBlock, size - i));
    for (std::size_t k = 0; k < words.size(); ++k) mix(strands_[k], words[k]);
  }
  size_ += size;
}

std::string Fingerprint::hex() const {
  std::uint64_t hash = 1469598103934665603ULL;
  for (const auto strand : strands_) mix(hash, strand);
  mix(hash, size_);
  return fmt::format("{:016x}", hash);
}

std::string Fingerprint::ofText(const std::string& text) {
  Fingerprint fingerprint;
  fingerprint.add(text.data(), text.size());
  return fingerprint.hex();
}

std::string Fingerprint::ofFile(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::vector<char> block(8192 * kBlock);
  Fingerprint fingerprint;
  while (stream.read(block.data(), static_cast<std::streamsize>(block.size())) || stream.gcount() > 0)
    fingerprint.add(block.data(), static_cast<std::size_t>(stream.gcount()));
  return fingerprint.hex();
}

}  // namespace sas_motion

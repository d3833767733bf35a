// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bag/decompress.hpp"

#include <bzlib.h>
#include <roslz4/lz4s.h>

#include <algorithm>
#include <limits>

namespace sas_motion::ros_side {
namespace {

using bag_format::Bytes;
using bag_format::Error;
using Buffer = std::vector<std::uint8_t>;

constexpr std::size_t kMost = std::numeric_limits<int>::max();  // both libraries count in ints

/// Both libraries take what they only read as char*.
char* writable(const std::uint8_t* data) { return const_cast<char*>(reinterpret_cast<const char*>(data)); }

constexpr std::size_t kLeast = 4096;  // bytes of room, so that doubling it leads somewhere

/// bzip2 has no highest ratio, so the memory grows with what comes out.
void decompressBz2(Bytes packed, std::size_t size, Buffer& unpacked) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) throw std::bad_alloc();
  stream.next_in = writable(packed.data());
  stream.avail_in = static_cast<unsigned>(packed.size());
  std::size_t done = 0;
  int status = BZ_OK;
  unpacked.resize(std::min(size, std::max({unpacked.capacity(), 8 * packed.size(), kLeast})));
  while (status == BZ_OK) {
    if (done == unpacked.size()) unpacked.resize(std::min(size, 2 * done));
    const std::size_t room = unpacked.size() - done;
    stream.next_out = reinterpret_cast<char*>(unpacked.data() + done);
    stream.avail_out = static_cast<unsigned>(room);
    status = BZ2_bzDecompress(&stream);
    done += room - stream.avail_out;
    if (status == BZ_OK && (done == size || stream.avail_out > 0))
      status = BZ_UNEXPECTED_EOF;  // it wants more room, or more input
  }
  BZ2_bzDecompressEnd(&stream);
  if (status != BZ_STREAM_END || done != size) throw Error("a chunk that does not unpack by bz2");
}

void decompressLz4(Bytes packed, std::size_t size, Buffer& unpacked) {
  if (size / 255 > packed.size()) throw Error("a chunk that cannot unpack to its size by lz4");  // its highest ratio
  unpacked.resize(size);
  auto done = static_cast<unsigned>(size);
  const int status = roslz4_buffToBuffDecompress(writable(packed.data()), static_cast<unsigned>(packed.size()),
                                                 writable(unpacked.data()), &done);
  if (status != ROSLZ4_OK || done != size) throw Error("a chunk that does not unpack by lz4");
}

}  // namespace

void decompress(std::string_view compression, Bytes packed, std::size_t size, Buffer& unpacked) {
  if (packed.size() > kMost || size > kMost) throw Error("a chunk of more than 2 GB");
  if (compression == "bz2")
    decompressBz2(packed, size, unpacked);
  else if (compression == "lz4")
    decompressLz4(packed, size, unpacked);
  else
    throw Error("a chunk compressed by neither bz2 nor lz4");
}

}  // namespace sas_motion::ros_side

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>
#include <vector>

#include "bag/bag_format.hpp"

namespace sas_motion::ros_side {

/// Unpacks a chunk of a bag into `unpacked`, whose memory is used again. `compression` is bz2 or lz4, as the chunk's
/// header has it; `size` is the unpacked size that the header states, and no memory is taken by it alone. Throws
/// bag_format::Error.
void decompress(std::string_view compression, bag_format::Bytes packed, std::size_t size,
                std::vector<std::uint8_t>& unpacked);

}  // namespace sas_motion::ros_side

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace sas_motion {

/// A point in time: nanoseconds since the epoch. Integers, so that ordering, ties and duplicates are exact.
using Stamp = std::int64_t;

constexpr Stamp kNanosecondsPerSecond = 1'000'000'000;

/// Seconds from `begin` to `end`.
inline double secondsBetween(Stamp begin, Stamp end) { return static_cast<double>(end - begin) * 1e-9; }

/// The stamp nearest to `seconds` since the epoch; seconds below 2^53 ns are exact to 1 ns.
inline Stamp stampFromSeconds(double seconds) {
  const double nanoseconds = seconds * 1e9;
  return static_cast<Stamp>(nanoseconds < 0 ? nanoseconds - 0.5 : nanoseconds + 0.5);
}

}  // namespace sas_motion

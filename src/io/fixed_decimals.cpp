// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/io/fixed_decimals.hpp"

#include <cmath>
#include <cstdint>
#include <iterator>

namespace sas_motion {
namespace {

__extension__ using Wide = unsigned __int128;

constexpr int kMantissaBits = 53;

/// value * scale rounded to an integer, half to even; value >= 0, and the result fits.
std::uint64_t roundedProduct(double value, std::uint64_t scale) {
  int exponent = 0;
  const auto mantissa =
      static_cast<std::uint64_t>(std::ldexp(std::frexp(value, &exponent), kMantissaBits));  // value = mantissa 2^-shift
  const int shift = kMantissaBits - exponent;
  const Wide product = Wide{mantissa} * scale;
  if (shift <= 0) return static_cast<std::uint64_t>(product << static_cast<unsigned>(-shift));
  if (shift >= 126) return 0;  // the product has less bits than that
  const auto s = static_cast<unsigned>(shift);
  const Wide whole = product >> s, rest = product - (whole << s), half = Wide{1} << (s - 1);
  const bool up = rest > half || (rest == half && (whole & 1U) != 0);
  return static_cast<std::uint64_t>(whole) + (up ? 1 : 0);
}

}  // namespace

void appendFixed(double value, int decimals, fmt::memory_buffer& out) {
  std::uint64_t scale = 1;
  for (int i = 0; i < decimals && i < 18; ++i) scale *= 10;
  if (decimals < 1 || decimals > 15 || !(std::abs(value) * static_cast<double>(scale) < 9e18)) {
    fmt::format_to(std::back_inserter(out), "{:.{}f}", value, decimals);
    return;
  }
  const std::uint64_t scaled = roundedProduct(std::abs(value), scale);
  char text[48];
  char* const end = text + sizeof text;
  char* place = end;
  std::uint64_t fraction = scaled % scale, whole = scaled / scale;
  for (int i = 0; i < decimals; ++i, fraction /= 10) *--place = static_cast<char>('0' + fraction % 10);
  *--place = '.';
  do *--place = static_cast<char>('0' + whole % 10);
  while ((whole /= 10) != 0);
  if (std::signbit(value)) *--place = '-';
  out.append(place, end);
}

}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The part of Highway's interface that our kernels use, for builds without Highway: a vector is one number.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#define HWY_BEFORE_NAMESPACE() static_assert(true, "")
#define HWY_AFTER_NAMESPACE() static_assert(true, "")
#define HWY_NAMESPACE one_lane
#define HWY_INLINE inline
#define HWY_ONCE 1
#define HWY_EXPORT(function) using HWY_NAMESPACE::function
#define HWY_DYNAMIC_DISPATCH(function) function
// Smaller numbers are better instructions.
#define HWY_AVX3 1
#define HWY_AVX2 2
#define HWY_TARGET 3

// NOLINTBEGIN(readability-identifier-naming): the names are Highway's.
namespace hwy {

inline const char* TargetName(int) { return "one lane"; }

namespace HWY_NAMESPACE {

template <class T>
struct OneLane {
  using Number = T;
};
template <class T, std::size_t>
using CappedTag = OneLane<T>;
template <class D>
using Vec = typename D::Number;
template <class D>
using RebindToSigned = OneLane<std::int32_t>;  // of float

template <class D>
constexpr std::size_t Lanes(D) {
  return 1;
}
template <class D>
Vec<D> Zero(D) {
  return 0;
}
template <class D>
Vec<D> Set(D, Vec<D> value) {
  return value;
}
template <class D>
Vec<D> Iota(D, Vec<D> first) {
  return first;
}
template <class D>
Vec<D> LoadU(D, const Vec<D>* from) {
  return *from;
}
template <class D>
void StoreU(Vec<D> value, D, Vec<D>* to) {
  *to = value;
}
template <class D>
void StoreInterleaved2(Vec<D> first, Vec<D> second, D, Vec<D>* to) {
  to[0] = first;
  to[1] = second;
}
template <class D, class Index>
Vec<D> GatherIndex(D, const Vec<D>* from, Index index) {
  return from[index];
}
template <class D, class V>
Vec<D> ConvertTo(D, V value) {
  return static_cast<Vec<D>>(value);
}

// clang-format off
template <class V> V Add(V a, V b) { return a + b; }
template <class V> V Sub(V a, V b) { return a - b; }
template <class V> V Mul(V a, V b) { return a * b; }
template <class V> V Div(V a, V b) { return a / b; }
template <class V> V Neg(V a) { return -a; }
template <class V> V MulAdd(V a, V b, V c) { return a * b + c; }
template <class V> V MulSub(V a, V b, V c) { return a * b - c; }
template <class V> V NegMulAdd(V a, V b, V c) { return c - a * b; }
template <class V> V Sqrt(V a) { return std::sqrt(a); }
template <class V> V Floor(V a) { return std::floor(a); }
template <class V> V Round(V a) { return std::nearbyint(a); }
template <class V> bool Gt(V a, V b) { return a > b; }
template <class V> bool Eq(V a, V b) { return a == b; }
template <class V> V IfThenElseZero(bool mask, V a) { return mask ? a : 0; }
// clang-format on

}  // namespace HWY_NAMESPACE
}  // namespace hwy
// NOLINTEND(readability-identifier-naming)

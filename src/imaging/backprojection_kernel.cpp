// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Compiled once for each vector instruction set; the best one this machine has is chosen when the program runs.
#include "imaging/backprojection_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "imaging/backprojection_kernel.cpp"
#include <algorithm>
#include <cstddef>

#include "parallel/vectors.hpp"

HWY_BEFORE_NAMESPACE();
namespace sas_motion::imaging {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, kTileLanes>;
using I = hn::RebindToSigned<F>;
using Floats = hn::Vec<F>;
using Integers = hn::Vec<I>;

struct Complexes {
  Floats real, imaginary;
};

/// exp(j 2 pi turns) by least-maximum polynomials over one cycle; error below 5e-5, which is -86 dB.
HWY_INLINE Complexes phasor(Floats turns) {
  const F f;
  const auto x = hn::Sub(turns, hn::Round(turns));
  const auto u = hn::Mul(x, x);
  auto sine = hn::MulAdd(hn::Set(f, 32.7814011f), u, hn::Set(f, -74.4780047f));
  sine = hn::MulAdd(sine, u, hn::Set(f, 81.3668153f));
  sine = hn::MulAdd(sine, u, hn::Set(f, -41.3312143f));
  sine = hn::MulAdd(sine, u, hn::Set(f, 6.2830558f));
  auto cosine = hn::MulAdd(hn::Set(f, 45.6465573f), u, hn::Set(f, -82.4035507f));
  cosine = hn::MulAdd(cosine, u, hn::Set(f, 64.6734312f));
  cosine = hn::MulAdd(cosine, u, hn::Set(f, -19.7310417f));
  cosine = hn::MulAdd(cosine, u, hn::Set(f, 0.999959795f));
  return {cosine, hn::Mul(sine, x)};
}

/// A leg's length less that to the tile's centre, |a + d| - |a| = (2 a.d + d.d) / (|a + d| + |a|), without cancellation
/// [m].
HWY_INLINE Floats legDifference(const TileLeg& leg, float range, Floats track) {
  const F f;
  const auto row = hn::Set(f, range * (leg.along_range + range));
  const auto q = hn::MulAdd(track, hn::Add(hn::Set(f, leg.along_track), track), row);
  const auto length = hn::Sqrt(hn::Add(hn::Set(f, leg.range_squared), q));
  return hn::Div(q, hn::Add(length, hn::Set(f, leg.range)));
}

template <bool kMonostatic>
HWY_INLINE Floats pathDifference(const TileLine& line, float range, Floats track) {
  const F f;
  const auto out = legDifference(line.legs[0], range, track);
  if (kMonostatic) return hn::Add(out, out);
  const auto doppler =
      hn::MulAdd(hn::Set(f, line.doppler_track), track, hn::Set(f, line.doppler + line.doppler_range * range));
  return hn::Mul(doppler, hn::Add(out, legDifference(line.legs[1], range, track)));
}

/// The samples before and after a position.
struct Neighbours {
  Floats real, next_real, imaginary, next_imaginary;
};

#if HWY_TARGET <= HWY_AVX3
constexpr bool kInterleaved = false;

/// from[index] for 0 <= index < 32, from two registers: several times faster than a gather.
HWY_INLINE Floats permute(const float* from, Integers index) {
  return Floats{_mm512_permutex2var_ps(_mm512_loadu_ps(from), index.raw, _mm512_loadu_ps(from + 16))};
}

HWY_INLINE Neighbours permuteAll(const TileLine& line, int first, Integers index) {
  return {permute(line.real + first, index), permute(line.real + first + 1, index),
          permute(line.imaginary + first, index), permute(line.imaginary + first + 1, index)};
}

HWY_INLINE Neighbours gather(const TileLine& line, Integers index) {
  const F f;
  return {hn::GatherIndex(f, line.real, index), hn::GatherIndex(f, line.real + 1, index),
          hn::GatherIndex(f, line.imaginary, index), hn::GatherIndex(f, line.imaginary + 1, index)};
}

/// Neighbouring pixels along the track need nearly the same samples: a few blocks of two registers hold them all.
HWY_INLINE Neighbours neighbours(const TileLine& line, Integers index) {
  constexpr int kMostBlocks = 4, kBlock = 32;
  const I i;
  const auto block = hn::Set(i, kBlock);
  int first = hn::GetLane(hn::MinOfLanes(i, index));
  auto inside = hn::Sub(index, hn::Set(i, first));
  auto found = permuteAll(line, first, inside);
  auto beyond = hn::Not(hn::Lt(inside, block));
  for (int blocks = 1; !hn::AllFalse(i, beyond); ++blocks) {
    if (blocks == kMostBlocks) return gather(line, index);
    first += kBlock;
    inside = hn::Sub(inside, block);
    const auto more = permuteAll(line, first, inside);
    const auto chosen = hn::RebindMask(F(), beyond);
    found = {hn::IfThenElse(chosen, more.real, found.real), hn::IfThenElse(chosen, more.next_real, found.next_real),
             hn::IfThenElse(chosen, more.imaginary, found.imaginary),
             hn::IfThenElse(chosen, more.next_imaginary, found.next_imaginary)};
    beyond = hn::Not(hn::Lt(inside, block));
  }
  return found;
}
#elif HWY_TARGET <= HWY_AVX2
constexpr bool kInterleaved = true;

/// One load of 128 bits a pixel brings both neighbours; then each half is transposed.
HWY_INLINE Neighbours neighbours(const TileLine& line, Integers index) {
  HWY_ALIGN int at[8];
  hn::Store(index, I(), at);
  const auto load = [&](int low, int high) {
    return _mm256_insertf128_ps(
        _mm256_castps128_ps256(_mm_loadu_ps(line.real + 2 * static_cast<std::ptrdiff_t>(at[low]))),
        _mm_loadu_ps(line.real + 2 * static_cast<std::ptrdiff_t>(at[high])), 1);
  };
  const __m256 a = load(0, 4), b = load(1, 5), c = load(2, 6), d = load(3, 7);
  const __m256 ab = _mm256_unpacklo_ps(a, b), cd = _mm256_unpacklo_ps(c, d), next_ab = _mm256_unpackhi_ps(a, b),
               next_cd = _mm256_unpackhi_ps(c, d);
  return {Floats{_mm256_shuffle_ps(ab, cd, 0x44)}, Floats{_mm256_shuffle_ps(next_ab, next_cd, 0x44)},
          Floats{_mm256_shuffle_ps(ab, cd, 0xEE)}, Floats{_mm256_shuffle_ps(next_ab, next_cd, 0xEE)}};
}
#else
constexpr bool kInterleaved = true;

HWY_INLINE Neighbours neighbours(const TileLine& line, Integers index) {
  const F f;
  const auto at = hn::Add(index, index);
  return {hn::GatherIndex(f, line.real, at), hn::GatherIndex(f, line.real + 2, at),
          hn::GatherIndex(f, line.real + 1, at), hn::GatherIndex(f, line.real + 3, at)};
}
#endif

/// Linear interpolation of the line.
HWY_INLINE Complexes sampleAt(const TileLine& line, Floats position) {
  const auto floor = hn::Floor(position);
  const auto weight = hn::Sub(position, floor);
  const auto at = neighbours(line, hn::ConvertTo(I(), floor));
  return {hn::MulAdd(weight, hn::Sub(at.next_real, at.real), at.real),
          hn::MulAdd(weight, hn::Sub(at.next_imaginary, at.imaginary), at.imaginary)};
}

template <bool kMonostatic>
HWY_INLINE void addLine(const Tile& tile, const TileLine& line, float range, Floats track, Complexes& sum) {
  const F f;
  const auto difference = pathDifference<kMonostatic>(line, range, track);
  const auto carrier = phasor(hn::MulAdd(difference, hn::Set(f, tile.cycles_per_metre), hn::Set(f, line.turns)));
  const auto sample =
      sampleAt(line, hn::MulAdd(difference, hn::Set(f, tile.samples_per_metre), hn::Set(f, line.position)));
  sum.real = hn::NegMulAdd(sample.imaginary, carrier.imaginary, hn::MulAdd(sample.real, carrier.real, sum.real));
  sum.imaginary = hn::MulAdd(sample.imaginary, carrier.real, hn::MulAdd(sample.real, carrier.imaginary, sum.imaginary));
}

template <bool kMonostatic>
void accumulate(const Tile& tile, const TileLine* lines, int count, float* real, float* imaginary) {
  const F f;
  const int lanes = static_cast<int>(hn::Lanes(f));
  const auto step = hn::Set(f, tile.along_step);
  for (int row = 0; row < tile.rows; ++row) {
    const float range = tile.first_range + static_cast<float>(row) * tile.range_step;
    for (int column = 0; column < tile.columns; column += 2 * lanes) {
      const auto track = hn::MulAdd(hn::Iota(f, static_cast<float>(column)), step, hn::Set(f, tile.first_track));
      const auto next_track =
          hn::MulAdd(hn::Iota(f, static_cast<float>(column + lanes)), step, hn::Set(f, tile.first_track));
      const std::ptrdiff_t pixel = static_cast<std::ptrdiff_t>(row) * tile.columns + column;
      float *const re = real + pixel, *const im = imaginary + pixel;
      Complexes sum{hn::LoadU(f, re), hn::LoadU(f, im)}, next{hn::LoadU(f, re + lanes), hn::LoadU(f, im + lanes)};
      for (int i = 0; i < count; ++i) {
        addLine<kMonostatic>(tile, lines[i], range, track, sum);
        addLine<kMonostatic>(tile, lines[i], range, next_track, next);
      }
      hn::StoreU(sum.real, f, re);
      hn::StoreU(sum.imaginary, f, im);
      hn::StoreU(next.real, f, re + lanes);
      hn::StoreU(next.imaginary, f, im + lanes);
    }
  }
}

void accumulateHere(const Tile& tile, const TileLine* lines, int count, bool monostatic, float* real,
                    float* imaginary) {
  if (monostatic)
    accumulate<true>(tile, lines, count, real, imaginary);
  else
    accumulate<false>(tile, lines, count, real, imaginary);
}

void upsampleHere(const std::complex<float>* line, int samples, const UpsamplingTaps& taps, float* fine,
                  std::ptrdiff_t plane) {
  const hn::CappedTag<float, kUpsamplingLanes> f;
  for (int n = 0; n < samples; ++n) {
    const int first = std::max(0, taps.before - n), last = std::min(taps.count, samples + taps.before - n);
    for (int lane = 0; lane < kUpsamplingLanes; lane += static_cast<int>(hn::Lanes(f))) {
      auto re = hn::Zero(f), im = hn::Zero(f);
      for (int tap = first; tap < last; ++tap) {
        const std::complex<float> sample = line[n - taps.before + tap];
        const auto weights = hn::LoadU(f, taps.values + static_cast<std::ptrdiff_t>(tap) * kUpsamplingLanes + lane);
        re = hn::MulAdd(weights, hn::Set(f, sample.real()), re);
        im = hn::MulAdd(weights, hn::Set(f, sample.imag()), im);
      }
      const std::ptrdiff_t to = static_cast<std::ptrdiff_t>(n) * taps.stride + lane;
      if (kInterleaved) {
        hn::StoreInterleaved2(re, im, f, fine + 2 * to);
      } else {
        hn::StoreU(re, f, fine + to);
        hn::StoreU(im, f, fine + plane + to);
      }
    }
  }
}

bool interleavesHere() { return kInterleaved; }

const char* targetHere() { return hwy::TargetName(HWY_TARGET); }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace sas_motion::imaging
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sas_motion::imaging {

HWY_EXPORT(accumulateHere);
HWY_EXPORT(targetHere);
HWY_EXPORT(upsampleHere);
HWY_EXPORT(interleavesHere);

void accumulateTile(const Tile& tile, const TileLine* lines, int count, bool monostatic, float* real,
                    float* imaginary) {
  HWY_DYNAMIC_DISPATCH(accumulateHere)(tile, lines, count, monostatic, real, imaginary);
}

void upsampleLine(const std::complex<float>* line, int samples, const UpsamplingTaps& taps, float* fine,
                  std::ptrdiff_t plane) {
  HWY_DYNAMIC_DISPATCH(upsampleHere)(line, samples, taps, fine, plane);
}

bool kernelInterleaves() { return HWY_DYNAMIC_DISPATCH(interleavesHere)(); }

const char* kernelTarget() { return HWY_DYNAMIC_DISPATCH(targetHere)(); }

}  // namespace sas_motion::imaging
#endif

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <complex>
#include <cstddef>

namespace sas_motion::imaging {

/// The leg from an antenna to a tile's centre.
struct TileLeg {
  float along_range = 0, along_track = 0;  ///< twice the vector from the antenna to the centre, on the grid's axes [m]
  float range = 0, range_squared = 0;      ///< from the antenna to the centre [m, m^2]
};

/// One line at one tile: float constants about the tile's centre, where range, phase and position were found in double.
struct TileLine {
  TileLeg legs[2];  ///< transmitter, receiver; the first alone where they coincide
  /// Path to a moving receiver over that to a still one, and its gradient [-, 1/m, 1/m].
  float doppler = 1, doppler_range = 0, doppler_track = 0;
  float turns = 0;              ///< carrier phase at the centre [cycles]
  float position = 0;           ///< of the centre's echo after `real`, in [0, 1) [samples]
  const float* real = nullptr;  ///< at the sample before the centre's echo
  const float* imaginary = nullptr;
};

struct Tile {
  int rows = 0, columns = 0;                          ///< columns is a multiple of kTileLanes
  float first_range = 0, first_track = 0;             ///< of pixel (0, 0) from the centre [m]
  float range_step = 0, along_step = 0;               ///< [m]
  float cycles_per_metre = 0, samples_per_metre = 0;  ///< of path
};
constexpr int kTileLanes = 32;

/// Adds `count` lines to the tile's pixels, rows by columns. With `monostatic` the first leg counts twice.
void accumulateTile(const Tile& tile, const TileLine* lines, int count, bool monostatic, float* real, float* imaginary);

constexpr int kUpsamplingLanes = 16;
struct UpsamplingTaps {
  const float* values = nullptr;  ///< count x kUpsamplingLanes
  int count = 0;
  int before = 0;  ///< samples from the first tap to the current one
  int stride = 0;  ///< fine samples a sample; at most kUpsamplingLanes
};

/// Whether real and imaginary parts alternate in a fine line; else the imaginary ones lie a plane behind the real ones.
bool kernelInterleaves();

/// Upsamples a line; samples outside it are zero. Writes kUpsamplingLanes values from the last stride on.
void upsampleLine(const std::complex<float>* line, int samples, const UpsamplingTaps& taps, float* fine,
                  std::ptrdiff_t plane);

const char* kernelTarget();

}  // namespace sas_motion::imaging

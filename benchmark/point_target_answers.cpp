// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Chips with one point target each, and what measurePointTarget() says of them, for benchmark/compare_measures.py,
// which gives the same to other people's code. Writes NAME.npy and NAME.json to FOLDER and prints the measures as JSON.
// usage: point_target_answers FOLDER
#include <cstdlib>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>

#include "imaging/fourier.hpp"
#include "sas_motion/imaging/backprojection.hpp"
#include "sas_motion/imaging/echo_lines.hpp"
#include "sas_motion/imaging/echo_simulation.hpp"
#include "sas_motion/imaging/image.hpp"
#include "sas_motion/imaging/point_target.hpp"
#include "sas_motion/math/angles.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::imaging;
using nlohmann::json;

constexpr int kHalfSize = 64, kSize = 2 * kHalfSize;
constexpr int kBand = kSize * 2 / 5;  // bins that the spectrum fills: 2.5 pixels a resolution cell

ImageGrid chipGrid() {
  ImageGrid grid;
  grid.rows = grid.columns = kSize;
  grid.origin = {-0.5 * kSize * grid.along_step, -0.5 * kSize * grid.range_step, 0};
  return grid;
}

/// The response, a quarter of a pixel beside the middle, to a spectrum of this weight over u in [-1, 1] that begins at
/// `first_bin`.
Spectrum response(int first_bin, const std::function<std::complex<double>(double)>& weight) {
  constexpr double kPlace = kHalfSize + 0.25;
  Spectrum line(kSize);
  for (int i = 0; i < kBand; ++i) {
    const int bin = first_bin + i;
    line[static_cast<std::size_t>((bin + kSize) % kSize)] =
        std::polar(1.0, -2 * kPi * bin * kPlace / kSize) * weight(2 * (i + 0.5) / kBand - 1);
  }
  Fourier(kSize).inverse(line);
  return line;
}

Image chip(const Spectrum& range, const Spectrum& along) {
  Image image{chipGrid(), {}};
  for (const auto& a : range)
    for (const auto& b : along) image.pixels.emplace_back(a * b);
  return image;
}

std::complex<double> one(double) { return 1; }
std::complex<double> hamming(double u) { return 0.54 + 0.46 * std::cos(kPi * u); }
std::complex<double> quadratic(double u) {
  return std::polar(1.0, 4 * kPi * u * u / 8);
}  // a slant error of an eighth of a wavelength at the edge

/// Simulated, compressed and focused by backprojection: one target abeam of a straight track.
Image focused() {
  SonarDescription sonar;
  sonar.receivers = 1;
  sonar.near_range = 26;
  sonar.far_range = 36;
  sonar.stop_and_hop = true;
  std::vector<PingPose> track(240);
  for (std::size_t i = 0; i < track.size(); ++i) track[i].position = {0.025 * (static_cast<double>(i) - 119.5), 0, 10};
  Scene scene;
  scene.scatterers.push_back({{0.003, 29.002, 0}, 1});
  CompressionOptions options;
  options.filter = RangeFilter::Equalized;
  ImageGrid grid = chipGrid();
  grid.origin.y() += 29;
  return backproject(compressRange(simulateEchoes(sonar, echoPaths(sonar, track), scene, {}), sonar, options), grid,
                     {});
}

json described(const CutMeasures& cut) {
  return {{"irw", cut.irw},       {"pslr", cut.pslr},        {"islr", cut.islr}, {"main_lobe", cut.main_lobe},
          {"extent", cut.extent}, {"complete", cut.complete}};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: point_target_answers FOLDER\n";
    return EXIT_FAILURE;
  }
  constexpr int kAround = -kBand / 2,
                kAcross =
                    kSize / 2 -
                    kBand / 3;  // the latter lies across the end of the spectrum, as an image's with a carrier may
  const std::pair<std::string, Image> chips[] = {
      {"unweighted", chip(response(kAcross, one), response(kAround, one))},
      {"Hamming", chip(response(kAcross, hamming), response(kAround, hamming))},
      {"quadratic", chip(response(kAcross, one), response(kAround, quadratic))},
      {"focused", focused()},
  };
  json result = json::array();
  for (const auto& [name, image] : chips) {
    writeImage(std::string(argv[1]) + "/" + name, image);
    const ImageGrid& grid = image.grid;
    ChipOptions options;
    options.half_size = kHalfSize;
    options.search_radius = 0.02;  // the chip is no larger than what is measured
    const auto measures = measurePointTarget(image, grid.point(kHalfSize, kHalfSize), options);
    result.push_back({{"name", name}, {"range", described(measures.range)}, {"along", described(measures.along)}});
  }
  std::cout << result << "\n";
}

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A problem of backprojection and what we make of it, for benchmark/compare_backprojection.py, which gives the same to
// other people's code. Writes to FOLDER the range-compressed lines (lines.c64), our image, and the middle of it in
// double (image, reference: .npy, .json); prints the problem and our rates as JSON. usage: backprojection_answers
// FOLDER LINES ROWS COLUMNS REPEATS
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "sas_motion/imaging/image.hpp"
#include "speckle_problem.hpp"

namespace {

using namespace sas_motion;
using namespace sas_motion::benchmark;
using nlohmann::json;

json described(const EchoLines& lines) {
  json places = json::array();
  for (const auto& path : lines.paths)
    places.push_back({path.transmitter.x(), path.transmitter.y(), path.transmitter.z()});
  return {{"carrier", lines.carrier},         {"sound_speed", lines.sound_speed}, {"sample_rate", lines.sample_rate},
          {"first_delay", lines.first_delay}, {"samples", lines.samples},         {"places", places}};
}

void writeLines(const std::string& name, const EchoLines& lines) {
  std::ofstream stream(name, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(lines.data.data()),
               static_cast<std::streamsize>(lines.data.size() * sizeof(lines.data[0])));
  if (!stream.flush()) throw std::runtime_error(name + " could not be written");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) {
    std::cerr << "usage: backprojection_answers FOLDER LINES ROWS COLUMNS REPEATS\n";
    return EXIT_FAILURE;
  }
  const std::string folder = argv[1];
  const EchoLines lines = speckleLines(std::atoi(argv[2]), false);
  const ImageGrid grid = patch(std::atoi(argv[3]), std::atoi(argv[4]));
  ImageGrid middle = grid;
  middle.rows = middle.columns = 64;
  middle.origin = grid.point((grid.rows - middle.rows) / 2, (grid.columns - middle.columns) / 2);
  json problem = described(lines);
  problem["rates"] = json::object();
  forEachInstructionSet([&] {
    problem["rates"][backprojectionTarget()] =
        rate(lines, std::atoi(argv[5]), [&] { return backproject(lines, grid, {}); }).cpu;
  });
  writeLines(folder + "/lines.c64", lines);
  writeImage(folder + "/image", backproject(lines, grid, {}));
  writeImage(folder + "/reference", backprojectReference(lines, middle, 1));
  std::cout << problem << "\n";
}

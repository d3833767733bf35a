// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/scene.hpp"

#include <algorithm>
#include <cmath>

#include "sas_motion/math/random.hpp"

namespace sas_motion::imaging {
namespace {

/// Speckle on the rectangle corner + [0,1] a + [0,1] b, with this power an area. Points inside blocks are left out.
void addRectangle(Scene& scene, const Eigen::Vector3d& corner, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                  double density, double power, Random& random) {
  const double area = std::sqrt(std::max(0.0, a.squaredNorm() * b.squaredNorm() - std::pow(a.dot(b), 2)));
  const auto count = static_cast<std::size_t>(std::lround(area * density));
  const double sigma = std::sqrt(power / density / 2);
  for (std::size_t i = 0; i < count; ++i) {
    const double along_a = random.uniform(), along_b = random.uniform();
    const double real = sigma * random.gaussian(), imaginary = sigma * random.gaussian();
    const Eigen::Vector3d place = corner + along_a * a + along_b * b;
    const auto covers = [&](const Block& block) {  // the bottom under a block, and only that
      return place.z() < block.upper.z() && (place.head<2>().array() > block.lower.head<2>().array()).all() &&
             (place.head<2>().array() < block.upper.head<2>().array()).all();
    };
    if (std::none_of(scene.blocks.begin(), scene.blocks.end(), covers))
      scene.scatterers.push_back({place, {real, imaginary}});
  }
}

/// A block's five visible faces.
void addFaces(Scene& scene, const Block& block, double density, double power, Random& random) {
  const Eigen::Vector3d size = block.upper - block.lower;
  const Eigen::Vector3d x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
  addRectangle(scene, block.lower, x, z, density, power, random);
  addRectangle(scene, block.lower + y, x, z, density, power, random);
  addRectangle(scene, block.lower, y, z, density, power, random);
  addRectangle(scene, block.lower + x, y, z, density, power, random);
  addRectangle(scene, block.lower + z, x, y, density, power, random);
}

}  // namespace

bool Block::hides(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  constexpr double kSkin = 1e-6;  // a face does not hide itself
  const Eigen::Vector3d way = to - from;
  double enter = 0, leave = 1;  // the slab test, over the share of the way
  for (int axis = 0; axis < 3; ++axis) {
    if (way(axis) == 0) {
      if (from(axis) <= lower(axis) || from(axis) >= upper(axis)) return false;
      continue;
    }
    const double a = (lower(axis) - from(axis)) / way(axis), b = (upper(axis) - from(axis)) / way(axis);
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return (std::min(leave, 1.0) - enter) * way.norm() > kSkin;
}

Scene speckleScene(const SpeckleOptions& options, const std::vector<Block>& blocks, std::uint64_t seed) {
  Scene scene;
  scene.blocks = blocks;
  Random bottom(seed, 1), faces(seed, 2);
  const Eigen::Vector3d size = options.upper - options.lower;
  addRectangle(scene, options.lower, {size.x(), 0, 0}, {0, size.y(), 0}, options.density, 1, bottom);
  for (const auto& block : blocks) addFaces(scene, block, options.density, options.block_contrast, faces);
  return scene;
}

}  // namespace sas_motion::imaging

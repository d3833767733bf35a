// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/bag/bag_file.hpp"

#include <filesystem>

namespace sas_motion::ros_side {

std::unique_ptr<rosbag::Bag> openBag(const std::string& path) {
  if (!std::filesystem::exists(path)) throw std::runtime_error(fmt::format("{}: no such file; check the path", path));
  auto bag = std::make_unique<rosbag::Bag>();
  try {
    bag->open(path, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw std::runtime_error(fmt::format("{}: has no index, as after a crash of the recorder; run 'rosbag reindex {}' first", path, path));
  } catch (const rosbag::BagException& error) {
    throw std::runtime_error(fmt::format("{}: is no whole rosbag ({}); if it was cut short, 'rosbag reindex' may save what is there", path, error.what()));
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("{}: cannot be read as a rosbag: {}", path, error.what()));
  }
  return bag;
}

BagOutput::BagOutput(const std::string& path) : path_(path), file_(path), writer_(guarded([&] { return BagWriter(file_.temporary()); })) {}

void BagOutput::copy(const rosbag::MessageInstance& message) {
  guarded([&] { writer_.copy(message); });
}

void BagOutput::close() {
  guarded([&] { writer_.close(); });
}

void BagOutput::commit() {
  close();
  file_.commit();
}

}  // namespace sas_motion::ros_side

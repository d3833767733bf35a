// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bag/bag_output.hpp"

namespace sas_motion::ros_side {

BagOutput::BagOutput(const std::string& path)
    : path_(path), file_(path), writer_(guarded([&] { return BagWriter(file_.temporary()); })) {}

void BagOutput::close() {
  guarded([&] { writer_.close(); });
}

void BagOutput::commit() {
  close();
  file_.commit();
}

}  // namespace sas_motion::ros_side

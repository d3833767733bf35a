// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/focus_result.hpp"

#include "sas_motion/imaging/image_file.hpp"
#include "sas_motion/io/atomic_file.hpp"

namespace sas_motion::imaging {
namespace {

FocusImage written(const FocusedImage& focused, const std::string& folder, const std::string& stem) {
  makeFolder(folder);
  writeImage(folder + "/" + stem, focused.image);
  return {stem, focused.targets, focused.whole_image_islr, focused.entropy};
}

}  // namespace

FocusedTrajectory focusAlong(FocusBench& bench, const std::vector<PingPose>& poses, const std::string& folder,
                             const std::string& name, bool autofocus) {
  FocusedTrajectory result{name, "", bench.error(poses), {}, std::nullopt};
  const FocusedImage focused = bench.focus(poses);
  result.image = written(focused, folder, name);
  if (autofocus) result.autofocused = written(bench.autofocus(focused, poses), folder, name + "_autofocus");
  return result;
}

}  // namespace sas_motion::imaging

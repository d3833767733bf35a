// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "campaign/imaging_measures.hpp"

namespace sas_motion::imaging {
namespace {

void addCut(Named<double>& measures, const std::string& prefix, const std::string& name, const CutMeasures& cut,
            const CutMeasures& reference) {
  measures.emplace_back(prefix + "pslr_" + name, cut.pslr - reference.pslr);
  measures.emplace_back(prefix + "islr_" + name, cut.islr - reference.islr);
  measures.emplace_back(prefix + "irw_" + name, cut.irw / reference.irw);
}

void addImage(Named<double>& measures, const std::string& prefix, const FocusedImage& image,
              const FocusedImage& error_free) {
  const auto &target = image.targets.front(), &reference = error_free.targets.front();
  if (!target.complete) return;
  addCut(measures, prefix, "along", target.along, reference.along);
  addCut(measures, prefix, "range", target.range, reference.range);
  measures.emplace_back(prefix + "peak_loss", target.peak_loss);
  measures.emplace_back(prefix + "peak_error", target.peak_error);
}

}  // namespace

Named<double> imageMeasures(FocusBench& bench, const std::vector<PingPose>& poses, double wavelength) {
  const auto error = bench.error(poses);
  Named<double> measures{{"speed", error.along.slope}};
  for (const auto& [name, rms] :
       {std::pair("path", error.path.rms), std::pair("line_of_sight", error.line_of_sight.rms),
        std::pair("along", error.along.rms)}) {
    measures.emplace_back(name, rms);
    measures.emplace_back(std::string(name) + "_wavelengths", rms / wavelength);
  }
  const FocusedImage focused = bench.focus(poses);
  addImage(measures, "", focused, bench.errorFree());
  addImage(measures, "autofocus_", bench.autofocus(focused, poses), bench.errorFree());
  addImage(measures, "compensated_", bench.compensate(poses), bench.errorFree());
  return measures;
}

double horizontalError(const std::vector<PingPose>& estimate, const std::vector<PingPose>& truth) {
  Eigen::Vector2d error = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < truth.size(); ++i)
    error += (estimate[i].position - truth[i].position).head<2>() / static_cast<double>(truth.size());
  return error.norm();
}

}  // namespace sas_motion::imaging

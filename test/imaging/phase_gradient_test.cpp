// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "imaging/imaging_support.hpp"
#include "sas_motion/imaging/motion_compensation.hpp"
#include "sas_motion/imaging/point_target.hpp"

namespace sas_motion::imaging::testing {
namespace {

const Eigen::Vector3d kMiddle(0, 29, 0);

/// Points over 1.5 m of range and little of the track, seen by all of the aperture, with this slant error [m] over it.
template <class Error>
Image patch(Error&& error) {
  SonarDescription sonar = smallSonar();
  sonar.element = 0.05;
  Random random(11);
  std::vector<Eigen::Vector3d> places{kMiddle};
  for (int i = 0; i < 12; ++i)
    places.push_back(kMiddle + Eigen::Vector3d(0.8 * (random.uniform() - 0.5), 0.13 * (i - 5.5), 0));
  const auto paths = echoPaths(sonar, track(120, 0.04));
  EchoOptions options;
  for (std::size_t i = 0; i < paths.size(); ++i)
    options.slant_errors.push_back(error(2 * (static_cast<double>(i) + 0.5) / static_cast<double>(paths.size()) - 1));
  return backproject(compressedEchoes(sonar, paths, points(places), options),
                     gridAround(kMiddle, 240, 128, 0.008, 0.025), {});
}

/// Of the point in the middle, between pixels [dB].
double peak(const Image& image) {
  ChipOptions options;
  options.search_radius = 0.1;
  return 10 * std::log10(measurePointTarget(image, kMiddle, options).range.peak_power);
}

TEST(PhaseGradientAutofocus, TakesAQuadraticErrorAndASineOff) {
  const double wavelength = smallSonar().wavelength();
  const Image sharp = patch([](double) { return 0; });
  const Image blurred = patch([&](double u) { return wavelength * (u * u / 4 + std::sin(3 * kPi * u) / 16); });
  const Autofocus focused = phaseGradientAutofocus(blurred, {});
  EXPECT_LT(peak(blurred), peak(sharp) - 3);
  EXPECT_GT(peak(focused.image), peak(sharp) - 0.7);
  EXPECT_LT(imageEntropy(focused.image), imageEntropy(blurred) - 0.3);
}

TEST(PhaseGradientAutofocus, LeavesASharpImageAsItIs) {
  const Image sharp = patch([](double) { return 0; });
  const Autofocus focused = phaseGradientAutofocus(sharp, {});
  EXPECT_GT(peak(focused.image), peak(sharp) - 0.2);
}

}  // namespace
}  // namespace sas_motion::imaging::testing

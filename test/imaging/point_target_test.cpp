// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/point_target.hpp"

#include <algorithm>
#include <functional>

#include "imaging/fourier.hpp"
#include "imaging/imaging_support.hpp"

namespace sas_motion::imaging::testing {
namespace {

/// The response of an aperture of 400 samples with this weight and slant error [in wavelengths] over u in [-1, 1],
/// critically sampled over 1.25.
std::vector<std::complex<double>> response(const std::function<double(double)>& weight,
                                           const std::function<double(double)>& error) {
  constexpr int kAperture = 400, kLine = 500;
  Spectrum line(kLine);
  for (int i = 0; i < kAperture; ++i) {
    const double u = 2.0 * (i + 0.5) / kAperture - 1;
    line[static_cast<std::size_t>((i - kAperture / 2 + kLine) % kLine)] = std::polar(weight(u), 4 * kPi * error(u));
  }
  Fourier(kLine).inverse(line);
  std::rotate(line.begin(), line.begin() + kLine / 2, line.end());
  return line;
}
double one(double) { return 1; }
double none(double) { return 0; }

struct Known {
  double pslr, islr, loss;
};
Known measured(const std::function<double(double)>& error) {
  const CutMeasures ideal = measureCut(response(one, none), 1), blurred = measureCut(response(one, error), 1);
  EXPECT_TRUE(blurred.complete);
  return {blurred.pslr, blurred.islr, 10 * std::log10(ideal.peak_power / blurred.peak_power)};
}
void expectNear(const Known& found, const Known& known, double tolerance) {
  EXPECT_NEAR(found.pslr, known.pslr, tolerance);
  EXPECT_NEAR(found.islr, known.islr, tolerance);
  EXPECT_NEAR(found.loss, known.loss, tolerance);
}

TEST(CutMeasures, OfTheIdealUnweightedResponse) {
  const CutMeasures ideal = measureCut(response(one, none), 0.02);
  EXPECT_NEAR(ideal.pslr, -13.26, 0.01);
  EXPECT_NEAR(ideal.islr, -10.1, 0.1);  // -9.68 dB less what lies beyond ten null widths: -10.16 dB
  EXPECT_NEAR(ideal.islr, -10.16, 0.02);
  EXPECT_NEAR(ideal.main_lobe, 2 * 1.25 * 0.02, 0.02 / kOversampling);
  EXPECT_NEAR(ideal.extent, 10 * 1.25 * 0.02, 10 * 0.02 / kOversampling);
  EXPECT_NEAR(ideal.irw, 0.8845 * 1.25 * 0.02, 1e-3 * 0.02);  // at 10^(-0.3) of the power
  EXPECT_NEAR(ideal.peak_position, 250 * 0.02, 1e-6);
  EXPECT_TRUE(ideal.complete);
}

TEST(CutMeasures, OfAHammingWindow) {
  const CutMeasures hamming = measureCut(response([](double u) { return 0.54 + 0.46 * std::cos(kPi * u); }, none), 1);
  EXPECT_NEAR(hamming.pslr, -42.7, 0.1);
}

TEST(CutMeasures, DoNotDependOnWhereTheSpectrumLies) {
  auto cut = response(one, none);
  const CutMeasures before = measureCut(cut, 1);
  for (std::size_t i = 0; i < cut.size(); ++i) cut[i] *= std::polar(1.0, 2 * kPi * 0.37 * static_cast<double>(i));
  const CutMeasures after = measureCut(cut, 1);
  EXPECT_NEAR(after.pslr, before.pslr, 1e-3);
  EXPECT_NEAR(after.islr, before.islr, 1e-3);
  EXPECT_NEAR(after.irw, before.irw, 1e-4);
}

TEST(CutMeasures, GiveTheKnownAnswersForInjectedSlantErrors) {
  expectNear(measured([](double u) { return u * u / 16; }), {-12.0, -8.9, 0.2}, 0.1);
  expectNear(measured([](double u) { return u * u / 8; }), {-9.0, -6.5, 1.0}, 0.1);
  expectNear(measured([](double u) { return std::sin(3 * kPi * u) / 16; }), {-6.5, -3.0, 1.3}, 0.1);
  expectNear(measured([](double u) { return std::sin(3 * kPi * u) / 8; }), {-0.2, 3.4, 4.7}, 0.1);
}

TEST(CutMeasures, GiveTheKnownAnswerForARandomWalk) {
  constexpr int kRuns = 400, kSteps = 400;
  std::vector<double> pslr, islr, loss;
  for (int run = 0; run < kRuns; ++run) {
    Random random(7, static_cast<std::uint64_t>(run));
    std::vector<double> walk(kSteps);
    double at = 0, mean = 0, slope = 0, squares = 0;
    for (auto& value : walk) value = at += random.gaussian();
    const auto u = [](int i) { return 2.0 * (i + 0.5) / kSteps - 1; };
    for (int i = 0; i < kSteps; ++i) {
      mean += walk[i] / kSteps;
      slope += 3 * u(i) * walk[i] / kSteps;
    }
    for (int i = 0; i < kSteps; ++i) squares += std::pow(walk[i] -= mean + slope * u(i), 2) / kSteps;
    const double scale = 1 / (32 * std::sqrt(squares));
    const Known found =
        measured([&](double at_u) { return scale * walk[static_cast<std::size_t>((at_u + 1) / 2 * kSteps)]; });
    pslr.push_back(found.pslr);
    islr.push_back(found.islr);
    loss.push_back(found.loss);
  }
  const auto median = [](std::vector<double>& values) {
    std::nth_element(values.begin(), values.begin() + kRuns / 2, values.end());
    return values[kRuns / 2];
  };
  expectNear({median(pslr), median(islr), median(loss)}, {-8.8, -6.2, 0.7}, 0.3);
}

TEST(CutMeasures, SayWhereTheCutIsTooShort) {
  auto cut = response(one, none);
  EXPECT_FALSE(measureCut({cut.begin() + 244, cut.begin() + 256}, 1).complete);
}

TEST(PointTarget, IsFoundBetweenPixelsWithItsPower) {
  const SonarDescription sonar = smallSonar();
  const Eigen::Vector3d target(0.307, 29.003, 0);
  const EchoLines lines = compressedEchoes(sonar, echoPaths(sonar, track(120, 0.05, 0.05)), points({target}));
  const Image image = backproject(lines, gridAround({0.3, 29, 0}, 160, 160, 0.006, 0.02), {});
  double beams = 0;
  for (const auto& path : lines.paths) beams += beamAmplitude(path, target, sonar);
  ChipOptions options;
  options.half_size = 64;
  options.reference_power = beams * beams;
  const auto measures = measurePointTarget(image, target, options);
  ASSERT_TRUE(measures.complete);
  EXPECT_LT(measures.peak_error, 5e-4);
  EXPECT_NEAR(measures.peak_loss, 0, 0.02);
  const double ground = std::sqrt(29.003 * 29.003 + 100) / 29.003;  // slant to ground
  EXPECT_NEAR(measures.range.irw, 0.886 * sonar.rangeResolution() * ground, 0.03 * sonar.rangeResolution());
  EXPECT_NEAR(measures.range.pslr, -13.26, 0.5);  // the sector of wave numbers is no rectangle
  EXPECT_LT(measures.along.irw, 0.06);
}

TEST(PointTarget, MeasuresLossEntropyAndEnergyOfADefocusedImage) {
  const SonarDescription sonar = smallSonar();
  const Eigen::Vector3d target(0, 29, 0);
  const auto paths = echoPaths(sonar, track(120, 0.05));
  EchoOptions swaying;
  for (std::size_t i = 0; i < paths.size(); ++i)
    swaying.slant_errors.push_back(sonar.wavelength() / 10 * std::sin(0.3 * static_cast<double>(i)));
  const ImageGrid grid = gridAround(target, 160, 200, 0.006, 0.02);
  const Image sharp = backproject(compressedEchoes(sonar, paths, points({target})), grid, {});
  const Image blurred = backproject(compressedEchoes(sonar, paths, points({target}), swaying), grid, {});
  const auto reference = measurePointTarget(sharp, target, {});
  ChipOptions options;
  options.reference_power = reference.range.peak_power;
  const auto measures = measurePointTarget(blurred, target, options);
  EXPECT_NEAR(measures.peak_loss, -20 * std::log10(std::cyl_bessel_j(0, 4 * kPi / 10)),
              0.4);  // of a sine's phase modulation
  EXPECT_GT(imageEntropy(blurred), imageEntropy(sharp) + 0.3);
  EXPECT_GT(wholeImageIslr(blurred, measures), wholeImageIslr(sharp, reference) + 3);
}

TEST(PointTarget, AtTheEdgeIsNotComplete) {
  Image image{gridAround({0, 29, 0}, 40, 40), std::vector<std::complex<float>>(1600)};
  image.at(1, 1) = 1;
  EXPECT_FALSE(measurePointTarget(image, image.grid.point(1, 1), {}).complete);
}

}  // namespace
}  // namespace sas_motion::imaging::testing

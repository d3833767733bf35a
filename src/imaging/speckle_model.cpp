// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "imaging/micronavigation_steps.hpp"
#include "sas_motion/math/angles.hpp"

namespace sas_motion::imaging {
namespace {

using Covariance = Eigen::MatrixXcd;

constexpr int kBlock = 64;               // samples over which geometry is constant
constexpr int kTableSteps = 600;         // over three elements
constexpr double kMostCoherence = 0.99;  // what interpolation and the model leave
constexpr int kMaxIterations = 20;
constexpr double kTolerance = 0.02;  // of the last step, in standard deviations

/// A stretch of range: the channels' sample covariance and geometry.
struct Block {
  Covariance sample;
  Eigen::VectorXd along, sine, curvature;  // of each channel: place [m], middle of its beam, of its path [m]
  double across, down, arm;                // of the sight; arm: the place that a turn is about [m]
};

std::vector<Block> blocks(const AlignedLines& lines, const PingPair& pair, double spread) {
  const auto channels = static_cast<Eigen::Index>(lines.channels.size());
  std::vector<Block> result;
  for (int begin = 0; begin + kBlock <= lines.samples; begin += kBlock) {
    const double range = lines.range(begin + 0.5 * (kBlock - 1));
    const Eigen::Vector3d sight = pair.sight(range, 0);
    Eigen::MatrixXcd samples(channels, kBlock);
    const Eigen::VectorXd each = Eigen::VectorXd::Zero(channels);
    Block block{{}, each, each, each, sight.dot(pair.across), sight.dot(pair.down), 0};
    for (Eigen::Index a = 0; a < channels; ++a) {
      const auto channel = static_cast<std::size_t>(a);
      const PingPair::PathShape shape = pair.shape(channel, range, spread);
      block.along(a) = pair.along(channel, range) - shape.slope;  // what a place further forward would do
      block.sine(a) = pair.beamSine(channel, sight);
      block.curvature(a) = shape.curvature;
      samples.row(a) = Eigen::Map<const Eigen::RowVectorXcd>(lines.channels[channel].data() + begin, kBlock);
    }
    block.arm = block.along.tail(channels / 2).mean();
    block.sample = samples * samples.adjoint() / kBlock;
    result.push_back(std::move(block));
  }
  return result;
}

class SpeckleModel {
 public:
  SpeckleModel(const BeamCoherence& beam, double wavelength) : beam_(beam), wave_number_(2 * kPi / wavelength) {}

  /// The channels' covariance at power 1. Where the second ping is further along the sight than predicted, its echo is
  /// early and alignment by the predicted path turns its phase too far.
  Covariance covariance(const Block& block, const SpeckleParameters& p) const {
    const Eigen::Index channels = block.along.size(), receivers = channels / 2;
    Eigen::VectorXd along = block.along, sine = block.sine, slant = Eigen::VectorXd::Zero(channels);
    along.tail(receivers).array() += p(kAlong);
    sine.tail(receivers).array() -= p(kTurn);  // the beam turns with the array: one ping alone does not observe a turn
    slant.tail(receivers) = (block.along.tail(receivers).array() - block.arm) * p(kTurn) + block.across * p(kAcross) +
                            block.down * p(kDown);
    Covariance S = Covariance::Identity(channels, channels);
    for (Eigen::Index a = 0; a < channels; ++a)
      for (Eigen::Index b = 0; b < a; ++b) {
        const double level = (a < receivers) == (b < receivers) ? p(kWithinPing) : p(kBetweenPings);
        const double apart = along(a) - along(b), squint = 0.5 * (sine(a) + sine(b));
        const Complex coherence(
            beam_.at(apart), -2 * wave_number_ * (block.curvature(a) - block.curvature(b)) * beam_.squaredSine(apart));
        S(a, b) = level * coherence * std::polar(1.0, 2 * wave_number_ * (slant(a) - slant(b) + apart * squint));
        S(b, a) = std::conj(S(a, b));
      }
    return S;
  }

  Covariance derivative(const Block& block, const SpeckleParameters& p, int parameter) const {
    const double step = parameter == kAlong ? 1e-3 : 1e-5;  // over several steps of the beam's table
    SpeckleParameters up = p, below = p;
    up(parameter) += step;
    below(parameter) -= step;
    return (covariance(block, up) - covariance(block, below)) / (2 * step);
  }

 private:
  const BeamCoherence& beam_;
  double wave_number_;
};

double traceOfProduct(const Covariance& a, const Covariance& b) { return a.cwiseProduct(b.transpose()).sum().real(); }

/// Adds a block's score and Fisher information for unknown power.
void accumulate(const SpeckleModel& model, const Block& block, double cells, const SpeckleParameters& p,
                SpeckleParameters& score, Eigen::MatrixXd& information) {
  const Eigen::Index channels = block.along.size();
  const Covariance S = model.covariance(block, p);
  const Covariance inverse = S.llt().solve(Covariance::Identity(channels, channels));
  const double power = traceOfProduct(inverse, block.sample) / static_cast<double>(channels);
  if (!(power > 0)) return;
  const Covariance excess = inverse * (block.sample / power - S);
  std::array<Covariance, kSpeckleParameters> W;  // S^-1 dS
  SpeckleParameters trace;
  for (int i = 0; i < kSpeckleParameters; ++i) {
    W[static_cast<std::size_t>(i)] = inverse * model.derivative(block, p, i);
    trace(i) = W[static_cast<std::size_t>(i)].trace().real();
  }
  for (int i = 0; i < kSpeckleParameters; ++i) {
    score(i) += cells * traceOfProduct(W[static_cast<std::size_t>(i)], excess);
    for (int j = 0; j < kSpeckleParameters; ++j)
      information(i, j) += cells * (traceOfProduct(W[static_cast<std::size_t>(i)], W[static_cast<std::size_t>(j)]) -
                                    trace(i) * trace(j) / static_cast<double>(channels));
  }
}

}  // namespace

BeamCoherence::BeamCoherence(const SonarDescription& sonar)
    : step_(3 * sonar.element / kTableSteps), coherence_(kTableSteps + 1), squares_(kTableSteps + 1) {
  constexpr int kAngles = 400, kFrequencies = 9;
  const double edge = std::min(0.99, 2 * sonar.wavelength() / sonar.element);  // the second null
  double power = 0, squares = 0;
  EchoPath path;
  for (int angle = 0; angle < kAngles; ++angle) {
    const double sine = edge * ((angle + 0.5) / kAngles), cosine = std::sqrt(1 - sine * sine);
    const double weight = std::pow(beamAmplitude(path, {sine, cosine, 0}, sonar), 2) / cosine;
    power += weight;
    squares += weight * sine * sine;
    for (int frequency = 0; frequency < kFrequencies; ++frequency) {
      const double waves =
          (sonar.carrier + sonar.bandwidth * ((frequency + 0.5) / kFrequencies - 0.5)) / sonar.sound_speed;
      for (std::size_t i = 0; i < coherence_.size(); ++i) {
        const double share = weight * std::cos(4 * kPi * waves * sine * step_ * static_cast<double>(i)) / kFrequencies;
        coherence_[i] += share;
        squares_[i] += share * sine * sine;
      }
    }
  }
  for (auto* table : {&coherence_, &squares_})
    for (auto& value : *table) value /= power;
  spread_ = std::sqrt(squares / power);
}

double BeamCoherence::read(const std::vector<double>& table, double distance) const {
  const double place = std::abs(distance) / step_;
  const auto below = static_cast<std::size_t>(place);
  if (below + 1 >= table.size()) return 0;
  const double share = place - static_cast<double>(below);
  return (1 - share) * table[below] + share * table[below + 1];
}

SpeckleEstimate fitSpeckle(const AlignedLines& lines, const PingPair& pair, const SonarDescription& sonar,
                           const BeamCoherence& beam, const SpeckleParameters& start) {
  const SpeckleModel model(beam, sonar.wavelength());
  const std::vector<Block> stretches = blocks(lines, pair, beam.spread());
  const double cells = kBlock / sonar.oversampling;
  SpeckleEstimate estimate{start, {}, false};
  SpeckleParameters& p = estimate.parameters;
  for (int iteration = 0; iteration < kMaxIterations && !estimate.converged; ++iteration) {
    SpeckleParameters score = SpeckleParameters::Zero();
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(kSpeckleParameters, kSpeckleParameters);
    for (const auto& block : stretches) accumulate(model, block, cells, p, score, information);
    const Eigen::LLT<Eigen::MatrixXd> factor(information);
    if (factor.info() != Eigen::Success) return estimate;
    estimate.covariance = factor.solve(Eigen::MatrixXd::Identity(kSpeckleParameters, kSpeckleParameters));
    const SpeckleParameters before = p;
    p += factor.solve(score);
    p(kWithinPing) = std::clamp(p(kWithinPing), 0.0, kMostCoherence);
    p(kBetweenPings) = std::clamp(p(kBetweenPings), 0.0, kMostCoherence * p(kWithinPing));
    estimate.converged =
        ((p - before).array().abs() < kTolerance * estimate.covariance.diagonal().array().sqrt()).all();
  }
  return estimate;
}

}  // namespace sas_motion::imaging

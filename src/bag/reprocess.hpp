// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bag/bag_output.hpp"
#include "bag/bag_reader.hpp"
#include "ros/inbox.hpp"

namespace sas_motion::ros_side {

/// What became of one bag.
struct ReprocessReport {
  std::string input, output;
  std::uint64_t messages = 0;
  double duration = 0;  ///< of the bag [s]
  std::map<std::string, MessageCounts> sensors;
  struct PerEstimator {
    std::uint64_t estimates = 0;
    std::array<std::uint64_t, 5> verdicts{};  ///< by Verdict
    std::uint64_t measurements = 0;
    std::string failure;  ///< of a smoother's solver, in plain words
    double seconds = 0;   ///< CPU time of the estimator alone
  };
  std::map<std::string, PerEstimator> estimators;
  std::vector<std::string> remarks;  ///< on what the data lack, a sentence each
};

/// A bag on its way through the estimators of one system.
class BagRun {
 public:
  virtual ~BagRun() = default;

  /// Whether a connection is of one of the sensors.
  virtual bool isSensor(const BagConnection& connection) const = 0;
  /// Takes a sensor's message.
  virtual void take(const BagReader& bag, const BagMessage& message) = 0;
  /// The end of the bag. Throws std::runtime_error where nothing could be estimated.
  virtual void finish(ReprocessReport& report) = 0;
  /// Puts the files beside the bag in place.
  virtual void commit() = 0;
  /// The origin of the map, once there is one.
  virtual const std::optional<LocalFrame>& frame() const = 0;
};

/// Where a run gets transforms from and writes to.
struct RunOutput {
  const tf2::BufferCore& transforms;
  BagOutput& bag;
  std::string stem;  ///< path of the output without its extension
};

/// What reprocess runs: the estimators of one system, set up by a configuration file.
class ReprocessSystem {
 public:
  virtual ~ReprocessSystem() = default;
  /// Throws std::runtime_error with a sentence where there is no such estimator.
  virtual void require(const std::string& estimator) const = 0;
  /// Throws std::runtime_error naming the file and the topics that are missing.
  virtual std::unique_ptr<BagRun> begin(const BagReader& source, const std::string& file,
                                        const std::vector<std::string>& estimators, const RunOutput& out) const = 0;
  virtual const MapSettings& map() const = 0;
};

std::unique_ptr<ReprocessSystem> makeTowfishSystem(const std::string& config);
std::unique_ptr<ReprocessSystem> makeInsSystem(const std::string& config);
/// The system that the configuration file is of: towfish where it does not say. Throws ConfigError.
std::unique_ptr<ReprocessSystem> makeReprocessSystem(const std::string& config);

/// Runs estimators over a bag and writes a bag of the same name into `folder`: the input's messages, and each
/// estimator's estimates and audit; beside it a TUM file for each estimator. Throws std::runtime_error naming the file
/// or topic. `progress` is told the seconds of data done.
ReprocessReport reprocess(const std::string& input, const std::string& folder,
                          const std::vector<std::string>& estimators, const ReprocessSystem& system,
                          const std::function<void(double)>& progress);

}  // namespace sas_motion::ros_side

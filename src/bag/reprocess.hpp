// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "ros/system.hpp"

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
    LaneReport lane;
  };
  std::map<std::string, PerEstimator> estimators;
  std::vector<std::string> warnings;  ///< on what the data lack, a sentence each
};

/// Runs estimators over a bag and writes a bag of the same name into `folder`: the input's messages, and each
/// estimator's estimates and audit; beside it a TUM file for each estimator. Throws std::runtime_error naming the file
/// or topic, also where nothing could be estimated. `progress` gets the seconds of data done.
ReprocessReport reprocess(const std::string& input, const std::string& folder,
                          const std::vector<std::string>& estimators, const System& system,
                          const std::function<void(double)>& progress);

}  // namespace sas_motion::ros_side

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ros/system_run.hpp"

namespace sas_motion::ros_side {

/// A system set up by a configuration file: what the nodelets and reprocess run.
class System {
 public:
  virtual ~System() = default;

  MapSettings map;
  std::vector<MessageSource> sources;
  std::vector<std::string> estimators;  ///< that it knows
  std::vector<std::string> preferred,
      smoothers;                      ///< live, where none are asked for, by a filter's or a smoother's nodelet
  std::optional<double> output_rate;  ///< of present answers; none: after each message [1/s]
  bool has_current = false;           ///< it estimates how the water moves
  Tuning tuning;

  virtual bool knows(const std::string& estimator) const;
  /// What an estimator is called now whose name was another one before; any other name as it is.
  virtual std::string currentName(const std::string& estimator) const { return estimator; }
  /// Throws std::runtime_error: one sentence where a name is unknown, or is there twice.
  void require(const std::vector<std::string>& names) const;
  /// `live`: keep present answers. `transforms` and this outlive the run.
  virtual std::unique_ptr<SystemRun> begin(const std::vector<std::string>& names, const tf2::BufferCore& transforms,
                                           bool live) const = 0;
};

/// Reads the section topics: NAME of each source. Throws ConfigError.
void readTopics(YamlSection& yaml, std::vector<MessageSource>& sources);

}  // namespace sas_motion::ros_side

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "sas_motion/estimate/output.hpp"

namespace sas_motion {

/// An estimator that is given readings in the order of time, of a system with these types: one reading of any sensor,
/// its state at a stamp, a state that a user may set, and its settings. Data never throws.
template <class Reading_, class State_, class Start_, class Config_>
class InOrderEstimator {
 public:
  using Reading = Reading_;
  using State = State_;
  using Start = Start_;
  using Config = Config_;
  using Output = OutputOf<State>;

  virtual ~InOrderEstimator() = default;

  virtual void process(const Reading& reading, Output& output) = 0;
  /// No more readings have the stamp of the last one.
  virtual void endStamp(Output&) {}
  /// The end of the data, or a pause: puts out everything that is still open.
  virtual void finish(Output&) {}
  /// Readings from now on are of another time, after a clock was set or a long gap: puts out what is open and waits for
  /// another start.
  virtual void startAnew(Output& output) = 0;
  /// Goes on from a state that a user sets, whose stamp is not before the last reading.
  virtual void setState(const Start&, Output&) {}
  /// Other losses, tunings and gates, for readings that come from now on.
  virtual void configure(const Config&) {}

  /// How long readings wait for late ones, so that they come in order [s]; infinite: for the end of the data.
  virtual double lag() const = 0;
  /// Another that goes on from here; null where there is no present state.
  virtual std::unique_ptr<InOrderEstimator> clone() const { return nullptr; }
  virtual bool keepsPresent() const { return true; }
  /// The state at a stamp after the last reading, of an estimator that is not used any more. `next` is the next reading
  /// that tells the time, or null.
  virtual std::optional<State> predictedTo(Stamp, const Reading*) { return std::nullopt; }
  /// How often a smoother has corrected its present; a filter never does.
  virtual std::uint64_t corrections() const { return 0; }
  /// Why the last finish() has no answer, in plain words; empty where all is well.
  virtual std::string failure() const { return ""; }
};

}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sas_motion/estimate/output.hpp"
#include "sas_motion/systems/towfish/config.hpp"
#include "sas_motion/systems/towfish/model.hpp"

namespace sas_motion::towfish {

/// The state at a stamp, after everything measured at that stamp.
struct Estimate {
  Stamp stamp = 0;
  Gaussian<kStates> belief;
};

using Output = OutputOf<Estimate>;

/// One estimator fed with measurements as they arrive, live or from a bag.
///
/// What it writes to Output is settled: no measurement inside the lag can change it any more, so it depends on the
/// measurements alone and not on the order in which they arrived. current() is the best answer at this moment.
class Estimator {
 public:
  virtual ~Estimator() = default;

  /// Takes one measurement, of any age. Data never throws.
  virtual void process(const Measurement& z, Output& output) = 0;
  /// The end of the data, or a pause: settles everything that is still open.
  virtual void finish(Output& output) = 0;
  /// The newest estimate, or nothing before the start.
  virtual std::optional<Estimate> current() const = 0;
  /// The state at any stamp inside the lag or after the newest measurement, or nothing.
  virtual std::optional<Estimate> at(Stamp stamp) const = 0;
  /// Sets the state at a stamp: what was measured after it is fused again, what was measured before it is settled as it
  /// was. Returns a literal that says why not, or nothing.
  virtual const char* setState(const Estimate& state, Output& output);
  /// Other losses, tunings and gates, for measurements that come from now on; those that came before keep theirs, also
  /// when they are replayed. Batch smoothers keep what they started with.
  virtual void configure(const Config&) {}
  /// Why the last finish() has no answer, in plain words; empty where all is well.
  virtual std::string failure() const { return ""; }
  /// Forgets everything.
  virtual void reset() = 0;
};

/// Makes rts or a filter that withFilter() knows; null for any other name.
std::unique_ptr<Estimator> makeEstimator(const std::string& name, const Config& config);

using EstimatorFactory = std::function<std::unique_ptr<Estimator>(const std::string& name, const Config& config)>;

/// Whether a measurement can be used at all; a literal that says why not, or nothing.
const char* invalidity(const Measurement& z, const Config& config);

/// An audit that says a measurement was not fused.
Audit refusal(const Measurement& z, Verdict verdict, const char* reason);

}  // namespace sas_motion::towfish

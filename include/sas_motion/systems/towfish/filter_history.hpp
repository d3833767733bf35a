// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "sas_motion/systems/towfish/estimator.hpp"
#include "sas_motion/systems/towfish/held_input.hpp"

namespace sas_motion::towfish {

/// The motion from one stamp to a later one about a mean: the model's, unless somebody knows more of it.
using Motion = std::function<Transition<kStates>(const StateVector& mean, const Input& input, Stamp from, Stamp to)>;

/// A filter's beliefs over a window of measurements in the order of fusion. One that comes late is put in its place,
/// and what comes after it is fused again.
template <class Filter>
class FilterHistory {
 public:
  struct Moment {
    Stamp stamp;
    typename Filter::Belief belief;
    HeldInput input;  ///< the turn rate in force from then on

    Moment(Stamp when, const typename Filter::Belief& what, const HeldInput& in_force)
        : stamp(when), belief(what), input(in_force) {}
  };
  struct Entry {
    Measurement z;
    std::shared_ptr<const Filter> filter;  ///< the one in force when it came
    std::optional<Moment> after;           ///< nothing before it is fused
    Audit audit;

    Entry(const Measurement& measurement, std::shared_ptr<const Filter> in_force)
        : z(measurement), filter(std::move(in_force)) {}
  };

  FilterHistory(const Model& model, Motion motion) : model_(model), motion_(std::move(motion)) {}

  /// Sets the filter for later measurements, and how long a turn rate holds after its stamp [s]. Must be called
  /// before the first measurement.
  void use(std::shared_ptr<const Filter> filter, double input_hold);

  const std::deque<Entry>& entries() const { return entries_; }
  bool started() const { return start_.has_value(); }
  Stamp startStamp() const { return start_->stamp; }
  const Moment& newest() const { return before(entries_.size()); }
  /// The state at a stamp from the start on, by the motion since the entry before it.
  Gaussian<kStates> at(Stamp stamp) const;

  /// Begins with a belief at a stamp that no entry is before, and fuses the entries; the turn rate in force stays.
  void startWith(Stamp stamp, const typename Filter::Belief& belief);
  void forgetStart() { start_.reset(); }
  void forget();

  /// Puts a measurement into its place, not yet fused; nothing where another of its sensor has its stamp.
  std::optional<std::size_t> insert(const Measurement& z);
  /// Fuses the entries from this place on.
  void fuseFrom(std::size_t first);
  /// Lets go of the first entries; the belief after the last of them is then the start.
  void settle(std::size_t count);
  /// Lets go of the first entry as if it had never come.
  void dropFront() { entries_.pop_front(); }

 private:
  const Moment& before(std::size_t index) const { return index == 0 ? *start_ : *entries_[index - 1].after; }
  typename Filter::Belief predicted(const Moment& from, Stamp stamp) const;
  void fuse(const Moment& from, Entry& entry) const;
  void fuse(const typename Filter::Belief& prior, const HeldInput& input, Entry& entry) const;

  Model model_;
  Motion motion_;
  double input_hold_ = 0;  // [s]
  std::shared_ptr<const Filter> filter_;
  std::deque<Entry> entries_;    // sorted by before()
  std::optional<Moment> start_;  // the state before the first entry
};

}  // namespace sas_motion::towfish

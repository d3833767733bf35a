// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>

#include "ins_score.hpp"
#include "sas_motion/io/cpu_time.hpp"
#include "systems.hpp"

namespace sas_motion {
namespace {

using namespace ins;

constexpr double kScoreEvery = 0.1;  // [s]

enum class Source { Fused, Gps, Dvl, Smooth };
enum class FilterKind { Unaided, Ckf27, OpenLoopCkf27, RobustCkf27 };

/// An estimator of a campaign: which filter runs, and which of its solutions is meant.
struct Candidate {
  const char* name;
  FilterKind filter;
  Source source;
};
constexpr std::array<Candidate, 12> kCandidates{{{"ins", FilterKind::Unaided, Source::Fused},
                                                 {"gps", FilterKind::Unaided, Source::Gps},
                                                 {"dvl", FilterKind::Unaided, Source::Dvl},
                                                 {"ckf27", FilterKind::Ckf27, Source::Fused},
                                                 {"gps_ckf27", FilterKind::Ckf27, Source::Gps},
                                                 {"dvl_ckf27", FilterKind::Ckf27, Source::Dvl},
                                                 {"open_loop_ckf27", FilterKind::OpenLoopCkf27, Source::Fused},
                                                 {"robust_ckf27", FilterKind::RobustCkf27, Source::Fused},
                                                 {"gps_robust_ckf27", FilterKind::RobustCkf27, Source::Gps},
                                                 {"dvl_robust_ckf27", FilterKind::RobustCkf27, Source::Dvl},
                                                 {"smooth_ckf27", FilterKind::Ckf27, Source::Smooth},
                                                 {"smooth_robust_ckf27", FilterKind::RobustCkf27, Source::Smooth}}};

/// What one estimator made of a run.
struct Scored {
  const Candidate* candidate;
  Score score;
  double microseconds = 0;
};

/// One law with its run, scored by several estimators at once where they come from the same filter.
class RunScoring {
 public:
  RunScoring(const Scenario& scenario, double skip, std::uint64_t seed)
      : scenario_(scenario), trajectory_(scenario.track, scenario.duration), recording_(simulate(scenario, trajectory_, seed)), skip_(skip) {}

  std::vector<Scored> of(const std::vector<const Candidate*>& candidates) const {
    std::vector<Scored> all;
    const Errors unit = ErrorModel(scenario_.parameters, recording_.start).unit();
    for (const Candidate* candidate : candidates) all.push_back({candidate, Score(scenario_, unit, skip_)});
    for (const auto filter : {FilterKind::Unaided, FilterKind::Ckf27, FilterKind::OpenLoopCkf27, FilterKind::RobustCkf27}) {
      std::vector<Scored*> mine;
      for (auto& scored : all)
        if (scored.candidate->filter == filter) mine.push_back(&scored);
      if (mine.empty()) continue;
      switch (filter) {
        case FilterKind::Unaided: follow(Unaided(), false, mine); break;
        case FilterKind::Ckf27: follow(KalmanFilter<kStates>(), true, mine); break;
        case FilterKind::OpenLoopCkf27: follow(KalmanFilter<kStates>(), false, mine); break;
        case FilterKind::RobustCkf27: follow(RobustKalmanFilter<kStates>({}), true, mine); break;
      }
    }
    return all;
  }

 private:
  template <class Filter>
  void follow(const Filter& filter, bool feedback, const std::vector<Scored*>& scored) const {
    typename Navigator<Filter>::Options options;
    options.feedback = feedback;
    options.imu.period = 1 / scenario_.imu_rate;
    Navigator<Filter> navigator(filter, scenario_.parameters, recording_.start, 0, options);
    auto next = recording_.aiding.begin();
    double scoring = 0;
    const double begin = cpuSeconds();
    for (const auto& reading : recording_.imu) {
      const auto first = next;
      for (; next != recording_.aiding.end() && next->reading.stamp <= reading.stamp; ++next) navigator.add(next->reading);
      navigator.add(reading);
      const double since = cpuSeconds();
      note(navigator, &*first, scored);
      scoring += cpuSeconds() - since;
    }
    const double seconds = cpuSeconds() - begin - scoring;
    for (auto* one : scored) one->microseconds = 1e6 * seconds / static_cast<double>(std::max<std::size_t>(1, recording_.aiding.size()));
  }

  /// `labelled` are the readings that the navigator audited, in order.
  template <class Filter>
  void note(const Navigator<Filter>& navigator, const LabelledAiding* labelled, const std::vector<Scored*>& scored) const {
    const double time = secondsBetween(0, navigator.stamp());
    for (std::size_t i = 0; i < navigator.audits().size(); ++i)
      for (auto* one : scored) one->score.add(navigator.audits()[i], labelled[i]);
    const double ticks = time / kScoreEvery;
    if (std::abs(ticks - std::round(ticks)) > 1e-6) return;
    const TruthSample truth = trajectory_.at(time);
    const ErrorMatrix* P = std::is_same_v<Filter, Unaided> ? nullptr : &navigator.belief().covariance;
    for (auto* one : scored) switch (one->candidate->source) {
        case Source::Fused: one->score.add(time, truth, {navigator.fused(), true, true, P}); break;
        case Source::Dvl: one->score.add(time, truth, {navigator.dvl(), true, false, nullptr}); break;
        case Source::Smooth: one->score.add(time, truth, {navigator.smooth(), true, true, nullptr}); break;
        case Source::Gps:
          if (navigator.gps() && navigator.gps()->stamp == navigator.stamp()) one->score.add(time, truth, {navigator.gps()->state, false, false, nullptr});
          break;
      }
  }

  const Scenario& scenario_;
  Trajectory trajectory_;
  Recording recording_;
  double skip_;
};

class InsSystem final : public System {
 public:
  InsSystem(YamlSection& campaign, const std::string& folder) {
    std::string file;
    campaign.text("scenario", file);
    if (file.empty()) campaign.fail("scenario", "is missing; name a scenario file");
    Scenario scenario = Scenario::fromFile(std::filesystem::path(folder) / file);
    campaign.number("duration", scenario.duration, {1, 1e6});
    dimension = kStates;
    duration = scenario.duration;
    skip = 120;
    campaign.number("skip", skip, {0, 1e6});
    if (skip >= duration) campaign.fail("skip", fmt::format("is {} but must be less than a run, which lasts {} s", skip, duration));
    campaign.texts("estimators", estimators);
    if (estimators.empty()) campaign.fail("estimators", "is missing; list at least one");
    for (const auto& name : estimators) {
      const auto* found = std::find_if(kCandidates.begin(), kCandidates.end(), [&](const Candidate& candidate) { return candidate.name == name; });
      if (found == kCandidates.end()) campaign.fail("estimators", fmt::format("names '{}', which is no estimator of this system", name));
      candidates_.push_back(found);
    }
    for (auto& item : campaign.list("laws")) readLaw(item, scenario);
    if (laws.empty()) campaign.fail("laws", "is missing; list at least one");
  }

  std::vector<EstimatorReport> run(std::size_t law, std::uint64_t seed) const override {
    std::vector<EstimatorReport> reports;
    for (const auto& scored : RunScoring(scenarios_[law], skip, seed).of(candidates_)) {
      reports.push_back(scored.score.report(scored.candidate->name));
      reports.back().microseconds = scored.microseconds;
    }
    return reports;
  }

  Named<Trace> trace(std::size_t law, std::uint64_t seed) const override {
    Named<Trace> traces;
    for (const auto& scored : RunScoring(scenarios_[law], skip, seed).of(candidates_)) {
      traces.emplace_back(scored.candidate->name, scored.score.trace());
      traces.back().second.nees_degrees = 9;
      traces.back().second.nis_degrees = rowsOf(Sensor::Gps);
    }
    return traces;
  }

  Named<double> bound(std::size_t law, const std::vector<std::uint64_t>& seeds) const override { return insBound(scenarios_[law], skip, seeds); }

 private:
  /// `noise` is of GPS, DVL and DPC; `gps_outages` are added to the scenario's, `dpc` goes over its section.
  void readLaw(YamlSection& item, Scenario scenario) {
    std::string name;
    item.text("name", name);
    scenario.readDpc(item.section("dpc"));
    if (item.has("noise"))
      scenario.sensor(Sensor::Gps).noise = scenario.sensor(Sensor::Dvl).noise = scenario.sensor(Sensor::Dpc).noise = Scenario::readNoise(item, "noise");
    for (const auto& outage : Scenario::readOutages(item, "gps_outages")) scenario.sensor(Sensor::Gps).outages.push_back(outage);
    item.finish();
    laws.push_back(lawInfo(name, scenario.sensor(Sensor::Gps).noise, {}));
    if (const auto& outages = scenario.sensor(Sensor::Gps).outages; !outages.empty()) {
      for (const auto& outage : outages) laws.back().description += fmt::format(", no GPS from {} to {} s", outage.begin, outage.end);
      laws.back().epsilon = laws.back().K = std::nullopt;
    }
    scenarios_.push_back(scenario);
  }

  std::vector<const Candidate*> candidates_;
  std::vector<Scenario> scenarios_;  // by law
};

}  // namespace

std::unique_ptr<System> makeInsSystem(YamlSection& campaign, const std::string& folder) { return std::make_unique<InsSystem>(campaign, folder); }

}  // namespace sas_motion

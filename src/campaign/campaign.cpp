// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "campaign/campaign.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "sas_motion/estimate/old_names.hpp"

namespace sas_motion {

LawInfo lawInfo(const std::string& name, const NoiseMix& measurement, const NoiseMix& process) {
  LawInfo info{name, measurement.name(), {}, {}};
  if (!process.laws.empty()) info.description += ", process " + process.name();
  if (info.name.empty()) info.name = info.description;
  const auto gaussian = [](const NoiseMix& mix) {
    return std::all_of(mix.laws.begin(), mix.laws.end(),
                       [](const NoiseLaw& law) { return law.kind == NoiseLaw::Kind::Gaussian; });
  };
  if (gaussian(measurement) && gaussian(process)) info.epsilon = 0, info.K = 1;
  if (gaussian(process) && measurement.laws.size() == 1 && measurement.laws[0].kind == NoiseLaw::Kind::Contaminated) {
    info.epsilon = measurement.laws[0].epsilon;
    info.K = measurement.laws[0].K;
  }
  return info;
}

std::vector<EstimatorReport> Campaign::run(std::size_t law, std::uint64_t seed) const {
  std::vector<EstimatorReport> reports;
  for (const auto& scorer : score(law, seed)) reports.push_back(scorer.report());
  return reports;
}

Named<Trace> Campaign::trace(std::size_t law, std::uint64_t seed) const {
  Named<Trace> traces;
  for (auto& scorer : score(law, seed)) traces.emplace_back(scorer.facts().estimator, std::move(scorer.trace()));
  return traces;
}

void Campaign::readDuration(YamlSection& yaml, double of_scenario) {
  duration = of_scenario;
  yaml.number("duration", duration, {1, 1e6});
}

void Campaign::readScoring(YamlSection& yaml, double default_skip, const std::function<bool(const std::string&)>& known,
                           const std::function<std::string(const std::string&)>& current_name) {
  skip = default_skip < 0 ? std::max(0.0, duration + default_skip) : default_skip;
  yaml.number("skip", skip, {0, 1e6});
  if (skip >= duration)
    yaml.fail("skip", fmt::format("is {} but must be less than a run, which lasts {} s", skip, duration));
  yaml.texts("estimators", estimators);
  if (current_name)
    for (const auto& sentence : replaceOldNames(estimators, current_name)) fmt::print(stderr, "{}\n", sentence);
  if (estimators.empty()) yaml.fail("estimators", "is missing; list at least one");
  for (const auto& name : estimators)
    if (!known(name)) yaml.fail("estimators", fmt::format("names '{}', which is no estimator of this system", name));
}

std::string Campaign::fileOf(YamlSection& yaml, const char* key, const std::string& folder) {
  std::string file;
  yaml.text(key, file);
  if (file.empty()) yaml.fail(key, "is missing; name a file");
  return std::filesystem::path(folder) / file;
}

}  // namespace sas_motion

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/noise/noise_law.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sas_motion {
namespace {

using Kind = NoiseLaw::Kind;

struct Parameter {
  const char* key;
  double NoiseLaw::*value;
  Range range;
  const char* unit = "";
  bool named = true;  ///< whether the law's name contains it even at its default
};

/// How one law is written in a file.
struct Form {
  Kind kind;
  const char* name;
  bool sensor, process;
  std::vector<Parameter> parameters;
};

const std::vector<Form>& forms() {
  static const Parameter epsilon{"epsilon", &NoiseLaw::epsilon, {0, 1}}, size{"K", &NoiseLaw::K, {1, 1e6}},
      bias_size{"K", &NoiseLaw::K, {0, 1e6}};
  static const Parameter rate{"rate", &NoiseLaw::rate, {0, 1e3}, "/s"},
      length{"length", &NoiseLaw::length, {0, 1e6}, " s"};
  static const Parameter epoch{"epoch", &NoiseLaw::epoch, {0, 1e6}, " s", false},
      probability{"probability", &NoiseLaw::probability, {0, 1}};
  static const Parameter t0{"t0", &NoiseLaw::t0, {0, 1e7}, " s"}, t1{"t1", &NoiseLaw::t1, {0, 1e7}, " s", false};
  static const Parameter time_constant{"time_constant", &NoiseLaw::time_constant, {kTiny, 1e7}, " s"},
      period{"period", &NoiseLaw::period, {kTiny, 1e7}, " s"};
  const auto unnamed = [](Parameter parameter) {
    parameter.named = false;
    return parameter;
  };
  static const std::vector<Form> all{
      {Kind::Gaussian, "gaussian", true, true, {}},
      {Kind::Contaminated, "contaminated", true, false, {epsilon, size}},
      {Kind::Contaminated, "contaminated", false, true, {epsilon, size, epoch}},
      {Kind::Burst, "burst", true, true, {rate, length, bias_size}},
      {Kind::StudentT, "student_t", true, true, {{"nu", &NoiseLaw::nu, {0.1, 1e6}}}},
      {Kind::Step, "step", true, false, {{"bias", &NoiseLaw::bias, {-1e6, 1e6}}, t0, t1}},
      {Kind::Ramp, "ramp", true, false, {{"slope", &NoiseLaw::slope, {-1e6, 1e6}, "/s"}, t0, t1}},
      {Kind::Frozen, "frozen", true, false, {rate, length}},
      {Kind::Dropout, "dropout", true, false, {unnamed(rate), unnamed(length), unnamed(probability)}},
      {Kind::Multipath, "multipath", true, false, {probability, {"mean", &NoiseLaw::mean, {kTiny, 1e6}}}},
      {Kind::Correlated, "correlated", true, false, {time_constant, {"share", &NoiseLaw::share, {0, 0.999}}}},
      {Kind::Varying, "varying", true, false, {period, {"factor", &NoiseLaw::factor, {kTiny, 1e6}}}},
      {Kind::Quantised, "quantised", true, false, {{"quantum", &NoiseLaw::quantum, {0, 1e6}}}},
      {Kind::Manoeuvre, "manoeuvre", false, true, {rate, length, size}},
  };
  return all;
}

}  // namespace

NoiseLaw NoiseLaw::read(YamlSection yaml, NoiseUse use) {
  std::string name = "gaussian";
  yaml.text("law", name);
  std::vector<std::string> known;
  for (const auto& form : forms()) {
    if (use == NoiseUse::Sensor ? !form.sensor : !form.process) continue;
    known.push_back(form.name);
    if (name != form.name) continue;
    NoiseLaw law;
    law.kind = form.kind;
    for (const auto& parameter : form.parameters) yaml.number(parameter.key, law.*parameter.value, parameter.range);
    if (law.t1 < law.t0) yaml.fail("t1", fmt::format("is {} but must be at least t0, {}", law.t1, law.t0));
    yaml.finish();
    return law;
  }
  yaml.fail("law", fmt::format("is '{}' but must be one of {}", name, fmt::join(known, ", ")));
}

std::string NoiseLaw::name() const {
  const NoiseLaw plain;
  std::vector<std::string> values;
  const auto form = std::find_if(forms().rbegin(), forms().rend(),
                                 [&](const Form& f) { return f.kind == kind; });  // a process's form has all keys
  for (const auto& [key, value, range, unit, named] : form->parameters)
    if (named || this->*value != plain.*value) values.push_back(fmt::format("{:g}{}", this->*value, unit));
  return values.empty() ? form->name : fmt::format("{}({})", form->name, fmt::join(values, ","));
}

NoiseMix NoiseMix::read(YamlSection& owner, const std::string& key, NoiseUse use) {
  if (!owner.isList(key)) return NoiseLaw::read(owner.section(key), use);
  NoiseMix mix;
  for (auto& law : owner.list(key)) mix.laws.push_back(NoiseLaw::read(law, use));
  return mix;
}

std::string NoiseMix::name() const {
  std::vector<std::string> names;
  for (const auto& law : laws) names.push_back(law.name());
  return names.empty() ? NoiseLaw().name() : fmt::format("{}", fmt::join(names, " + "));
}

}  // namespace sas_motion

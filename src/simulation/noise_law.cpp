// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/simulation/noise_law.hpp"

#include <fmt/format.h>

#include <cmath>

namespace sas_motion {

NoiseLaw NoiseLaw::read(YamlSection yaml) {
  NoiseLaw law;
  std::string name = "gaussian";
  yaml.text("law", name);
  if (name == "contaminated") {
    law.kind = Kind::Contaminated;
    yaml.number("epsilon", law.epsilon, {0, 1});
    yaml.number("K", law.K, {1, 1e6});
  } else if (name == "burst") {
    law.kind = Kind::Burst;
    yaml.number("rate", law.rate, {0, 1e3});
    yaml.number("length", law.length, {0, 1e6});
    yaml.number("K", law.K, {0, 1e6});
  } else if (name != "gaussian") {
    yaml.fail("law", fmt::format("is '{}' but must be gaussian, contaminated or burst", name));
  }
  yaml.finish();
  return law;
}

std::string NoiseLaw::name() const {
  switch (kind) {
    case Kind::Gaussian: return "gaussian";
    case Kind::Contaminated: return fmt::format("contaminated({:g},{:g})", epsilon, K);
    case Kind::Burst: return fmt::format("burst({:g}/s,{:g} s,{:g})", rate, length, K);
  }
  return "unknown";
}

NoiseSample NoiseSource::draw(double time) {
  const double unit = random_.gaussian(), dice = random_.uniform();
  const double elapsed = time - last_time_;
  last_time_ = time;
  switch (law_.kind) {
    case NoiseLaw::Kind::Gaussian: return {unit, false};
    case NoiseLaw::Kind::Contaminated: return dice < law_.epsilon ? NoiseSample{law_.K * unit, true} : NoiseSample{unit, false};
    case NoiseLaw::Kind::Burst:
      if (time >= burst_until_ && dice < -std::expm1(-law_.rate * elapsed)) burst_until_ = time + law_.length;
      return time < burst_until_ ? NoiseSample{unit + law_.K, true} : NoiseSample{unit, false};
  }
  return {};
}

}  // namespace sas_motion

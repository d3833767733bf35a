// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/chirp.hpp"

#include "sas_motion/math/angles.hpp"

namespace sas_motion::imaging {

Spectrum chirp(const SonarDescription& sonar) {
  Spectrum pulse(static_cast<std::size_t>(sonar.pulse_length * sonar.sampleRate()) + 1);
  for (std::size_t i = 0; i < pulse.size(); ++i) {
    const double t = static_cast<double>(i) / sonar.sampleRate() - sonar.pulse_length / 2;
    pulse[i] = std::polar(1.0, kPi * sonar.bandwidth / sonar.pulse_length * t * t);
  }
  return pulse;
}

}  // namespace sas_motion::imaging

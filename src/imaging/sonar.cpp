// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/sonar.hpp"

namespace sas_motion::imaging {

Eigen::Vector3d SonarDescription::receiverBody(int receiver) const {
  return receiver_array_body + Eigen::Vector3d((receiver - 0.5 * (receivers - 1)) * spacing, 0, 0);
}

double neededPingRate(const SonarDescription& sonar, double speed) {
  const double longest_advance = sonar.receivers > 1 ? sonar.receivers * sonar.spacing / 2 : sonar.element / 2;
  return speed / longest_advance;
}

double echoTime(const SonarDescription& sonar) { return 2 * sonar.far_range / sonar.sound_speed; }

double greatestPingRate(const SonarDescription& sonar) { return 1 / (echoTime(sonar) + sonar.pulse_length); }

}  // namespace sas_motion::imaging

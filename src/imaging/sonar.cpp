// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/imaging/sonar.hpp"

#include <fmt/format.h>

#include "imaging/fourier.hpp"
#include "sas_motion/config/yaml_vector.hpp"
#include "sas_motion/math/angles.hpp"

namespace sas_motion::imaging {
namespace {

void readSignal(YamlSection& yaml, SonarDescription& sonar) {
  yaml.number("carrier", sonar.carrier, {1e3, 1e7});
  yaml.number("bandwidth", sonar.bandwidth, {100, 1e7});
  if (sonar.bandwidth > 2 * sonar.carrier)
    yaml.fail("bandwidth",
              fmt::format("is {} but must be at most {}, twice the carrier", sonar.bandwidth, 2 * sonar.carrier));
  yaml.number("pulse_length", sonar.pulse_length, {1e-6, 1});
  if (sonar.pulse_length * sonar.bandwidth < 10)
    yaml.fail("pulse_length", fmt::format("is {} but must be at least {}, ten over the bandwidth", sonar.pulse_length,
                                          10 / sonar.bandwidth));
  yaml.number("oversampling", sonar.oversampling, {1.4, 4});
}

void readArray(YamlSection& yaml, SonarDescription& sonar) {
  yaml.number("element", sonar.element, {1e-3, 10});
  yaml.integer("receivers", sonar.receivers, 1, 1024);
  yaml.number("spacing", sonar.spacing, {1e-3, 10});
  if (sonar.receivers > 1 && sonar.spacing > sonar.element)
    yaml.fail(
        "spacing",
        fmt::format("is {} but must be at most element, which is {}: the array itself would undersample the aperture",
                    sonar.spacing, sonar.element));
  readVector<3>(yaml, "transmitter_body", sonar.transmitter_body);
  readVector<3>(yaml, "receiver_array_body", sonar.receiver_array_body);
}

void checkPingRate(const YamlSection& yaml, const SonarDescription& sonar) {
  const double needed = neededPingRate(sonar, sonar.speed), greatest = greatestPingRate(sonar);
  if (sonar.ping_rate < needed)
    yaml.fail("ping_rate", fmt::format("is {} but must be at least {:.6g} to sample the aperture at a speed of {} m/s",
                                       sonar.ping_rate, needed, sonar.speed));
  if (sonar.ping_rate > greatest)
    yaml.fail("ping_rate",
              fmt::format("is {} but must be at most {:.6g}, or echoes of two pings overlap at far_range, which is {}",
                          sonar.ping_rate, greatest, sonar.far_range));
}

}  // namespace

Eigen::Vector3d SonarDescription::receiverBody(int receiver) const {
  return receiver_array_body + Eigen::Vector3d((receiver - 0.5 * (receivers - 1)) * spacing, 0, 0);
}

double neededPingRate(const SonarDescription& sonar, double speed) {
  const double longest_advance = sonar.receivers > 1 ? sonar.receivers * sonar.spacing / 2 : sonar.element / 2;
  return speed / longest_advance;
}

double echoTime(const SonarDescription& sonar) { return 2 * sonar.far_range / sonar.sound_speed; }

double greatestPingRate(const SonarDescription& sonar) { return 1 / (echoTime(sonar) + sonar.pulse_length); }

Spectrum chirp(const SonarDescription& sonar) {
  Spectrum pulse(static_cast<std::size_t>(sonar.pulse_length * sonar.sampleRate()) + 1);
  for (std::size_t i = 0; i < pulse.size(); ++i) {
    const double t = static_cast<double>(i) / sonar.sampleRate() - sonar.pulse_length / 2;
    pulse[i] = std::polar(1.0, kPi * sonar.bandwidth / sonar.pulse_length * t * t);
  }
  return pulse;
}

void readSonar(YamlSection yaml, SonarDescription& sonar) {
  readSignal(yaml, sonar);
  readArray(yaml, sonar);
  yaml.number("ping_rate", sonar.ping_rate, {1e-3, 1e4});
  yaml.number("speed", sonar.speed, {0, 50});
  yaml.number("sound_speed", sonar.sound_speed, {1300, 1700});
  yaml.number("altitude", sonar.altitude, {0, 1e4});
  yaml.number("near_range", sonar.near_range, {kTiny, 1e4});
  yaml.number("far_range", sonar.far_range, {kTiny, 1e4});
  if (sonar.far_range <= sonar.near_range)
    yaml.fail("far_range",
              fmt::format("is {} but must be above near_range, which is {}", sonar.far_range, sonar.near_range));
  if (sonar.altitude >= sonar.far_range)
    yaml.fail("altitude",
              fmt::format("is {} but must be below far_range, which is {}", sonar.altitude, sonar.far_range));
  yaml.boolean("stop_and_hop", sonar.stop_and_hop);
  checkPingRate(yaml, sonar);
  yaml.finish();
}

}  // namespace sas_motion::imaging

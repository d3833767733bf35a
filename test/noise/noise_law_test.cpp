// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/noise/noise_law.hpp"

#include "support.hpp"

namespace sas_motion {
namespace {

NoiseLaw read(const std::string& text, NoiseUse use = NoiseUse::Sensor) {
  return NoiseLaw::read(YamlSection::fromText(text, "inline"), use);
}

TEST(NoiseLaw, ReadsItselfAndSaysItsName) {
  EXPECT_EQ(read("{law: contaminated, epsilon: 0.1, K: 10}").name(), "contaminated(0.1,10)");
  EXPECT_EQ(read("{law: burst, rate: 0.005, length: 10, K: 20}").name(), "burst(0.005/s,10 s,20)");
  EXPECT_EQ(read("{law: student_t, nu: 3}").name(), "student_t(3)");
  EXPECT_EQ(read("{law: step, bias: 5, t0: 10, t1: 20}").name(), "step(5,10 s,20 s)");
  EXPECT_EQ(read("{law: ramp, slope: 0.5, t0: 10}").name(), "ramp(0.5/s,10 s)");
  EXPECT_EQ(read("{law: dropout, probability: 0.2}").name(), "dropout(0.2)");
  EXPECT_EQ(read("{law: multipath, probability: 0.1, mean: 8}").name(), "multipath(0.1,8)");
  EXPECT_EQ(read("{law: correlated, time_constant: 5, share: 0.5}").name(), "correlated(5 s,0.5)");
  EXPECT_EQ(read("{law: varying, period: 60, factor: 3}").name(), "varying(60 s,3)");
  EXPECT_EQ(read("{law: quantised, quantum: 2}").name(), "quantised(2)");
  EXPECT_EQ(read("{law: contaminated, epsilon: 0.1, K: 10, epoch: 1}", NoiseUse::Process).name(),
            "contaminated(0.1,10,1 s)");
  EXPECT_EQ(read("{law: manoeuvre, rate: 0.01, length: 5, K: 10}", NoiseUse::Process).name(),
            "manoeuvre(0.01/s,5 s,10)");
  EXPECT_EQ(NoiseLaw().name(), "gaussian");
}

TEST(NoiseLaw, RefusesWhatItDoesNotKnowOrCannotBe) {
  EXPECT_THROW(read("{law: cauchy}"), ConfigError);
  EXPECT_THROW(read("{law: contaminated, epsilon: 1.1}"), ConfigError);
  EXPECT_THROW(read("{law: gaussian, K: 3}"), ConfigError);  // not used, so not silent
  EXPECT_THROW(read("{law: step, bias: 5, t0: 20, t1: 10}"), ConfigError);
  EXPECT_THROW(read("{law: contaminated, epsilon: 0.1, epoch: 1}"), ConfigError);  // of the process alone
  EXPECT_THROW(read("{law: manoeuvre}"), ConfigError);
  EXPECT_THROW(read("{law: frozen}", NoiseUse::Process), ConfigError);
}

TEST(NoiseMix, IsALawOrAListOfLawsOrNothing) {
  auto yaml = YamlSection::fromText(
      "{one: {law: student_t, nu: 3}, two: [{law: contaminated, epsilon: 0.1, K: 10}, {law: dropout, probability: "
      "0.1}]}",
      "inline");
  EXPECT_EQ(NoiseMix::read(yaml, "one").name(), "student_t(3)");
  EXPECT_EQ(NoiseMix::read(yaml, "two").name(), "contaminated(0.1,10) + dropout(0.1)");
  EXPECT_EQ(NoiseMix::read(yaml, "none").name(), "gaussian");
  yaml.finish();
  EXPECT_EQ(NoiseMix().name(), "gaussian");
  auto bad = YamlSection::fromText("{noise: [{law: contaminated, epsilon: 2}]}", "inline");
  try {
    NoiseMix::read(bad, "noise");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("noise[0].epsilon"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace sas_motion

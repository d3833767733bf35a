// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/systems/usbl/ping_builder.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "sas_motion/math/angles.hpp"

namespace sas_motion::usbl {
namespace {

const Geodetic kDatum{54.3, 10.2, 40};
const Vector<3> kTransponder(30, -50, -80);
constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

Stamp at(double seconds) { return 1'000'000'000'000 + stampFromSeconds(seconds); }
Geodetic place(const Vector<3>& position) { return LocalFrame(kDatum).geodetic(position); }
Reading reading(double range = 100) { return {{range, 1.5, 1.6}, {0.04, 1e-5, 1e-5}}; }
Matrix<3> turned(double heading_deg) { return rotationOf(Attitude{0.02, -0.03, heading_deg * kRadPerDeg}); }

/// A vessel that sails east at 2 m/s and turns by 3 degrees a second through north, with her antenna on a mast.
struct Sailing {
  PingBuilder builder;
  Vector<3> lever_arm{0.5, -1, 4};

  explicit Sailing(const PingBuilderOptions& options = {}) : builder(options) {
    builder.addTransponder(7, place(kTransponder));
  }

  static Matrix<3> attitude(double t) { return turned(350 + 3 * t); }
  static Vector<3> position(double t) { return {2 * t, 10, 1}; }
  void fix(double t) { builder.addPosition(at(t), place(position(t) + attitude(t) * lever_arm), lever_arm); }
  void look(double t) { builder.addAttitude(at(t), attitude(t)); }
  void sail(double from, double to) {
    for (double t = from; t <= to + 1e-9; t += 0.25) look(t);
    for (double t = from; t <= to + 1e-9; t += 1) fix(t);
  }
  void ping(double t) { builder.addReading(at(t), 7, reading()); }
};

TEST(PingBuilder, InterpolatesPoseAndTakesTheLeverArmOff) {
  Sailing s;
  s.sail(0, 8);
  for (const double t : {0.1, 3.4, 6.05}) s.ping(t);
  const auto pings = s.builder.take();
  ASSERT_EQ(pings.size(), 3u);
  const double times[] = {0.1, 3.4, 6.05};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(pings[i].stamp, at(times[i]));
    EXPECT_LT((pings[i].C_body_map.transpose() - Sailing::attitude(times[i])).norm(), 1e-5)
        << "the heading passes north on the shortest way";
    EXPECT_LT((pings[i].transponder_map - (kTransponder - Sailing::position(times[i]))).norm(), 2e-3);
    EXPECT_EQ(pings[i].reading.value, reading().value);
  }
}

TEST(PingBuilder, AStampOnAPoseNeedsNoOther) {
  Sailing s;
  s.look(2);
  s.fix(2);
  s.ping(2);
  EXPECT_EQ(s.builder.take().size(), 1u);
}

TEST(PingBuilder, WaitsForLatePosesAndKeepsTheOrderOfTime) {
  Sailing s;
  s.sail(0, 3);
  s.ping(3.5);
  s.ping(2.5);
  EXPECT_EQ(s.builder.take().size(), 1u);
  s.fix(4);
  EXPECT_TRUE(s.builder.take().empty()) << "no attitude yet";
  for (const double t : {3.25, 3.5, 3.75, 4.0}) s.look(t);
  const auto pings = s.builder.take();
  ASSERT_EQ(pings.size(), 1u);
  EXPECT_EQ(pings[0].stamp, at(3.5));
}

TEST(PingBuilder, GivesUpOnAPingOnceLaterOnesHaveCome) {
  Sailing s({0.5, 1.5, 2});
  s.sail(0, 1);
  s.ping(2);
  EXPECT_TRUE(s.builder.take().empty());
  s.ping(4.5);
  EXPECT_TRUE(s.builder.take().empty());
  EXPECT_EQ(s.builder.omitted(Omission::PositionGap), 1u);
  s.sail(2, 5);
  EXPECT_EQ(s.builder.take().size(), 1u);
}

TEST(PingBuilder, CountsWhatItLeavesOutByReason) {
  Sailing s;
  s.sail(10, 14);
  s.sail(20, 24);
  s.builder.addReading(at(11.3), 7, {{100, 1.5, 1.6}, {-1, kAbsent, 0}});
  s.builder.addReading(at(11.5), 8, reading());
  s.ping(9.5);
  s.ping(17.2);
  s.ping(11.7);
  s.ping(11.7);
  EXPECT_EQ(s.builder.finish().size(), 1u);
  s.ping(11.2);
  EXPECT_TRUE(s.builder.finish().empty());
  EXPECT_EQ(s.builder.omitted(Omission::NoChannel), 1u);
  EXPECT_EQ(s.builder.omitted(Omission::NoTransponder), 1u);
  EXPECT_EQ(s.builder.omitted(Omission::BeforeFirstFix), 1u);
  EXPECT_EQ(s.builder.omitted(Omission::PositionGap), 1u);
  EXPECT_EQ(s.builder.omitted(Omission::AttitudeGap), 0u);
  EXPECT_EQ(s.builder.omitted(Omission::Late), 2u) << "the second of a pair, and one after its time";
  EXPECT_EQ(s.builder.readings(), 7u);
}

TEST(PingBuilder, BoundsTheGapOfAttitudesApartFromPositions) {
  Sailing s;
  for (double t = 0; t <= 4; t += 1) s.fix(t), s.look(t);
  s.ping(1.5);
  EXPECT_TRUE(s.builder.finish().empty());
  EXPECT_EQ(s.builder.omitted(Omission::AttitudeGap), 1u);
}

TEST(PingBuilder, AWrongStampOfAPoseSpoilsNothing) {
  Sailing s;
  s.sail(0, 2);
  s.fix(1e6);
  s.look(1e6);
  s.ping(2.5);
  EXPECT_TRUE(s.builder.take().empty());
  s.sail(3, 4);
  s.look(2.25);
  s.look(2.5);
  EXPECT_EQ(s.builder.take().size(), 1u);
}

TEST(PingBuilder, HearsSeveralTransponders) {
  Sailing s;
  s.builder.addTransponder(9, place({0, 0, -20}));
  s.sail(0, 2);
  s.ping(1);
  s.builder.addReading(at(1), 9, reading(20));
  const auto pings = s.builder.take();
  ASSERT_EQ(pings.size(), 2u);
  EXPECT_LT((pings[1].transponder_map - (Vector<3>(0, 0, -20) - Sailing::position(1))).norm(), 2e-3);
}

TEST(PingBuilder, ANominalMountingTakesTheBodysPlace) {
  const Mounting nominal{mountingRotation({0.1, -0.2, 1.9}), {0.3, 5, -2}};
  const State correction = (State() << 0.01, -0.02, 0.03, 0.1, -0.2, 0.3).finished();
  Sailing plain, corrected_body;
  corrected_body.builder.setNominal(nominal);
  for (Sailing* s : {&plain, &corrected_body}) {
    s->sail(0, 2);
    s->ping(1.2);
  }
  const Ping a = plain.builder.take().at(0), b = corrected_body.builder.take().at(0);
  const Mounting whole = corrected(nominal, correction);
  State whole_state;
  const Attitude angles = attitudeOf(whole.C_body_array);
  whole_state << angles.pitch, angles.roll, angles.heading, whole.lever_arm_body;
  EXPECT_LT(
      (transponderInArray(Model::widened(whole_state), a) - transponderInArray(Model::widened(correction), b)).norm(),
      1e-9);
  EXPECT_LT((correctionTo(whole, nominal) - correction).norm(), 1e-12);
}

}  // namespace
}  // namespace sas_motion::usbl

// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sas_motion/config/yaml_section.hpp"

#include <functional>

#include "support.hpp"

namespace sas_motion {
namespace {

/// The message of the ConfigError that `use` of this text throws; empty where it throws none.
std::string messageOf(const std::string& text, const std::function<void(YamlSection&)>& use) {
  try {
    auto yaml = YamlSection::fromText(text, "settings.yaml");
    use(yaml);
    yaml.finish();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

void expectNames(const std::string& message, const std::vector<std::string>& parts) {
  for (const auto& part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in: " << message;
}

double number = 0;
void readNumber(YamlSection& yaml) { yaml.number("gain", number, {0, 10}); }

TEST(YamlSection, ReadsWhatIsThereAndKeepsTheRest) {
  double a = 1, b = 2, angle = 0;
  int i = 3;
  bool flag = false;
  std::string word;
  std::vector<double> pair;
  EXPECT_EQ(messageOf("{a: 5.5, i: 7, flag: true, word: hi, pair: [1, 2], angle_deg: 180}",
                      [&](YamlSection& yaml) {
                        yaml.number("a", a, {});
                        yaml.number("b", b, {});
                        yaml.integer("i", i, 0, 10);
                        yaml.boolean("flag", flag);
                        yaml.text("word", word);
                        yaml.numbers("pair", pair, 2);
                        yaml.angle("angle_deg", angle, {-360, 360});
                      }),
            "");
  EXPECT_EQ(a, 5.5);
  EXPECT_EQ(b, 2);
  EXPECT_EQ(i, 7);
  EXPECT_TRUE(flag);
  EXPECT_EQ(word, "hi");
  EXPECT_EQ(pair, (std::vector<double>{1, 2}));
  EXPECT_NEAR(angle, 3.14159265358979, 1e-12);
}

TEST(YamlSection, AnUnknownKeyIsNamedWithTheKnownOnes) {
  expectNames(messageOf("{gain: 1, gian: 2}", readNumber), {"settings.yaml", "gian", "gain"});
}

TEST(YamlSection, OutOfRangeNamesFileKeyValueAndBound) {
  expectNames(messageOf("{gain: 11.5}", readNumber), {"settings.yaml", "gain", "11.5", "10"});
  expectNames(messageOf("{gain: -1}", readNumber), {"settings.yaml", "gain", "-1", "0"});
  expectNames(messageOf("{gain: .nan}", readNumber), {"settings.yaml", "gain", "nan"});
  expectNames(messageOf("{gain: .inf}", readNumber), {"settings.yaml", "gain", "inf"});
  expectNames(messageOf("{count: 99}",
                        [](YamlSection& yaml) {
                          int count = 0;
                          yaml.integer("count", count, 1, 20);
                        }),
              {"settings.yaml", "count", "99", "20"});
}

TEST(YamlSection, NotANumberNamesFileAndKey) {
  for (const char* bad : {"{gain: lots}", "{gain: [1]}", "{gain: {a: 1}}", "{gain: 1.2.3}", "{gain: }"})
    expectNames(messageOf(bad, readNumber), {"settings.yaml", "gain", "number"});
}

TEST(YamlSection, NestedKeysAreNamedWithTheirPath) {
  expectNames(messageOf("{filter: {inner: {gain: 99}}}",
                        [](YamlSection& yaml) {
                          auto filter = yaml.section("filter");
                          auto inner = filter.section("inner");
                          readNumber(inner);
                        }),
              {"settings.yaml", "filter.inner.gain", "99"});
  expectNames(messageOf("{laws: [{gain: 1}, {gain: 99}]}",
                        [](YamlSection& yaml) {
                          for (auto& law : yaml.list("laws")) readNumber(law);
                        }),
              {"laws[1].gain"});
}

TEST(YamlSection, WrongShapesAreConfigErrorsToo) {
  const auto texts = [](YamlSection& yaml) {
    std::vector<std::string> values;
    yaml.texts("names", values);
  };
  expectNames(messageOf("{names: [a, {b: c}]}", texts), {"settings.yaml", "names"});
  expectNames(messageOf("{names: a}", texts), {"settings.yaml", "names"});
  expectNames(messageOf("[1, 2]", [](YamlSection&) {}), {"settings.yaml"});
  expectNames(messageOf("{a: [", [](YamlSection&) {}), {"settings.yaml"});
  expectNames(messageOf("{? [a, b] : 1}", [](YamlSection&) {}), {"settings.yaml"});
  expectNames(messageOf("{pair: [1, x]}",
                        [](YamlSection& yaml) {
                          std::vector<double> values;
                          yaml.numbers("pair", values, 2);
                        }),
              {"settings.yaml", "pair"});
}

TEST(YamlSection, AFileThatCannotBeReadIsNamed) {
  for (const char* path : {"/no/such/folder/settings.yaml", "/"}) {
    try {
      YamlSection::fromFile(path);
      ADD_FAILURE() << path;
    } catch (const ConfigError& error) {
      expectNames(error.what(), {path});
    }
  }
}

}  // namespace
}  // namespace sas_motion

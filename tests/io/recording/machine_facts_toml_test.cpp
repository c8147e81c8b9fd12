// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/machine_facts_toml.hpp"

#include <gtest/gtest.h>

namespace kinfer {
namespace {

TEST(MachineFactsToml, EveryKindOfFactIsReadInItsUnit) {
  const auto facts = parse_machine_facts(R"(
units = { length = "mm" }
[[place]]
name = "tip"
sensor = "ins5"
[[touch]]
point = "tip"
at = [31.0, 31.5, 40.2, 40.9]
sigma = 1
[[tape]]
from = "ins1-ins2"
to = "ins2-ins3"
length = 2500
sigma = 2
[[tape]]
from = "ins0"
to = "tip"
length = 6100
sigma = 5
at = [1, 3]
[[point]]
point = "tip"
at = [50, 51]
xyz = [1000, 0, -250]
sigma = 3
)",
                                         "facts.toml");
  ASSERT_TRUE(facts) << facts.error().what;
  ASSERT_EQ(facts->places.size(), 1U);
  EXPECT_EQ(facts->places[0].sensor, "ins5");
  EXPECT_FALSE(facts->places[0].xyz);
  ASSERT_EQ(facts->touches.size(), 1U);
  EXPECT_EQ(facts->touches[0].point, "tip");
  ASSERT_EQ(facts->touches[0].at.size(), 2U);
  EXPECT_EQ(facts->touches[0].at[1].begin, 40.2);
  EXPECT_DOUBLE_EQ(facts->touches[0].sigma, 1e-3);
  ASSERT_EQ(facts->tapes.size(), 2U);
  EXPECT_DOUBLE_EQ(facts->tapes[0].length, 2.5);
  EXPECT_FALSE(facts->tapes[0].at);
  EXPECT_EQ(facts->tapes[1].at->end, 3.0);
  ASSERT_EQ(facts->surveys.size(), 1U);
  EXPECT_TRUE(facts->surveys[0].xyz.isApprox(Vec3(1, 0, -0.25)));
}

TEST(MachineFactsToml, ErrorsNameFileAndLine) {
  const auto wrong = [](const char* text) {
    const auto facts = parse_machine_facts(text, "facts.toml");
    return facts ? "(accepted)" : facts.error().what;
  };
  EXPECT_EQ(wrong("units = { length = \"mm\" }\n"), "facts.toml: expected [[touch]], [[tape]], [[point]] or [[place]]");
  EXPECT_EQ(wrong("[[touch]]\npoint = \"tip\"\nat = [1, 2]\nsigma = 0.001\n"),
            "facts.toml:3: touch 1: \"at\": expected begin, end of two or more time windows [s], each end after its "
            "begin");
  EXPECT_EQ(wrong("[[tape]]\nfrom = \"a\"\nto = \"b\"\nlength = 1\nsigma = 0\n"),
            "facts.toml:5: tape 1: \"sigma\": expected a positive number");
  EXPECT_EQ(wrong("[[tape]]\nfrom = \"a\"\nto = \"b\"\nlength = 1\nsigma = 1\nat = [3, 2]\n"),
            "facts.toml:6: tape 1: \"at\": expected begin, end of a time window [s], each end after its begin");
  EXPECT_EQ(wrong("[[tape]]\nfrom = \"a\"\nto = \"b\"\nlength = 1e9\nsigma = 1\n"),
            "facts.toml:4: tape 1: \"length\": 1e+09 m is not possible for a length (at most 2e+07 m)");
  EXPECT_EQ(wrong("[[place]]\nname = \"a\"\nsensor = \"b\"\nxyz = [0, 1e12, 0]\nsigma = 1\n"),
            "facts.toml:4: place 1: \"xyz\": 1e+12 m is not possible for a length (at most 2e+07 m)");
  EXPECT_NE(wrong("[[tap]]\nfrom = \"a\"\n"), "(accepted)");
}

}  // namespace
}  // namespace kinfer

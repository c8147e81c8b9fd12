// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/text/possible_range.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "kinfer/base/angle.hpp"

namespace kinfer {
namespace {

TEST(PossibleRange, WhatIsReadAtALimitComesBackFromAnotherUnit) {
  for (double value = possible::angle.most; value > possible::angle.most - 1e-8; value -= 1e-10) {
    ASSERT_FALSE(impossible(value, possible::angle));
    EXPECT_FALSE(impossible(value / degree * degree, possible::angle)) << value;
  }
}

TEST(PossibleRange, BeyondItIsNamedWithItsUnit) {
  EXPECT_EQ(impossible(10001.0, possible::angle), "10001 rad is not possible for an angle (at most 10000 rad)");
  EXPECT_EQ(impossible(-400.0, possible::temperature), "-400 C is not possible for a temperature (at least -273.15 C)");
  EXPECT_TRUE(impossible(-1.0, possible::payload));
  EXPECT_FALSE(impossible(0.0, possible::payload));
  EXPECT_TRUE(impossible(-1e300, possible::length));
  EXPECT_TRUE(impossible(std::numeric_limits<double>::quiet_NaN(), possible::number));
  EXPECT_TRUE(impossible(-std::numeric_limits<double>::infinity(), possible::ratio));
}

}  // namespace
}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/parts/plot.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/report/parts/html.hpp"

namespace kinfer {
namespace {

TEST(Ticks, AreRoundNumbersInsideTheAxis) {
  const std::vector<double> t = svg::ticks({.label = "", .low = 0.0, .high = 1.7}, 4);
  ASSERT_EQ(t.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(t[i], 0.5 * static_cast<double>(i), 1e-12);
}

TEST(Ticks, OfALogarithmicAxisArePowersOfTen) {
  const std::vector<double> t = svg::ticks({"", 0.02, 300.0, svg::Scale::logarithmic}, 6);
  ASSERT_EQ(t.size(), 4u);
  EXPECT_NEAR(t.front(), 0.1, 1e-12);
  EXPECT_NEAR(t.back(), 100.0, 1e-9);
}

TEST(Axis, OfValuesThatAreAllTheSameHasAnExtent) {
  const svg::Axis axis = svg::axis_for("", {2.0, 2.0}, svg::From::least);
  EXPECT_LT(axis.low, 2.0);
  EXPECT_GT(axis.high, 2.0);
}

TEST(Axis, WithoutValuesIsStillOne) {
  const svg::Axis axis = svg::axis_for("", {NAN}, svg::From::zero);
  EXPECT_LT(axis.low, axis.high);
}

TEST(Plot, HigherValuesAreDrawnHigher) {
  svg::Plot plot({.label = "x"}, {.label = "y"});
  plot.dot(0.5, 0.25, 2.0, "low");
  plot.dot(0.5, 0.75, 2.0, "high");
  const std::string text = plot.svg("two dots");
  const auto y_of = [&](const char* kind) {
    const auto at = text.find(std::string("class=\"") + kind);
    return std::stod(text.substr(text.find("cy=\"", at) + 4));
  };
  EXPECT_GT(y_of("low"), y_of("high"));  // SVG counts downwards
}

TEST(Plot, AGapInterruptsALine) {
  svg::Plot plot({.label = "x", .low = 0.0, .high = 3.0}, {.label = "y"});
  plot.line({0.0, 1.0, 2.0, 3.0}, {0.1, NAN, 0.2, 0.3}, "line");
  const std::string text = plot.svg("a line");
  const std::string path = text.substr(text.find("class=\"line\""));
  EXPECT_EQ(std::count(path.begin(), path.end(), 'M'), 2);
}

TEST(Numbers, AreRoundedForReadingAndExactForCopying) {
  EXPECT_EQ(html::fixed(-0.00004, 3), "0.000");
  EXPECT_EQ(html::fixed(-1.5, 1), "−1.5");
  EXPECT_EQ(html::fixed(NAN, 2), "–");
  EXPECT_EQ(html::number(0.000123456789, 1e3, 3).exact, "0.123456789");
  EXPECT_EQ(html::short_number(3734.58), "3735");
  EXPECT_EQ(html::short_number(0.0471), "0.047");
}

TEST(Text, IsEscaped) {
  EXPECT_EQ(html::escape("a<b & \"c\">"), "a&lt;b &amp; &quot;c&quot;&gt;");
}

}  // namespace
}  // namespace kinfer

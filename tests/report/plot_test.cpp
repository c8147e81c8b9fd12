// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/parts/plot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "kinfer/base/rng.hpp"
#include "kinfer/report/parts/quantile.hpp"

namespace kinfer::report {
namespace {

/// The value of an attribute of the first element of a class.
double attribute(const std::string& svg, const std::string& kind, const std::string& name) {
  const auto at = svg.find("class=\"" + kind);
  return std::stod(svg.substr(svg.find(" " + name + "=\"", at) + name.size() + 3));
}

std::string path_of(const std::string& svg, const std::string& kind) {
  const auto at = svg.find(" d=\"", svg.find("class=\"" + kind)) + 4;
  return svg.substr(at, svg.find('"', at) - at);
}

TEST(Ticks, AreRoundNumbersInsideTheAxis) {
  const std::vector<double> t = svg::ticks({.label = "", .low = 0.0, .high = 1.7}, 4);
  ASSERT_EQ(t.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(t[i], 0.5 * static_cast<double>(i), 1e-12);
}

TEST(Ticks, OfAnyAxisAreEvenlySpacedByOneTwoOrFiveTimesAPowerOfTen) {
  Rng rng(11);
  for (int trial = 0; trial < 300; ++trial) {
    const double low = rng.uniform(-1e3, 1e3), high = low + std::pow(10.0, rng.uniform(-3.0, 4.0));
    const std::vector<double> t = svg::ticks({.label = "", .low = low, .high = high}, 5);
    ASSERT_GE(t.size(), 2u);
    ASSERT_LE(t.size(), 7u);
    const double step = t[1] - t[0];
    const double digit = step / std::pow(10.0, std::floor(std::log10(step * (1 + 1e-6))));
    EXPECT_LT(std::min({std::abs(digit - 1), std::abs(digit - 2), std::abs(digit - 5)}), 1e-3) << low << " " << high;
    for (const double value : t) {
      EXPECT_GE(value, low - 1e-6 * step);
      EXPECT_LE(value, high + 1e-6 * step);
    }
  }
}

TEST(Ticks, OfALogarithmicAxisArePowersOfTen) {
  const std::vector<double> t = svg::ticks({"", 0.02, 300.0, svg::Scale::logarithmic}, 6);
  ASSERT_EQ(t.size(), 4u);
  EXPECT_NEAR(t.front(), 0.1, 1e-12);
  EXPECT_NEAR(t.back(), 100.0, 1e-9);
}

TEST(Ticks, OfManyDecadesSkipSome) {
  EXPECT_LE(svg::ticks({"", 1e-20, 1e20, svg::Scale::logarithmic}, 6).size(), 7u);
}

TEST(Ticks, OfAnAxisWithoutExtentOrWithAnInfiniteOneAreFew) {
  EXPECT_LE(svg::ticks({.label = "", .low = 1e17, .high = 1e17 + 16}, 4).size(), 9u);
  EXPECT_TRUE(svg::ticks({.label = "", .low = 2.0, .high = 2.0}, 4).empty());
  EXPECT_TRUE(svg::ticks({.label = "", .low = -1.7e308, .high = 1.7e308}, 4).empty());
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

TEST(Axis, FromZeroBeginsThereUnlessValuesAreNegative) {
  EXPECT_EQ(svg::axis_for("", {3.0, 4.0}, svg::From::zero).low, 0.0);
  EXPECT_LT(svg::axis_for("", {-3.0, 4.0}, svg::From::zero).low, -3.0);
}

TEST(Axis, OnALogarithmicScaleLeavesOutWhatIsNotPositive) {
  const svg::Axis axis = svg::log_axis_for("", {0.0, -1.0, NAN, 0.01, 10.0});
  EXPECT_EQ(axis.scale, svg::Scale::logarithmic);
  EXPECT_GT(axis.low, 0.001);
  EXPECT_LT(axis.low, 0.01);
  EXPECT_GT(axis.high, 10.0);
  EXPECT_LT(svg::log_axis_for("", {}).low, svg::log_axis_for("", {}).high);
  EXPECT_GT(svg::log_axis_for("", {5e-324}).low, 0.0);
}

TEST(Plot, HigherValuesAreDrawnHigherAndLargerOnesFurtherRight) {
  for (const svg::Scale scale : {svg::Scale::linear, svg::Scale::logarithmic}) {
    svg::Plot plot({"x", 0.1, 1.0, scale}, {"y", 0.1, 1.0, scale});
    plot.dot(0.2, 0.25, 2.0, "low");
    plot.dot(0.9, 0.75, 2.0, "high");
    const std::string text = plot.svg("two dots");
    EXPECT_GT(attribute(text, "low", "cy"), attribute(text, "high", "cy"));  // SVG counts downwards
    EXPECT_LT(attribute(text, "low", "cx"), attribute(text, "high", "cx"));
  }
}

TEST(Plot, OnALogarithmicScaleEachDecadeIsEquallyLong) {
  svg::Plot plot({"x", 1.0, 1000.0, svg::Scale::logarithmic}, {.label = "y"});
  for (const auto& [x, kind] : {std::pair{1.0, "one"}, {10.0, "ten"}, {100.0, "hundred"}}) plot.dot(x, 0.5, 1.0, kind);
  const std::string text = plot.svg("decades");
  const double one = attribute(text, "one", "cx"), ten = attribute(text, "ten", "cx"),
               hundred = attribute(text, "hundred", "cx");
  EXPECT_NEAR(hundred - ten, ten - one, 0.11);  // coordinates are rounded to 0.1
}

TEST(Plot, ABarStandsOnItsLowerValue) {
  svg::Plot plot({.label = "x", .low = 0.0, .high = 4.0}, {.label = "y", .low = 0.0, .high = 10.0});
  plot.bar(1.0, 2.0, 0.0, 5.0, "half", "a <tip>");
  plot.bar(2.0, 3.0, 0.0, 10.0, "full");
  const std::string text = plot.svg("bars");
  EXPECT_NEAR(attribute(text, "full", "height"), 2.0 * attribute(text, "half", "height"), 0.11);
  EXPECT_NEAR(attribute(text, "half", "y") + attribute(text, "half", "height"),
              attribute(text, "full", "y") + attribute(text, "full", "height"), 0.11);
  EXPECT_NE(text.find("<title>a &lt;tip&gt;</title>"), std::string::npos);
}

TEST(Plot, AGapInterruptsALineAndLeavesADotOfACloudOut) {
  svg::Plot plot({.label = "x", .low = 0.0, .high = 3.0}, {.label = "y"});
  plot.line({0.0, 1.0, 2.0, 3.0}, {0.1, NAN, 0.2, 0.3}, "line");
  plot.cloud({0.0, 1.0, 2.0}, {0.1, NAN, 0.2}, 1.0, "cloud");
  plot.area({0.0, 1.0, 2.0}, {0.1, NAN, 0.2}, {0.2, 0.3, 0.3}, "area");
  const std::string text = plot.svg("a line");
  for (const char* kind : {"line", "dots cloud", "area"}) {
    const std::string path = path_of(text, kind);
    EXPECT_EQ(std::count(path.begin(), path.end(), 'M'), 2) << kind;
  }
}

TEST(Plot, LabelsAndDescriptionsAreEscaped) {
  svg::Plot plot({.label = "a<b"}, {.label = "c>d"});
  plot.words(0.5, 0.5, "note", "\"x\"");
  plot.across(0.5, "border", "<&>");
  const std::string text = plot.svg("<description>");
  for (const char* escaped : {"a&lt;b", "c&gt;d", "&quot;x&quot;", "&lt;&amp;&gt;", "&lt;description&gt;"})
    EXPECT_NE(text.find(escaped), std::string::npos) << escaped;
}

TEST(Plot, CoordinatesAreRoundedToATenth) {
  EXPECT_EQ(svg::coordinate(12.34), "12.3");
  EXPECT_EQ(svg::coordinate(12.0), "12");
  EXPECT_EQ(svg::coordinate(-0.01), "0");
}

TEST(Plot, SmallPowersOfTenAreWrittenAsPowers) {
  const std::string text = svg::Plot({.label = "x"}, {"y", 1e-6, 1e-4, svg::Scale::logarithmic}).svg("small");
  EXPECT_NE(text.find("10<tspan class=\"power\" dy=\"-5\">−5</tspan>"), std::string::npos);
}

TEST(HeatMap, TheDiagonalIsItsOwnAndSignsDiffer) {
  const std::string text = svg::heat_map({"a", "<b>"}, {{1.0, -0.9}, {-0.9, 1.0}}, "correlation");
  const std::regex self("class=\"self\""), minus("class=\"minus\"");
  EXPECT_EQ(std::distance(std::sregex_iterator(text.begin(), text.end(), self), {}), 2);
  EXPECT_EQ(std::distance(std::sregex_iterator(text.begin(), text.end(), minus), {}), 2);
  EXPECT_EQ(text.find("<b>"), std::string::npos);
}

TEST(Quantile, IsThatOfTheSortedFiniteValues) {
  const std::vector<double> sorted = finite_sorted({3.0, NAN, 1.0, 2.0, INFINITY});
  EXPECT_EQ(sorted, (std::vector{1.0, 2.0, 3.0}));
  EXPECT_EQ(quantile(sorted, 0.0), 1.0);
  EXPECT_EQ(quantile(sorted, 0.5), 2.0);
  EXPECT_EQ(quantile(sorted, 1.0), 3.0);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

TEST(Quantile, NiceNumbersAreOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_EQ(round_down(0.3), 1.0);
  EXPECT_EQ(round_down(4.9), 2.0);
  EXPECT_EQ(round_down(73.0), 50.0);
  EXPECT_EQ(round_down(1000.0), 1000.0);
}

}  // namespace
}  // namespace kinfer::report

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/text/units.hpp"

#include <gtest/gtest.h>

#include "kinfer/base/angle.hpp"
#include "kinfer/io/text/csv_text.hpp"

namespace kinfer {
namespace {

double in_si(std::string_view unit, double value) {
  const auto found = find_unit(unit);
  EXPECT_TRUE(found.has_value()) << unit;
  return found ? found->factor * (value + found->offset) : 0.0;
}

TEST(Units, EveryUnitOfTheFormatIsKnownByItsDefinition) {
  EXPECT_EQ(in_si("m", 2), 2);
  EXPECT_DOUBLE_EQ(in_si("mm", 2), 0.002);
  EXPECT_DOUBLE_EQ(in_si("um", 2), 2e-6);
  EXPECT_EQ(in_si("rad", 2), 2);
  EXPECT_DOUBLE_EQ(in_si("deg", 180), 180 * degree);
  EXPECT_DOUBLE_EQ(in_si("mrad", 2), 0.002);
  EXPECT_DOUBLE_EQ(in_si("mm^2", 2), 2e-6);
  EXPECT_DOUBLE_EQ(in_si("um^2", 2), 2e-12);
  EXPECT_EQ(in_si("m^2", 2), 2);
  EXPECT_EQ(in_si("rad^2", 2), 2);
  EXPECT_DOUBLE_EQ(in_si("mrad^2", 2), 2e-6);
  EXPECT_DOUBLE_EQ(in_si("deg^2", 1), degree * degree);
  EXPECT_EQ(in_si("s", 2), 2);
  EXPECT_DOUBLE_EQ(in_si("ms", 2), 0.002);
  EXPECT_DOUBLE_EQ(in_si("us", 2), 2e-6);
  EXPECT_EQ(in_si("kg", 2), 2);
  EXPECT_EQ(in_si("N.m", 2), 2);
  EXPECT_EQ(in_si("m/s^2", 2), 2);
  EXPECT_DOUBLE_EQ(in_si("g", 1), 9.80665);
  EXPECT_EQ(in_si("rad/s", 2), 2);
  EXPECT_DOUBLE_EQ(in_si("deg/s", 360), 360 * degree);
  EXPECT_EQ(in_si("uT", 2), 2);
  EXPECT_DOUBLE_EQ(in_si("mT", 2), 2000);
  EXPECT_DOUBLE_EQ(in_si("T", 50e-6), 50);
  EXPECT_DOUBLE_EQ(in_si("G", 0.5), 50);
  EXPECT_EQ(in_si("C", 20), 20);
  EXPECT_DOUBLE_EQ(in_si("K", 273.15), 0);
  EXPECT_EQ(in_si("1", 2), 2);
}

TEST(Units, OtherTextsAreNoUnits) {
  for (const char* text : {"", "MM", "inch", "degree", "m ", "gauss"}) EXPECT_FALSE(find_unit(text)) << text;
}

TEST(Units, AHeaderIsANameAndPerhapsAUnit) {
  EXPECT_EQ(parse_column_header(" q1 [deg] ").name, "q1");
  EXPECT_EQ(parse_column_header(" q1 [deg] ").unit, "deg");
  EXPECT_FALSE(parse_column_header("q1").has_unit);
  EXPECT_TRUE(parse_column_header("q1[]").has_unit) << "an empty bracket is not SI";
  EXPECT_EQ(parse_column_header("[deg]").name, "");
  EXPECT_EQ(parse_column_header("").name, "");
  EXPECT_EQ(parse_column_header("a]").name, "a]");
}

TEST(Units, AHeaderThatWasKeptFromBeingAFormulaComesBack) {
  for (const std::string name : {"=a_ax", "-x", "@cmd", "+1+1", "'quoted'", "q1"}) {
    EXPECT_EQ(parse_column_header(csv_cell(name)).name, name);
    EXPECT_EQ(parse_column_header(csv_cell(name + "[mm]")).name, name);
    EXPECT_EQ(parse_column_header(csv_cell(name + "[mm]")).unit, "mm");
  }
}

}  // namespace
}  // namespace kinfer

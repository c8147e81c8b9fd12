// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/text/csv.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace kinfer {
namespace {

TEST(NumericCsv, CellsGoToColumnsAndEmptyOnesAreMissing) {
  const auto table = parse_numeric_csv("# log\nt,a,b\r\n0,1.5,-2e3\r\n0.1,,nan\r\n\r\n0.2, +7 ,\"8\"\r\n", "log.csv");
  ASSERT_TRUE(table.has_value()) << table.error().what;
  EXPECT_EQ(table->header.columns, (std::vector<std::string>{"t", "a", "b"}));
  EXPECT_EQ(table->line, (std::vector<int>{3, 4, 6}));
  EXPECT_EQ(table->columns[0], (std::vector<double>{0, 0.1, 0.2}));
  EXPECT_EQ(table->columns[1][0], 1.5);
  EXPECT_EQ(table->columns[2][0], -2000);
  EXPECT_TRUE(std::isnan(table->columns[1][1]) && std::isnan(table->columns[2][1]));
  EXPECT_EQ(table->columns[1][2], 7);
  EXPECT_EQ(table->columns[2][2], 8);
}

TEST(NumericCsv, ALineMayEndWithAnEmptyCellAndTheFileWithoutALineEnd) {
  const auto table = parse_numeric_csv("t,a,b\n1,2,\n3,,", "log.csv");
  ASSERT_TRUE(table.has_value()) << table.error().what;
  EXPECT_EQ(table->rows(), 2U);
  EXPECT_TRUE(std::isnan(table->columns[2][0]) && std::isnan(table->columns[2][1]));
}

TEST(NumericCsv, AgreesWithTheCellsReadOneByOne) {
  const std::string text = "a;b;c\n1,5;-2;3e-2\n;7,25;\n +1; 2 ;\"3\"\n";
  const CsvFormat format{.delimiter = ';', .decimal = ','};
  const auto numbers = parse_numeric_csv(text, "log.csv", format);
  const auto cells = split_csv(text, "log.csv", format);
  ASSERT_TRUE(numbers.has_value() && cells.has_value());
  ASSERT_EQ(numbers->rows(), cells->rows());
  for (std::size_t row = 0; row < cells->rows(); ++row)
    for (std::size_t column = 0; column < 3; ++column) {
      const auto slow = parse_number(cells->cell(row, column), ',');
      const double fast = numbers->columns[column][row];
      EXPECT_EQ(slow.has_value(), !std::isnan(fast));
      if (slow) {
        EXPECT_EQ(fast, *slow);
      }
    }
}

TEST(NumericCsv, BadCellsAndRowsAreNamed) {
  const auto complaint = [](const std::string& text, const CsvFormat& format = {}) {
    const auto table = parse_numeric_csv(text, "log.csv", format);
    return table ? "(accepted)" : table.error().what;
  };
  EXPECT_EQ(complaint("t,a\n1,2\n1\n"), "log.csv:3: expected 2 columns, found 1");
  EXPECT_EQ(complaint("t,a\n1,2,3\n").rfind("log.csv:2: expected 2 columns, found 3", 0), 0U);
  EXPECT_EQ(complaint("t,a\n1,x\n"), "log.csv:2: column a: expected a number, found \"x\"");
  EXPECT_EQ(complaint("t,a\n1,2x\n"), "log.csv:2: column a: expected a number, found \"2x\"");
  EXPECT_EQ(complaint("t,a\n1,1.2.3\n"),
            "log.csv:2: column a: expected a number, found \"1.2.3\"; thousands separators are not read");
  EXPECT_EQ(complaint("t;a\n1;2.5\n", {.delimiter = ';', .decimal = ','}),
            "log.csv:2: column a: expected a number, found \"2.5\"; the decimal mark of this file is the comma");
}

TEST(Csv, ColumnsMustBeDistinctWhateverTheirUnits) {
  const auto header = read_csv_header("t,imu_ax[g],imu_ax[m/s^2]\n", "log.csv");
  ASSERT_TRUE(header.has_value());
  EXPECT_EQ(expect_distinct_columns(*header, "log.csv").error().what, "log.csv:1: column imu_ax appears twice");
}

TEST(Csv, NumbersAreWholeCellsOnly) {
  EXPECT_EQ(parse_number("1e3"), 1000.0);
  EXPECT_EQ(parse_number("+.5"), 0.5);
  EXPECT_EQ(parse_number("-1,5", ','), -1.5);
  for (const char* bad : {"", "-", "+-1", "1 2", "1,5", "0x1p3", "1e", "--1", "1.5.", "1e999"})
    EXPECT_FALSE(parse_number(bad)) << bad;
}

}  // namespace
}  // namespace kinfer

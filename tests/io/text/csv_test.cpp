// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/text/csv.hpp"

#include <gtest/gtest.h>

namespace kinfer {
namespace {

std::vector<std::string> cells_of(const CsvTable& table, std::size_t column) {
  std::vector<std::string> cells;
  for (std::size_t row = 0; row < table.rows(); ++row) cells.emplace_back(table.cell(row, column));
  return cells;
}

TEST(Csv, CellsAreTrimmedAndUnquotedAndKeepTheirLines) {
  const std::string text = "# log\nt,a,b\r\n0,1.5,-2e3\r\n0.1,,nan\r\n\r\n0.2, +7 ,\"8, \"\"x\"\"\"\r\n";
  const auto table = split_csv(text, "log.csv");
  ASSERT_TRUE(table.has_value()) << table.error().what;
  EXPECT_EQ(table->header.columns, (std::vector<std::string>{"t", "a", "b"}));
  EXPECT_EQ(table->line, (std::vector<int>{3, 4, 6}));
  EXPECT_EQ(cells_of(*table, 1), (std::vector<std::string>{"1.5", "", "+7"}));
  EXPECT_EQ(cells_of(*table, 2), (std::vector<std::string>{"-2e3", "nan", "8, \"x\""}));
}

TEST(Csv, ALineMayEndWithAnEmptyCellAndTheFileWithoutALineEnd) {
  const std::string text = "t,a,b\n1,2,\n3,,";
  const auto table = split_csv(text, "log.csv");
  ASSERT_TRUE(table.has_value()) << table.error().what;
  EXPECT_EQ(cells_of(*table, 0), (std::vector<std::string>{"1", "3"}));
  EXPECT_EQ(cells_of(*table, 2), (std::vector<std::string>{"", ""}));
}

TEST(Csv, RowsOfAnotherLengthAreNamed) {
  const auto complaint = [](const std::string& text) {
    const auto table = split_csv(text, "log.csv");
    return table ? "(accepted)" : table.error().what;
  };
  EXPECT_EQ(complaint("t,a\n1,2\n1\n"), "log.csv:3: expected 2 columns, found 1");
  EXPECT_EQ(complaint("t,a\n1,2,3\n").rfind("log.csv:2: expected 2 columns, found 3; are there commas", 0), 0U);
}

TEST(Csv, TheCauseOfACellThatIsNoNumberIsNamedWhereItIsKnown) {
  EXPECT_EQ(describe_invalid_number("a", "2x", '.'), "column a: expected a number, found \"2x\"");
  EXPECT_EQ(describe_invalid_number("a", "1.2.3", '.'),
            "column a: expected a number, found \"1.2.3\"; thousands separators are not read");
  EXPECT_EQ(describe_invalid_number("a", "2.5", ','),
            "column a: expected a number, found \"2.5\"; the decimal mark of this file is the comma");
  EXPECT_EQ(describe_invalid_number("a", "2,5", '.'),
            "column a: expected a number, found \"2,5\"; a column map can say decimal = \",\"");
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

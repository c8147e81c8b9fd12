// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/text/csv_text.hpp"

#include <gtest/gtest.h>

#include "kinfer/io/text/csv.hpp"

namespace kinfer {
namespace {

TEST(CsvText, ACellThatASpreadsheetWouldRunIsHarmlessAndComesBack) {
  for (const std::string name : {"=1+1", "+cmd", "-x", "@sum", "=HYPERLINK(\"http://x\",\"y\")", "plain", "a,b",
                                 "\"q\"", "#c", "'quoted'", "\u00e4;b", " blank "}) {
    const std::string text = "name,other\n" + csv_cell(name) + ",1\n";
    const auto table = split_csv(text, "test");
    ASSERT_TRUE(table) << table.error().what;
    const std::string_view cell = table->cell(0, 0);
    EXPECT_EQ(std::string("=+-@").find(cell.front()), std::string::npos) << name;
    if (name == " blank ") continue;  // cells are trimmed on reading
    EXPECT_EQ(without_formula_guard(cell), name);
  }
}

TEST(CsvText, NumbersAreNoFormulas) {
  for (const std::string number : {"-1", "+2.5", "-1e-3", "0"}) EXPECT_EQ(csv_cell(number), number);
}

TEST(CsvText, ARowStaysOneLine) {
  EXPECT_EQ(csv_cell("a\nb\rc\x01"), "\"a b c \"");
}

}  // namespace
}  // namespace kinfer

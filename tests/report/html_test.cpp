// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/parts/html.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace kinfer::report::html {
namespace {

TEST(Text, IsEscapedAndNothingElseChanges) {
  EXPECT_EQ(escape("a<b & \"c\">"), "a&lt;b &amp; &quot;c&quot;&gt;");
  EXPECT_EQ(escape("± µm – Ω"), "± µm – Ω");
  for (int c = 1; c < 128; ++c) {
    const std::string safe = escape(std::string(1, static_cast<char>(c)));
    EXPECT_EQ(safe.find_first_of("<>\""), std::string::npos);
    EXPECT_TRUE(safe.size() == 1 || (safe.front() == '&' && safe.back() == ';'));
  }
}

TEST(Text, ProseKeepsUnitsWithTheirNumbersAndSetsCallsAsCode) {
  EXPECT_EQ(prose("± 5 mm in J1 12 of a < b"), "±&nbsp;5&nbsp;mm in J1 12&nbsp;of a &lt; b");
  EXPECT_EQ(prose("as kinfer plan --data chooses, or kinfer verify."),
            "as <code>kinfer plan --data</code> chooses, or <code>kinfer verify</code>.");
  EXPECT_EQ(prose("kinfer"), "kinfer");
}

TEST(Numbers, AreRoundedForReadingAndExactForCopying) {
  EXPECT_EQ(fixed(-0.00004, 3), "0.000");
  EXPECT_EQ(fixed(-1.5, 1), "−1.5");
  EXPECT_EQ(fixed(NAN, 2), "–");
  EXPECT_EQ(fixed(INFINITY, 2), "–");
  EXPECT_EQ(number(0.000123456789, 1e3, 3).exact, "0.123456789");
  EXPECT_EQ(number(NAN, 3).exact, "");
}

TEST(Numbers, ShortOnesHaveAboutThreeDigits) {
  EXPECT_EQ(short_number(3734.58), "3735");
  EXPECT_EQ(short_number(37.3458), "37.3");
  EXPECT_EQ(short_number(3.73458), "3.73");
  EXPECT_EQ(short_number(0.0471), "0.047");
  EXPECT_EQ(short_number(0.00471), "0.0047");
  EXPECT_EQ(short_number(0.0), "0.000");
}

TEST(Table, TheHeadOfANumberColumnIsSetAsOne) {
  const std::string html =
      table({.name = "t", .caption = "<c>", .head = {"a", "b"}, .rows = {{text("x"), number(1.0, 2)}}});
  EXPECT_NE(html.find("<th scope=\"col\">a</th><th scope=\"col\" class=\"num\">b</th>"), std::string::npos);
  EXPECT_NE(html.find("<td>x</td><td class=\"num\" data-v=\"1\">1.00</td>"), std::string::npos);
  EXPECT_NE(html.find("<caption>&lt;c&gt;</caption>"), std::string::npos);
}

TEST(Table, ACellThatIsNotDeterminedKeepsItsWordsForCopying) {
  const Cell cell = undetermined_cell("not <determined>");
  EXPECT_EQ(cell.kind, CellKind::number);
  EXPECT_EQ(cell.exact, "not <determined>");
  EXPECT_EQ(cell.shown.find("<determined>"), std::string::npos);
}

TEST(Table, ALongOneIsFoldedAndAShortOneMarked) {
  Table rows{.name = "t", .caption = "", .head = {"a"}, .rows = {}, .long_after = 20};
  const auto kind_with = [&](std::size_t n) {
    rows.rows.assign(n, {text("x")});
    const std::string html = table(rows);
    return html.substr(12, html.find('"', 12) - 12);
  };
  EXPECT_EQ(kind_with(3), "table short");
  EXPECT_EQ(kind_with(18), "table");
  EXPECT_EQ(kind_with(21), "table folded");
}

TEST(Table, AnEmptyOneHasAHeadAndNoRows) {
  const std::string html = table({.name = "t", .caption = "c", .head = {"a"}, .rows = {}});
  EXPECT_NE(html.find("<th scope=\"col\">a</th>"), std::string::npos);
  EXPECT_EQ(html.find("<td"), std::string::npos);
}

TEST(Figure, WithoutADrawingIsNone) {
  EXPECT_EQ(figure("id", "Title", "", "words"), "");
  EXPECT_NE(figure("id", "Title", "<svg/>", "words").find("<figure id=\"id\"><h3>Title</h3><svg/>"), std::string::npos);
}

TEST(List, WithoutItemsIsNone) {
  EXPECT_EQ(list({}), "");
  EXPECT_EQ(list({"a", "b"}, "todo"), "<ul class=\"todo\"><li>a</li><li>b</li></ul>\n");
}

TEST(Legend, ShowsEachMarkWithItsMeaning) {
  EXPECT_EQ(legend({{"dot", "a pose"}}), "<p class=\"legend\"><span><i class=\"dot\"></i>a pose</span></p>");
}

}  // namespace
}  // namespace kinfer::report::html

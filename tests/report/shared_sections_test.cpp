// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/parts/shared_sections.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "kinfer/report/parts/plan_figure.hpp"
#include "kinfer/report/parts/verdict_block.hpp"
#include "support/html_text.hpp"

namespace kinfer::report {
namespace {

using test::shows;

TEST(VerdictBlock, HasAChipAHeadlineAndRemarks) {
  const VerdictRecord verdict{"", Usability::use_with_care,
                              VerdictText{"Use <with> care", "better <now>", {"but 2 rows were wrong", "so"}}};
  const std::string html = verdict_block(verdict, "Calibration");
  EXPECT_TRUE(shows(html, "<span class=\"chip fair\">Use &lt;with&gt; care</span> Better &lt;now&gt;</h1>")) << html;
  EXPECT_TRUE(shows(html, "<p>But 2&nbsp;rows were wrong; so.</p>")) << html;
}

TEST(VerdictBlock, IsColouredByTheUsability) {
  EXPECT_TRUE(shows(verdict_block({"x", Usability::use, {}}, ""), "<span class=\"chip good\">Use it</span>"));
  EXPECT_TRUE(shows(verdict_block({"x", Usability::use_with_care, {}}, ""), "chip fair\">Use with care"));
  EXPECT_TRUE(shows(verdict_block({"x", Usability::do_not_use, {}}, ""), "chip bad\">Do not use"));
}

TEST(VerdictBlock, WithoutPartsTheSentenceIsTheHeadline) {
  const std::string html = verdict_block({"Use it: 3 joints found; and more", Usability::use, {}}, "Identification");
  EXPECT_TRUE(shows(html, "</span> Use it: 3&nbsp;joints found; and more</h1>")) << html;
  EXPECT_FALSE(shows(html, "<p>"));
}

TEST(Advice, IsCutAtTheMostUseful) {
  const std::vector<Advice> advice{{"First", "because"}, {"Second <b>", "why"}, {"Third", "why"}};
  const std::string html = advice_list(advice, 2);
  EXPECT_TRUE(shows(html, "<b>First.</b> <span class=\"why\">Because.</span>"));
  EXPECT_TRUE(shows(html, "Second &lt;b&gt;"));
  EXPECT_FALSE(shows(html, "Third"));
  EXPECT_TRUE(shows(next_section(advice).body, "Third"));
  EXPECT_TRUE(shows(next_section({}).body, "No further measurement is recommended"));
}

TEST(Findings, ShowSeverityRowsAndWhatWasDone) {
  FindingRecord open{.finding = {.severity = Severity::fault}, .sentence = "a <fault>", .suggestion = "look"};
  for (int row = 0; row < 11; ++row) open.finding.rows.push_back(row);
  const FindingRecord fixed{
      .finding = {.severity = Severity::note, .applied = true}, .sentence = "b", .suggestion = "hidden"};
  const std::string html = findings_table({open, fixed}, FindingRows::shown);
  EXPECT_TRUE(shows(html, "<td>fault</td><td>a &lt;fault&gt;</td><td>0, 1, 2, 3, 4, 5, 6, 7 and 3 more</td>")) << html;
  EXPECT_TRUE(shows(html, "<td>note</td><td>b</td><td></td><td>was corrected</td>"));
  EXPECT_FALSE(shows(html, "hidden"));
  EXPECT_FALSE(shows(findings_table({open}, FindingRows::hidden), "rows (from 0)"));
  EXPECT_EQ(findings_table({}, FindingRows::shown), "");
}

TEST(Provenance, OptionsAreSortedAndEscaped) {
  const std::string html = repeat_section({"1.2.3", 7, {{"zeta", "<z>"}, {"alpha", "a"}}, {{"in.csv", "abc"}}}).body;
  EXPECT_LT(html.find("alpha"), html.find("zeta"));
  EXPECT_TRUE(shows(html, "&lt;z&gt;"));
  EXPECT_TRUE(shows(html, "<td>seed</td><td>7</td>"));
  EXPECT_TRUE(shows(html, "<code>abc</code>"));
}

TEST(Notices, NameTheAuthorsOfTheScriptsAndTheirLicence) {
  const std::string html = notices_section().body;
  for (const char* part : {"three.js", "2010-2026", "µPlot", "Leon Sorokin", "Permission is hereby granted"})
    EXPECT_TRUE(shows(html, part)) << part;
}

TEST(Notes, AreAListOrNothing) {
  EXPECT_EQ(notes_list({}), "");
  EXPECT_TRUE(shows(notes_list({"<note>"}), "<li>&lt;note&gt;</li>"));
}

TEST(Glossary, PairsWordsAndMeanings) {
  EXPECT_TRUE(shows(glossary_section({{"rms", "a mean"}}).body, "<dt>rms</dt><dd>a mean</dd>"));
}

TEST(Convergence, DrawsBestAndMedianOverTheGenerations) {
  const std::string svg = convergence_plot({3.0, 1.0, 0.1}, {5.0, 4.0}, "a <search>");
  EXPECT_TRUE(shows(svg, "line-before"));
  EXPECT_TRUE(shows(svg, "line-after"));
  EXPECT_TRUE(shows(svg, "a &lt;search&gt;"));
}

TEST(PlanFigure, ShowsBothCurvesAndStandsAlone) {
  PosePlan plan;
  plan.expected = {20, 1e-5, 2e-5};
  for (int n = 5; n <= 20; ++n) {
    plan.planned_curve.push_back({n, 1e-4 / n, 2e-4 / n});
    plan.random_curve.push_back({n, 2e-4 / n, 4e-4 / n});
  }
  const std::string svg = plan_figure(plan);
  EXPECT_TRUE(svg.starts_with("<?xml"));
  EXPECT_TRUE(shows(svg, "xmlns=\"http://www.w3.org/2000/svg\""));
  EXPECT_TRUE(shows(svg, "planned one by one"));
  EXPECT_TRUE(shows(svg, "random poses"));
  EXPECT_FALSE(plan_figure({}).empty());
}

}  // namespace
}  // namespace kinfer::report

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/identify/page.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "kinfer/io/evidence/identification_json.hpp"
#include "kinfer/report/identify/figures.hpp"
#include "kinfer/report/identify/sections.hpp"
#include "kinfer/report/identify/unobservable.hpp"
#include "support/html_text.hpp"
#include "support/rich_evidence.hpp"

namespace kinfer::report {
namespace {

using test::shows;

IdentificationEvidence found() {
  return identification_evidence(test::rich_identification(), test::rich_provenance());
}

TEST(IdentificationPage, EverySectionHasItsPlace) {
  std::vector<std::string> ids;
  for (const html::Section& section : identification_page(found()).sections) ids.push_back(section.id);
  EXPECT_EQ(ids, (std::vector<std::string>{"joints-section", "order", "dh-section", "fit-section", "unknown", "doubts",
                                           "search", "next", "words", "repeat", "notices"}));
}

TEST(IdentificationPage, ShowsFindingsWhereThereAreAny) {
  IdentificationEvidence e = found();
  EXPECT_TRUE(shows(recording_section(e).body, "s&lt;1&gt;"));
  EXPECT_TRUE(shows(recording_section(e).body, html::escape(e.findings[0].suggestion)));
  EXPECT_TRUE(shows(recording_section(e).body, "<td>note</td>"));
  e.findings.clear();
  const Page page = identification_page(e);
  EXPECT_TRUE(std::ranges::none_of(page.sections, [](const auto& section) { return section.id == "doubts"; }));
}

TEST(IdentificationPage, BeginsWithWhatChangedWhereAChainWasUpdated) {
  Identification updated = test::rich_identification();
  updated.update = ChainUpdate{
      .changes = {{ChainChangeKind::sensor_moved, "s<1>", "s<1>", "", ChangeSize{0.0174533, 1e-4}, {}, 1250.0}},
      .parts = {{"s0-s<1>", "s0", ChainPartQuantity::axis, 0.0175, 2e-4, 900.0, 2}}};
  const IdentificationEvidence e = identification_evidence(updated, test::rich_provenance());
  const Page page = identification_page(e);
  EXPECT_EQ(page.sections.front().id, "update-section");
  const std::string& body = page.sections.front().body;
  EXPECT_TRUE(shows(body, "s&lt;1&gt;"));
  EXPECT_TRUE(shows(body, "1.00 ± 0.01"));
  EXPECT_TRUE(shows(body, "unknown"));
  EXPECT_TRUE(shows(body, "17.50"));
}

TEST(IdentificationPage, StatesHowProbableATypeIs) {
  const std::string body = joints_section(found()).body;
  EXPECT_TRUE(shows(body, "spherical, 70.0 %"));
  EXPECT_TRUE(shows(body, "<td>revolute</td>")) << "not weighed";
}

TEST(IdentificationPage, TellsWhetherTheOrderIsSafe) {
  IdentificationEvidence e = found();
  EXPECT_TRUE(shows(identification_page(e).first, "is safe: the next best order fits 5.50 times worse"));
  e.order.margin = 1.2;
  EXPECT_TRUE(shows(identification_page(e).first, "<b>not safe</b>"));
  e.order.margin.reset();
  EXPECT_TRUE(shows(identification_page(e).first, "no other order is possible"));
  EXPECT_TRUE(shows(order_section(e).lead, "there is no other tree"));
}

TEST(IdentificationPage, StatesTheLargestDeviationOfTheAxes) {
  IdentificationEvidence e = found();
  EXPECT_TRUE(shows(identification_page(e).first, "±&nbsp;<b>1.3&nbsp;mm</b> and ±&nbsp;<b>2.00&nbsp;mrad</b>"));
  e.forecast.clear();
  EXPECT_FALSE(shows(identification_page(e).first, "The axes of the joints are known"));
}

TEST(Uncertain, NamesAzimuthJointsAndTheToolThatNothingTouched) {
  IdentificationEvidence e = found();
  e.joints[0].unobservable[0].what = "where <it> is";
  e.joints[1].sentences = {"its azimuth: rock it"};  // as in older files
  std::vector<std::string> items = uncertain_items(e);
  ASSERT_EQ(items.size(), 3u);
  EXPECT_EQ(items[0], "the azimuth of <b>s0</b> about its only axis: ±&nbsp;4&nbsp;mrad");
  EXPECT_EQ(items[1], "<b>s0–s&lt;1&gt;</b>: where &lt;it&gt; is");  // without the remedy
  EXPECT_EQ(items[2], "<b>s&lt;1&gt;–s2</b>: its azimuth: rock it");
  e.places.clear();
  EXPECT_EQ(uncertain_items(e).back(), "where the tool is beyond <b>s2</b>");
}

TEST(Uncertain, FreeChoicesAreListedInTheirSectionAlone) {
  IdentificationEvidence e = found();
  e.forecast.clear();
  e.joints[0].estimate.unobservable_in_child.clear();
  EXPECT_TRUE(uncertain_items(e).empty());
  for (const std::string& sentence : e.joints[0].sentences)
    EXPECT_TRUE(shows(unobservable_section(e).body, html::escape(sentence))) << sentence;
}

TEST(Uncertain, MoreThanFourAreCountedAndNothingIsToldToo) {
  IdentificationEvidence e = found();
  const JointRecord joint = e.joints[0];
  e.joints.assign(6, joint);
  EXPECT_TRUE(shows(identification_page(e).first, "and 3 more"));
  e.joints.clear(), e.forecast.clear();
  EXPECT_TRUE(shows(identification_page(e).first, "is observable from this recording"));
}

TEST(IdentifiedJoints, ASphericalJointHasNoAxisAndAnUnknownPointIsInBrackets) {
  const std::string body = joints_section(found()).body;
  EXPECT_TRUE(shows(body, "<td>spherical</td>"));
  EXPECT_TRUE(shows(body, "<td class=\"num\">–</td>"));
  EXPECT_TRUE(shows(body, "<span class=\"note\">(−100.0&ensp;0.0&ensp;50.0)</span>"));
  EXPECT_TRUE(shows(body, "100.0&ensp;200.0&ensp;300.0</td>"));  // [mm]
}

TEST(IdentifiedJoints, AnAxisOfMoreThanHalfARadianIsNotDeterminable) {
  IdentificationEvidence e = found();
  e.joints[0].estimate.sd.axis_in_parent = {0.668, 0.0};
  EXPECT_FALSE(shows(joints_section(e).body, "668.00"));
  e.joints[0].estimate.sd.axis_in_parent = {0.468, 0.0};
  EXPECT_TRUE(shows(joints_section(e).body, "468.00"));
}

TEST(IdentifiedJoints, LinksAreShownWithTheirDeviation) {
  const std::string body = joints_section(found()).body;
  EXPECT_TRUE(shows(body, "data-v=\"350\">350.0</td><td class=\"num\" data-v=\"2\">2.0</td>"));
  EXPECT_TRUE(shows(body, "not determinable"));  // 0.9 m
  IdentificationEvidence none = found();
  none.links.clear();
  EXPECT_FALSE(shows(joints_section(none).body, "id=\"links\""));
}

TEST(DhTable, ANumberWithoutDeviationIsAChoice) {
  const std::string body = dh_section(found()).body;
  EXPECT_TRUE(shows(body, "<small>± 3.0</small>"));  // d of the first row [mm]
  EXPECT_TRUE(shows(body, ">300.0</td>"));           // d of the second
  EXPECT_TRUE(shows(body, "not determinable"));      // theta of the first
  EXPECT_TRUE(shows(body, "<td>s&lt;1&gt;-s2</td>"));
}

TEST(OrderTables, PairsAreSortedByWhatTheyLeave) {
  const std::string body = order_section(found()).body;
  EXPECT_LT(body.find("s&lt;1&gt;–s2"), body.find("s0–s&lt;1&gt;</td>"));
  EXPECT_LT(body.find("s0–s&lt;1&gt;</td>"), body.find("s0–s2"));
  EXPECT_TRUE(shows(body, "id=\"phases\""));
}

TEST(TreeDrawing, SegmentsStandRightOfTheirParents) {
  const std::string svg = tree_drawing(found());
  const auto x_of = [&](const std::string& name) {
    const std::size_t text = svg.find(">" + name + "<");
    return std::stod(svg.substr(svg.rfind(" x=\"", text) + 4));
  };
  EXPECT_LT(x_of("s0"), x_of("s&lt;1&gt;"));
  EXPECT_LT(x_of("s&lt;1&gt;"), x_of("s2"));
  EXPECT_TRUE(shows(svg, "0.050 m/s²"));
}

TEST(TreeDrawing, AJointThatLeadsBackEndsTheTree) {
  IdentificationEvidence e = found();
  e.joints[1].estimate.child = "s0";
  EXPECT_TRUE(shows(tree_drawing(e), "<svg"));
  e.joints[0].estimate.child = e.joints[0].estimate.parent;
  EXPECT_TRUE(shows(tree_drawing(e), "<svg"));
}

TEST(TreeDrawing, ALongNameIsCutBetweenCharacters) {
  IdentificationEvidence e = found();
  e.joints[1].estimate.child = "ääääääää";
  EXPECT_TRUE(shows(tree_drawing(e), ">ääää…<"));
}

TEST(TraceDrawing, ShowsTheMostActiveAxisAndTheUnitAsRead) {
  const std::string html = trace_drawings(found());
  EXPECT_TRUE(shows(html, "<h4>s&lt;1&gt;, acceleration x</h4>"));
  EXPECT_TRUE(shows(html, "<h4>s&lt;1&gt;, angular velocity x</h4>"));
  EXPECT_TRUE(shows(html, "x [m/s²]"));
}

TEST(TraceDrawing, TheResidualIsThatOfRowsThatWereNotFitted) {
  IdentificationEvidence e = found();
  EXPECT_TRUE(shows(residual_drawing(e), "<b>0.120</b> m/s²"));
  e.motion.traces[0].rms_holdout = 0.0;
  EXPECT_TRUE(shows(residual_drawing(e), "<b>0.100</b> m/s²"));
  e.motion.traces.clear();
  EXPECT_EQ(residual_drawing(e), "");
  EXPECT_FALSE(shows(fit_section(e).body, "id=\"traces\""));
}

TEST(IdentifiedMachine, UnobservableDirectionsAreDrawn) {
  IdentificationEvidence e = found();
  EXPECT_TRUE(shows(identified_machine_drawing(e), "class=\"open\""));
  e.joints[0].estimate.unobservable_in_child.clear();
  EXPECT_FALSE(shows(identified_machine_drawing(e), "class=\"open\""));
}

TEST(FitTable, ASegmentThatWasNotHeldOutHasNoSuchFigures) {
  IdentificationEvidence e = found();
  EXPECT_TRUE(shows(fit_section(e).body, "0.30000"));
  e.fit.holdout.clear();
  EXPECT_FALSE(shows(fit_section(e).body, "0.30000"));
  EXPECT_TRUE(shows(fit_section(e).body, "<td>–</td>"));
}

TEST(SearchSection, DrawsEachSearchedSegment) {
  EXPECT_TRUE(shows(search_section(found()).body, "Search of s&lt;1&gt;"));
  IdentificationEvidence e = found();
  e.search.segments.clear();
  EXPECT_TRUE(shows(search_section(e).body, "Search of part 1"));
  e.search.best.clear();
  EXPECT_EQ(search_section(e).body, "<p>No population was searched.</p>");
}

}  // namespace
}  // namespace kinfer::report

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/screening/loops.hpp"

#include <gtest/gtest.h>

#include "identify/hand_made_tree.hpp"
#include "kinfer/identify/findings/order_evidence.hpp"
#include "kinfer/words/findings/findings.hpp"

namespace kinfer {
using namespace identify;
namespace {

using test::revolute_pair;

/// A chain of four bars whose ends share a revolute joint, too.
SegmentTree four_bars(double residual = 0.02) {
  SegmentTree tree = test::hand_made_tree(4, test::serial_edges(4));
  test::replace_pair(tree, revolute_pair(0, 3, residual));
  test::pair_of(tree, 0, 3).distance = 1.3;
  return tree;
}

TEST(Loops, APairThatIsAsGoodAJointAsThoseOfItsPathClosesALoop) {
  const std::vector<PairFit> closing = loop_closing_pairs(four_bars());
  ASSERT_EQ(closing.size(), 1U);
  EXPECT_EQ(closing[0].first, 0U);
  EXPECT_EQ(closing[0].second, 3U);
  EXPECT_TRUE(loop_closing_pairs(test::hand_made_tree(4, test::serial_edges(4))).empty());
}

TEST(Loops, APoorerJointClosesNone) {
  EXPECT_EQ(loop_closing_pairs(four_bars(0.029)).size(), 1U);
  EXPECT_TRUE(loop_closing_pairs(four_bars(0.031)).empty())
      << "more than three times the residual of the tree's joints";
}

TEST(Loops, TwoAxesMayIntersectWithoutALoop) {
  SegmentTree tree = test::hand_made_tree(4, test::serial_edges(4));
  test::replace_pair(tree, revolute_pair(0, 2, 0.01));
  EXPECT_TRUE(loop_closing_pairs(tree).empty());
}

TEST(Loops, EveryJointOfALoopIsRevoluteAndMoves) {
  SegmentTree tree = four_bars();
  test::replace_pair(tree, test::unrelated_pair(1, 2, 0.01));  // spherical
  EXPECT_TRUE(loop_closing_pairs(tree).empty());
  tree = four_bars();
  test::pair_of(tree, 1, 2).angular_velocity = Vec3(0.0, 0.0, 1e-4).asDiagonal();  // 0.01 rad/s
  EXPECT_TRUE(loop_closing_pairs(tree).empty());
}

TEST(Loops, AreReportedWithTheirSegmentsAndResiduals) {
  SegmentTree tree = four_bars();
  test::replace_pair(tree, revolute_pair(1, 2, 0.015));
  const auto findings = loop_findings(tree, loop_closing_pairs(tree), {"boom", "lever", "rod", "bucket"});
  ASSERT_EQ(findings.size(), 1U);
  const FactValues& values = findings[0].values;
  EXPECT_EQ(values.texts("segments"), (std::vector<std::string>{"boom", "lever", "rod", "bucket"}));
  EXPECT_EQ(values.text("first") + " " + values.text("second"), "boom bucket");
  EXPECT_NEAR(values.number("residual"), 0.02, 1e-12);
  EXPECT_NEAR(values.number("largest_tree_residual"), 0.015, 1e-12);
  EXPECT_FALSE(findings[0].applied);
  EXPECT_NE(words::sentence(findings[0]).find("boom, lever, rod, bucket"), std::string::npos);
}

/// The hand-made tree with segments that rest for a second.
OrderedMotion resting(SegmentTree tree) {
  OrderedMotion ordered = test::ordered_by(std::move(tree));
  ordered.motion.period = 0.01;
  for (int row = 0; row < 100; ++row) ordered.motion.time.push_back(0.01 * row);
  for (SegmentMotion& segment : ordered.motion.segments)
    segment.angular_velocity = segment.acceleration = std::vector<Vec3>(100, Vec3::Zero());
  return ordered;
}

TEST(OrderReport, AClosingPairDoesNotMakeTheOrderUnsafe) {
  const OrderedMotion ordered = resting(four_bars());
  const OrderReport estimated = report_order(ordered, TreeOrigin::estimated),
                    given = report_order(ordered, TreeOrigin::given);
  EXPECT_NEAR(*estimated.evidence.margin, std::exp(2.0), 1e-9);
  EXPECT_EQ(estimated.findings.size(), 1U);
  EXPECT_NEAR(*given.evidence.margin, std::exp(0.3), 1e-9) << "the user's tree is not searched for loops";
  EXPECT_TRUE(given.findings.empty());
  const auto is_unsafe = [](const OrderReport& report) {
    return std::ranges::find(report.notes, IdentificationNoteKind::unsafe_order, &IdentificationNote::kind) !=
           report.notes.end();
  };
  EXPECT_FALSE(is_unsafe(estimated));
  EXPECT_TRUE(is_unsafe(given));
}

TEST(OrderReport, ListsEveryPairAndTheFindingsAboutGivenLinks) {
  OrderedMotion ordered = resting(four_bars());
  ordered.findings = {{.kind = FindingKind::given_link}};
  const OrderReport report = report_order(ordered, TreeOrigin::estimated);
  ASSERT_EQ(report.evidence.pairs.size(), 6U);
  int joined = 0;
  for (const PairEvidence& pair : report.evidence.pairs) joined += pair.joined ? 1 : 0;
  EXPECT_EQ(joined, 3);
  EXPECT_EQ(report.evidence.pairs[0].second, "s1");
  EXPECT_DOUBLE_EQ(report.evidence.pairs[0].weight, 1.0);
  EXPECT_EQ(report.findings.size(), 2U);
  EXPECT_FALSE(report.evidence.phases_agree) << "nothing moves";
}

}  // namespace
}  // namespace kinfer

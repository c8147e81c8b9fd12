// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/findings/order_evidence.hpp"

#include <gtest/gtest.h>

#include "identify/hand_made_tree.hpp"
#include "kinfer/words/findings/findings.hpp"

namespace kinfer {
using namespace identify;
namespace {

using test::revolute_pair;

/// A chain of four bars whose ends share a revolute joint, too.
SegmentTree four_bars() {
  SegmentTree tree = test::hand_made_tree(4, test::serial_edges(4));
  test::replace_pair(tree, revolute_pair(0, 3, 0.02));
  test::pair_of(tree, 0, 3).distance = 1.3;
  return tree;
}

/// The loop that the first and the last bar close.
LoopEstimate closing_loop() {
  return {.joint = {.parent = "s0", .child = "s3"},
          .segments = {"s0", "s1", "s2", "s3"},
          .gap = 0.002,
          .mirrored_gap = 0.2,
          .log_odds = 40.0};
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
  const OrderReport closed = report_order(ordered, {closing_loop()}), open = report_order(ordered, {});
  EXPECT_NEAR(*closed.evidence.margin, std::exp(2.0), 1e-9);
  EXPECT_NEAR(*open.evidence.margin, std::exp(0.3), 1e-9);
  const auto is_unsafe = [](const OrderReport& report) {
    return std::ranges::find(report.notes, IdentificationNoteKind::unsafe_order, &IdentificationNote::kind) !=
           report.notes.end();
  };
  EXPECT_FALSE(is_unsafe(closed));
  EXPECT_TRUE(is_unsafe(open));
}

TEST(OrderReport, ALoopIsReportedWithItsSegmentsAndBothHalvesOfItsJoint) {
  const OrderReport report = report_order(resting(four_bars()), {closing_loop()});
  ASSERT_EQ(report.findings.size(), 1U);
  const FactValues& values = report.findings[0].values;
  EXPECT_EQ(values.texts("segments"), (std::vector<std::string>{"s0", "s1", "s2", "s3"}));
  EXPECT_EQ(values.text("first") + " " + values.text("second"), "s0 s3");
  EXPECT_TRUE(report.findings[0].applied) << "it is part of the fit";
  EXPECT_NE(words::sentence(report.findings[0]).find("within 2.0 mm"), std::string::npos);
  EXPECT_NE(words::sentence(report.findings[0]).find("them by 200 mm"), std::string::npos);
}

TEST(OrderReport, ListsEveryPairAndTheFindingsAboutGivenLinks) {
  OrderedMotion ordered = resting(four_bars());
  ordered.findings = {{.kind = FindingKind::given_link}};
  const OrderReport report = report_order(ordered, {closing_loop()});
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

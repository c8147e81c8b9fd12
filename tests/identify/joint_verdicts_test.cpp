// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/findings/joint_verdicts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "identify/hand_made_tree.hpp"
#include "identify/measured_segments.hpp"
#include "kinfer/identify/findings/given_links.hpp"

namespace kinfer {
using namespace identify;
namespace {

/// Three segments a-b-c in series with good links; a and c would fit almost as well as b and c.
struct Judged {
  Identification result;
  OrderedMotion ordered;
  std::vector<PairConnection> connections;

  std::vector<JointVerdict> verdicts() const { return joint_verdicts(result, ordered, connections); }
};

Judged three_segments() {
  Judged judged;
  judged.ordered.motion =
      test::recorded_motion({test::measured_segment("a", test::at_rest()), test::measured_segment("b", test::at_rest()),
                             test::measured_segment("c", test::at_rest())});
  SegmentTree& tree = judged.ordered.tree;
  tree.root = 0;
  tree.order = {0, 1, 2};
  tree.parent = {std::nullopt, 0, 1};
  tree.pairs = {{.first = 0, .second = 1, .distance = -9.0},
                {.first = 0, .second = 2, .distance = 0.0},
                {.first = 1, .second = 2, .distance = -8.0}};
  judged.result.joints = {{.parent = "a", .child = "b"}, {.parent = "b", .child = "c"}};
  judged.result.forecast = {{.joint = "a-b", .is_sufficient = true}, {.joint = "b-c", .is_sufficient = true}};
  const JointConnection strong{.force_gain = 12.0, .residual = 0.02, .shifted_residual = 1.0};
  judged.connections = {{.parent = 0, .child = 1, .whole = strong}, {.parent = 1, .child = 2, .whole = strong}};
  return judged;
}

TEST(JointVerdicts, WithoutDoubtsEveryJointMayBeUsed) {
  for (const JointVerdict& verdict : three_segments().verdicts()) {
    EXPECT_EQ(verdict.usability, JointUsability::use) << verdict.joint;
    EXPECT_TRUE(verdict.doubts.empty());
    EXPECT_EQ(verdict.connection.force_gain, 12.0);
  }
}

TEST(JointVerdicts, EachDoubtConcernsItsJointAlone) {
  struct Doubtful {
    JointDoubtKind kind;
    JointUsability usability;
    void (*spoil)(Judged&);
  };
  const std::vector<Doubtful> all{
      {JointDoubtKind::not_connected, JointUsability::do_not_use,
       [](Judged& j) { j.connections[1].whole = {.force_gain = 0.2, .residual = 2.0, .shifted_residual = 2.0}; }},
      {JointDoubtKind::weakly_connected, JointUsability::use_with_care,
       [](Judged& j) { j.connections[1].whole = {.force_gain = 3.0, .residual = 1.0, .shifted_residual = 2.0}; }},
      {JointDoubtKind::changed, JointUsability::do_not_use,
       [](Judged& j) {
         j.connections[1].halves = {{0.0, 9.0, {.force_gain = 16.0}, -10.0}, {9.0, 18.0, {.force_gain = 17.0}, -9.0}};
       }},
      {JointDoubtKind::beyond_reach, JointUsability::do_not_use,
       [](Judged& j) { j.result.joints[1].point_in_child = Vec3(0.0, 65.0, 0.0); }},
      {JointDoubtKind::not_moved, JointUsability::unknown,
       [](Judged& j) { j.result.joints[1].type = EstimatedJointType::rigid; }},
      {JointDoubtKind::undetermined, JointUsability::unknown,
       [](Judged& j) {
         j.result.forecast[1].line_sd = std::numeric_limits<double>::infinity();
         j.result.forecast[1].is_sufficient = false;
       }},
      {JointDoubtKind::unsafe_order, JointUsability::use_with_care,
       [](Judged& j) { j.ordered.tree.pairs[1].distance = -7.8; }},
      {JointDoubtKind::unexplained_motion, JointUsability::use_with_care,
       [](Judged& j) {
         j.result.notes = {{IdentificationNoteKind::unexplained_motion,
                            {{"sensor", "c"}, {"force_ratio", 4.0}, {"rate_ratio", 12.0}, {"force_noise", 0.1}}}};
       }},
      {JointDoubtKind::uncertain_type, JointUsability::use_with_care,
       [](Judged& j) {
         j.result.joints[1].type_probabilities = {{.of_type = {0.72, 0.0, 0.279, 0.001, 0.0}}};
       }},
      {JointDoubtKind::inaccurate, JointUsability::use_with_care,
       [](Judged& j) { j.result.forecast[1].is_sufficient = false; }}};
  for (const Doubtful& doubtful : all) {
    Judged judged = three_segments();
    doubtful.spoil(judged);
    const auto verdicts = judged.verdicts();
    EXPECT_EQ(verdicts[0].usability, JointUsability::use) << name(doubtful.kind);
    ASSERT_EQ(verdicts[1].doubts.size(), 1U) << name(doubtful.kind);
    EXPECT_EQ(verdicts[1].doubts[0].kind, doubtful.kind) << name(verdicts[1].doubts[0].kind);
    EXPECT_EQ(verdicts[1].usability, doubtful.usability) << name(doubtful.kind);
  }
}

TEST(JointVerdicts, NoJointIsSimplyUsableWhereTheFitFailed) {
  Judged judged = three_segments();
  judged.result.notes = {{IdentificationNoteKind::refinement_failed, {{"reason", std::string("no covariance")}}}};
  for (const JointVerdict& verdict : judged.verdicts()) {
    ASSERT_EQ(verdict.doubts.size(), 1U);
    EXPECT_EQ(verdict.doubts[0].kind, JointDoubtKind::not_fitted);
    EXPECT_EQ(verdict.usability, JointUsability::use_with_care);
  }
}

TEST(JointVerdicts, AnUncertainTypeNamesTheTypesThatArePossible) {
  Judged judged = three_segments();
  judged.result.joints[0].type_probabilities = {{.of_type = {0.96, 0.0, 0.04, 0.0, 0.0}}};
  judged.result.joints[1].type_probabilities = {{.of_type = {0.28, 0.0, 0.72, 0.0, 0.0}}};
  judged.result.joints[1].type = EstimatedJointType::universal;
  const auto verdicts = judged.verdicts();
  EXPECT_EQ(verdicts[0].usability, JointUsability::use);
  ASSERT_EQ(verdicts[1].doubts.size(), 1U);
  EXPECT_EQ(verdicts[1].doubts[0].values.texts("types"), (std::vector<std::string>{"universal", "revolute"}));
  EXPECT_EQ(verdicts[1].doubts[0].values.numbers("probabilities"), (std::vector{0.72, 0.28}));
}

TEST(JointVerdicts, AWeakConnectionInAnUnsafeOrderForbidsUse) {
  Judged judged = three_segments();
  judged.connections[1].whole = {.force_gain = 3.0, .residual = 1.0, .shifted_residual = 2.0};
  judged.ordered.tree.pairs[1].distance = -7.8;
  EXPECT_EQ(judged.verdicts()[1].usability, JointUsability::do_not_use);
}

TEST(JointVerdicts, UnobservableDirectionsAreNoReach) {
  Judged judged = three_segments();
  judged.result.joints[0].point_in_parent = Vec3(0.0, 0.0, 90.0);
  judged.result.joints[0].unobservable_in_parent = {Vec3::UnitZ()};
  EXPECT_EQ(judged.verdicts()[0].usability, JointUsability::use);
}

TEST(JointVerdicts, OfAnUnconnectedJointNothingIsKnown) {
  Judged judged = three_segments();
  judged.connections[1].whole = {.force_gain = 0.2, .residual = 2.0, .shifted_residual = 2.0};
  judged.result.links = {{"b", "a-b", "b-c", 0.5, 0.001}};
  judged.result.dh = {{"b", {}, {}, "", "", ""}, {"c", {}, {}, "", "", ""}};
  judged.result.verdicts = judged.verdicts();
  withdraw_unconnected(judged.result);
  const auto& joints = judged.result.joints;
  EXPECT_TRUE(is_point_known(joints[0].sd.point_in_child, {}));
  EXPECT_FALSE(is_point_known(joints[1].sd.point_in_child, {}));
  EXPECT_FALSE(is_axis_known(joints[1], joints[1].sd.axis_in_parent));
  EXPECT_EQ(judged.result.forecast.size(), 1U);
  EXPECT_TRUE(judged.result.links.empty());
  EXPECT_TRUE(std::isinf(judged.result.dh[1].sd.a));
  EXPECT_EQ(judged.result.dh[0].sd.a, 0.0);
}

TEST(KnownPoint, IsOneThatSomeDirectionDetermines) {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  EXPECT_TRUE(is_point_known({1e-3, 0.9}, {}));
  EXPECT_FALSE(is_point_known({0.8, 0.9}, {}));
  EXPECT_TRUE(is_point_known({0.8, 0.9}, {x})) << "both directions across the axis contain the unobservable one";
  EXPECT_FALSE(is_point_known({1e-3, 1e-3}, {x, y, z}));
}

Identification with_residual(double rms) {
  Identification result;
  result.motion.held_out = {{1.0, 2.0}};
  result.motion.traces = {{.sensor = "b", .quantity = TraceQuantity::acceleration, .rms_holdout = rms}};
  result.findings = {{.kind = FindingKind::given_link, .severity = Severity::fault, .values = {{"link", "a-b"}}}};
  return result;
}

TEST(GivenLinks, AreWrongOnlyIfTheWholeChainPredictsWorse) {
  const Identification estimated = with_residual(0.05);
  Identification wrong = with_residual(0.5), as_good = with_residual(0.06);
  EXPECT_TRUE(contradicts_given_links(wrong));
  weigh_given_links(wrong, estimated), weigh_given_links(as_good, estimated);
  EXPECT_TRUE(contradicts_given_links(wrong));
  EXPECT_FALSE(contradicts_given_links(as_good));
  EXPECT_EQ(as_good.findings[0].severity, Severity::note);
}

TEST(GivenLinks, AreComparedBySensorsThatBothChainsHave) {
  Identification given = with_residual(0.06), with_another = with_residual(0.6);
  for (Identification* all : {&given, &with_another})
    all->motion.traces.push_back({.sensor = "c", .quantity = TraceQuantity::acceleration, .rms_holdout = 8.0});
  weigh_given_links(given, with_residual(0.05)), weigh_given_links(with_another, with_residual(0.05));
  EXPECT_FALSE(contradicts_given_links(given)) << "the free chain has no sensor c";
  EXPECT_TRUE(contradicts_given_links(with_another));
}

}  // namespace
}  // namespace kinfer

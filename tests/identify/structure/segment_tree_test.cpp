// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/structure/segment_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "identify/hand_made_tree.hpp"
#include "identify/measured_segments.hpp"
#include "kinfer/identify/structure/given_tree.hpp"
#include "kinfer/words/findings/findings.hpp"

namespace kinfer {
using namespace identify;
namespace {

using test::Edges;

/// Two limbs behind segment 1: 0-1, 1-2, 1-3, 3-4.
const Edges two_limbs{{0, 1}, {1, 2}, {1, 3}, {3, 4}};

std::set<std::pair<std::size_t, std::size_t>> without_direction(const Edges& edges) {
  std::set<std::pair<std::size_t, std::size_t>> all;
  for (const auto& [a, b] : edges) all.insert({std::min(a, b), std::max(a, b)});
  return all;
}

TEST(SegmentTree, HasParentsBeforeChildrenWhateverItsRoot) {
  for (std::size_t root = 0; root < 5; ++root) {
    const SegmentTree tree = test::hand_made_tree(5, two_limbs, root);
    ASSERT_EQ(tree.order.size(), 5U);
    EXPECT_EQ(tree.order.front(), root);
    EXPECT_FALSE(tree.parent[root]);
    for (std::size_t i = 1; i < 5; ++i) {
      const auto parent = std::ranges::find(tree.order, *tree.parent[tree.order[i]]);
      EXPECT_LT(parent - tree.order.begin(), static_cast<std::ptrdiff_t>(i)) << root;
    }
  }
}

TEST(SegmentTree, ThePathBetweenTwoSegmentsDoesNotDependOnTheRoot) {
  for (std::size_t root = 0; root < 5; ++root) {
    const SegmentTree tree = test::hand_made_tree(5, two_limbs, root);
    EXPECT_EQ(without_direction(path_between(tree, 2, 4)), without_direction({{1, 2}, {1, 3}, {3, 4}}));
    EXPECT_EQ(without_direction(path_between(tree, 4, 0)), without_direction({{0, 1}, {1, 3}, {3, 4}}));
    EXPECT_TRUE(path_between(tree, 3, 3).empty());
    for (std::size_t a = 0; a < 5; ++a)
      for (std::size_t b = 0; b < 5; ++b) {
        EXPECT_EQ(without_direction(path_between(tree, a, b)), without_direction(path_between(tree, b, a)));
        EXPECT_EQ(is_edge(tree, a, b), path_between(tree, a, b).size() == 1);
      }
  }
}

TEST(SegmentTree, TheMarginIsTheSmallestGapToALinkThatCouldBeReplaced) {
  for (std::size_t root = 0; root < 5; ++root) {
    SegmentTree tree = test::hand_made_tree(5, two_limbs, root);
    test::pair_of(tree, 3, 4).distance = 1.5;
    test::pair_of(tree, 2, 4).distance = 2.0;
    EXPECT_DOUBLE_EQ(margin_of(tree), std::exp(0.5));
    EXPECT_DOUBLE_EQ(margin_of(tree, {tree.pair(2, 4)}), std::exp(1.5)) << "a pair that closes a loop does not count";
    EXPECT_TRUE(std::isinf(margin_of(tree, tree.pairs)));
  }
  EXPECT_TRUE(std::isinf(margin_of(test::hand_made_tree(2, {{0, 1}})))) << "two segments have one tree only";
}

TEST(SegmentTree, APairIsFoundInEitherOrder) {
  const SegmentTree tree = test::hand_made_tree(4, test::serial_edges(4));
  EXPECT_EQ(&tree.pair(1, 3), &tree.pair(3, 1));
  EXPECT_EQ(tree.pair(3, 1).first, 1U);
}

std::set<std::string> named_edges(const SegmentTree& tree, const RecordedMotion& motion) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < tree.parent.size(); ++i)
    if (tree.parent[i]) names.insert(motion.segments[*tree.parent[i]].name + motion.segments[i].name);
  return names;
}

RecordedMotion four_segments() {
  return test::serial_machine(test::freely_moving(), 4, test::general_hinge());
}

TEST(SegmentTree, OfASerialMachineIsFoundInAnyOrderOfItsSensors) {
  const std::set<std::string> truth{"ab", "bc", "cd"};
  const RecordedMotion sorted = four_segments();
  const auto reference = segment_tree(sorted, "a");
  ASSERT_TRUE(reference);
  EXPECT_EQ(named_edges(*reference, sorted), truth);
  RecordedMotion shuffled = sorted;
  for (const auto& order : {std::array<std::size_t, 4>{3, 2, 1, 0}, {1, 3, 0, 2}}) {
    for (std::size_t i = 0; i < 4; ++i) shuffled.segments[i] = sorted.segments[order[i]];
    const auto tree = segment_tree(shuffled, "a");
    ASSERT_TRUE(tree);
    EXPECT_EQ(named_edges(*tree, shuffled), truth);
    EXPECT_NEAR(std::log(tree->margin), std::log(reference->margin), 0.05 * std::log(reference->margin));
  }
}

TEST(SegmentTree, DoesNotDependOnNorthOrOnTheStartOfTheClock) {
  RecordedMotion motion = four_segments();
  const auto reference = segment_tree(motion, "a");
  for (SegmentMotion& segment : motion.segments) test::rotate_world(segment, 2.0);
  for (double& t : motion.time) t += 1e4;
  const auto moved = segment_tree(motion, "a");
  ASSERT_TRUE(reference && moved);
  EXPECT_EQ(named_edges(*moved, motion), named_edges(*reference, motion));
  for (std::size_t i = 0; i < reference->pairs.size(); ++i)
    EXPECT_NEAR(moved->pairs[i].distance, reference->pairs[i].distance, 0.02) << i;
}

TEST(SegmentTree, TheRootIsTheNamedTheStationaryOrTheCalmestEndSegment) {
  RecordedMotion motion = four_segments();
  EXPECT_EQ(segment_tree(motion, "c")->root, 2U);
  const auto rms = [&](std::size_t i) {
    double sum = 0.0;
    for (const Vec3& w : motion.segments[i].gyro) sum += w.squaredNorm();
    return sum;
  };
  EXPECT_EQ(segment_tree(motion)->root, rms(0) < rms(3) ? 0U : 3U);
  motion.segments[1].still = true;
  EXPECT_EQ(segment_tree(motion)->root, 1U);
  EXPECT_EQ(segment_tree(motion, "d")->root, 3U) << "the user decides";
}

TEST(SegmentTree, WhatCannotBeOrderedIsAnErrorThatSaysWhatToDo) {
  RecordedMotion motion = four_segments();
  EXPECT_EQ(segment_tree(motion, "x").error().what, "--root x: no such sensor; the log has a, b, c, d");
  motion.segments[0].still = motion.segments[2].still = true;
  EXPECT_NE(segment_tree(motion).error().what.find("sensors a, c never move"), std::string::npos);
  motion.segments[0].still = motion.segments[2].still = false;
  for (std::size_t row = 40; row < motion.rows(); ++row) motion.usable[row] = false;
  EXPECT_NE(segment_tree(motion).error().what.find("only 40 rows in which the machine moves"), std::string::npos);
}

const std::vector<std::string> letters{"a", "b", "c", "d"};

TEST(GivenTree, KeepsTheRootAndTakesTheLinksInAnyOrder) {
  const SegmentTree found = test::hand_made_tree(4, test::serial_edges(4), 1);
  const auto tree = given_tree(found, letters, {{"d", "a"}, {"b", "a"}, {"c", "b"}});
  ASSERT_TRUE(tree);
  EXPECT_EQ(tree->root, 1U);
  EXPECT_EQ(tree->parent[0], 1U);
  EXPECT_EQ(tree->parent[2], 1U);
  EXPECT_EQ(tree->parent[3], 0U);
}

TEST(GivenTree, WhatIsNoTreeOfAllSensorsIsAnError) {
  const SegmentTree found = test::hand_made_tree(4, test::serial_edges(4));
  const auto refused = [&](const std::vector<GivenLink>& links) {
    return given_tree(found, letters, links).error().what;
  };
  EXPECT_EQ(refused({{"a", "e"}}), "--tree e: no such sensor; the log has a, b, c, d");
  EXPECT_EQ(refused({{"a", "a"}}), "--tree a-a: a link needs two sensors");
  EXPECT_EQ(refused({{"a", "b"}, {"b", "c"}}), "--tree: 2 links given; 4 sensors need 3");
  EXPECT_EQ(refused({{"a", "b"}, {"b", "c"}, {"c", "a"}}),
            "--tree: the links form a loop and do not connect all of a, b, c, d");
}

TEST(GivenTree, ALinkThatTheRecordingContradictsIsAFaultAndOneThatFitsAsWellANote) {
  SegmentTree found = test::hand_made_tree(4, test::serial_edges(4));
  EXPECT_TRUE(findings_about(found, found, letters).empty());
  SegmentTree given = found;
  orient_tree(given, {{0, 1}, {0, 2}, {2, 3}});  // 0-2 instead of 1-2
  for (const double gap : {0.5, 0.9}) {
    for (SegmentTree* tree : {&found, &given}) {
      test::pair_of(*tree, 1, 2).distance = 1.2;
      test::pair_of(*tree, 0, 2).distance = 1.2 + gap;
    }
    const std::vector<Finding> findings = findings_about(given, found, letters);
    ASSERT_EQ(findings.size(), 1U);
    EXPECT_EQ(findings[0].kind, FindingKind::given_link);
    EXPECT_EQ(findings[0].severity, gap > 0.7 ? Severity::fault : Severity::note) << gap;
    EXPECT_EQ(findings[0].values.text("link"), "a-c");
    EXPECT_EQ(findings[0].values.text("replaced_link"), "b-c") << "the worst link of the path that it closes";
    EXPECT_NEAR(findings[0].values.number("ratio"), std::exp(gap), 1e-12);
    EXPECT_NE(words::sentence(findings[0]).find("a-c"), std::string::npos);
  }
}

}  // namespace
}  // namespace kinfer

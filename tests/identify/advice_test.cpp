// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/findings/advice.hpp"

#include <gmock/gmock.h>

#include "kinfer/identify/findings/order_evidence.hpp"
#include "kinfer/words/identification/advice.hpp"

namespace kinfer {
using namespace identify;
namespace {

using enum IdentificationAdviceKind;

std::vector<IdentificationAdviceKind> kinds(const Identification& result) {
  std::vector<IdentificationAdviceKind> list;
  for (const IdentificationAdvice& advice : identification_advice(result)) list.push_back(advice.kind);
  return list;
}

Identification chain_of_two() {
  Identification result;
  result.joints = {{.parent = "a", .child = "b"}, {.parent = "b", .child = "c"}};
  result.order.margin = 5.0;
  return result;
}

TEST(Advice, OfAJointWithAnUnknownAxisSaysSo) {
  Identification result;
  result.forecast = {{.joint = "a-b",
                      .line_sd = std::numeric_limits<double>::infinity(),
                      .acceleration_factor = std::numeric_limits<double>::infinity(),
                      .time_factor = std::numeric_limits<double>::infinity(),
                      .more_excitation_suffices = false}};
  const auto advice = identification_advice(result);
  const auto found = std::ranges::find(advice, IdentificationAdviceKind::check_mounts, &IdentificationAdvice::kind);
  ASSERT_NE(found, advice.end());
  EXPECT_EQ(words::advice_text(*found).why, "the recording does not determine where its axis is");
}

TEST(Advice, OfASoundResultIsToUseItAndToMeasureTheToolAtTheEnd) {
  const Identification result = chain_of_two();
  EXPECT_THAT(kinds(result), testing::ElementsAre(use_chain, measure_tool));
  EXPECT_EQ(identification_advice(result).back().values.text("sensor"), "c");
}

TEST(Advice, AnUnsafeOrderComesFirstAndNoMarginIsSafe) {
  Identification result = chain_of_two();
  result.order.margin = 1.5;
  EXPECT_EQ(kinds(result).front(), move_in_sequence);
  result.order.margin.reset();
  EXPECT_EQ(kinds(result).front(), use_chain);
}

TEST(Advice, AFaultIsNotToBeUsed) {
  Identification result = chain_of_two();
  result.usability = Usability::do_not_use;
  EXPECT_THAT(kinds(result), testing::Not(testing::Contains(use_chain)));
}

TEST(Advice, AnInaccurateJointIsToBeMovedFurtherUnlessThatIsHopeless) {
  Identification result = chain_of_two();
  result.forecast = {{.joint = "a-b", .line_sd = 0.01, .acceleration_factor = 3.9, .time_factor = 15.2},
                     {.joint = "b-c", .line_sd = 0.1, .more_excitation_suffices = false}};
  EXPECT_THAT(kinds(result), testing::ElementsAre(use_chain, move_further, check_mounts, measure_tool));
  const auto texts = words::advice_texts(identification_advice(result));
  EXPECT_EQ(texts[1].what, "Move a-b further and faster: 3.9 times the acceleration, or 15.2 times as long");
  EXPECT_EQ(texts[2].why, "its line is known to 100.0 mm and its direction to 0.0 mrad only");
}

TEST(Advice, WhatLevelGroundDoesNotTellIsListedInOneSentence) {
  Identification result = chain_of_two();
  result.joints[0].azimuth_unobservable = true;
  result.joints[0].unobservable_in_parent = {Vec3::UnitX()};
  result.forecast = {
      {.joint = "b-c", .azimuth_of = "b", .azimuth_sd = 0.011, .azimuth_is_uncertain = true, .is_sufficient = true}};
  const auto list = identification_advice(result);
  ASSERT_EQ(list[1].kind, record_on_slope);
  EXPECT_EQ(
      words::advice_text(list[1]).why,
      "unobservable on level ground: the azimuth of b about the axis, and the azimuth of b about its only axis (± 11 "
      "mrad), and positions in a; the joints beyond do not need it");
}

/// Two segments at rest, joined.
OrderedMotion pair_at_rest() {
  OrderedMotion ordered;
  ordered.motion.period = 0.01;
  for (int row = 0; row < 100; ++row) ordered.motion.time.push_back(0.01 * row);
  const std::vector<Vec3> zero(100, Vec3::Zero());
  for (const char* name : {"a", "b"})
    ordered.motion.segments.push_back({.name = name,
                                       .rotation = std::vector<Mat3>(100, Mat3::Identity()),
                                       .gyro = zero,
                                       .angular_velocity = zero,
                                       .angular_acceleration = zero,
                                       .acceleration = zero});
  ordered.motion.usable.assign(100, true);
  ordered.tree.pairs = {{.first = 0, .second = 1}};
  orient_tree(ordered.tree, {{0, 1}});
  return ordered;
}

TEST(OrderEvidence, OfTwoSensorsHasNoMarginBecauseThereIsNoOtherTree) {
  const OrderReport report = report_order(pair_at_rest(), {});
  EXPECT_FALSE(report.evidence.margin);
  ASSERT_EQ(report.evidence.pairs.size(), 1U);
  EXPECT_TRUE(report.evidence.pairs[0].joined);
  for (const IdentificationNote& note : report.notes) EXPECT_NE(note.kind, IdentificationNoteKind::unsafe_order);
}

}  // namespace
}  // namespace kinfer

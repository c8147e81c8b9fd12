// SPDX-License-Identifier: Apache-2.0
// Facts and the figures that are derived from a result.
#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/evidence/calibration/calibration.hpp"
#include "kinfer/evidence/deployment/compensation.hpp"
#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "support/robots.hpp"

namespace kinfer {
namespace {

TEST(FactValues, KeepTheirOrderAndTheirTypes) {
  FactValues values{{"offset", 0.5}, {"rows", std::vector<int>{1, 2}}, {"sensor", std::string("ins1")}};
  values.set("count", 3);
  values.set("offset", -0.25);
  std::string order;
  for (const auto& [name, value] : values) order += name + " ";
  EXPECT_EQ(order, "offset rows sensor count ") << "a new value of an old name stays in its place";
  EXPECT_EQ(values.number("offset"), -0.25);
  EXPECT_EQ(values.count("count"), 3);
  EXPECT_EQ(values.counts("rows"), (std::vector{1, 2}));
  EXPECT_EQ(values.text("sensor"), "ins1");
  EXPECT_TRUE(values.has("rows"));
  EXPECT_FALSE(values.has("row"));
  EXPECT_FALSE(values.empty());
  EXPECT_TRUE(FactValues{}.empty());
}

TEST(FactValues, AreEqualIfNamesOrderAndValuesAre) {
  const FactValues one{{"a", 1.0}, {"b", 2}};
  EXPECT_EQ(one, (FactValues{{"a", 1.0}, {"b", 2}}));
  EXPECT_NE(one, (FactValues{{"b", 2}, {"a", 1.0}}));
  EXPECT_NE(one, (FactValues{{"a", 1.0}, {"b", 2.0}})) << "a number is no count";
}

TEST(FactValuesDeathTest, AMissingValueOrAnotherTypeIsAProgrammingError) {
  const FactValues values{{"offset", 0.5}};
  EXPECT_DEATH(values.number("drift"), "no value \"drift\"");
  EXPECT_DEATH(values.count("offset"), "no value \"offset\" of this type");
}

TEST(ErrorStatistics, AreThoseOfTheDefinitions) {
  const std::vector<double> errors{1.0, 2.0, 2.0, 3.0};
  const ErrorStatistics s = error_statistics(errors);
  EXPECT_DOUBLE_EQ(s.mean, 2.0);
  EXPECT_DOUBLE_EQ(s.rms, std::sqrt(18.0 / 4.0));
  EXPECT_DOUBLE_EQ(s.sd, std::sqrt(2.0 / 3.0));
  EXPECT_EQ(s.max, 3.0);
  EXPECT_EQ(s.n, 4);
  EXPECT_EQ(error_statistics({}).n, 0);
  EXPECT_EQ(error_statistics(std::vector{0.5}).sd, 0.0) << "one value has no scatter";
}

ErrorStatistics with_rms(double rms, int n = 10) {
  return {.rms = rms, .n = n};
}

TEST(ReportedErrors, AreOfHeldOutLengthsWhereThereAreSome) {
  Calibration c;
  c.after.orientation.train = with_rms(0.01);
  c.after.orientation.holdout = with_rms(0.02);
  EXPECT_FALSE(has_lengths(c));
  EXPECT_EQ(reported_errors(c, c.after).rms, 0.02);
  EXPECT_EQ(final_errors(c).rms, 0.01);
  c.after.position.train = with_rms(1e-4);
  EXPECT_TRUE(has_lengths(c));
  EXPECT_EQ(reported_errors(c, c.after).rms, 1e-4) << "no rows are held out";
  c.after.position.holdout = with_rms(2e-4);
  EXPECT_EQ(reported_errors(c, c.after).rms, 2e-4);
  EXPECT_EQ(final_errors(c).rms, 1e-4);
}

TEST(AccuracyStatistics, RepeatabilityIsOfRepeatedPosesOnly) {
  const std::vector<PoseAccuracy> poses{
      {.rows = {0}, .accuracy_before = 3e-3, .accuracy_after = 1e-4, .repeatability = {}},
      {.rows = {1, 2}, .accuracy_before = 1e-3, .accuracy_after = 3e-4, .repeatability = 5e-5}};
  const AccuracyStatistics s = accuracy_statistics(poses);
  EXPECT_DOUBLE_EQ(s.before.mean, 2e-3);
  EXPECT_DOUBLE_EQ(s.after.max, 3e-4);
  EXPECT_EQ(s.repeatability.n, 1);
  EXPECT_EQ(accuracy_statistics({}).before.n, 0);
}

TEST(CorrectedChain, HasTheSamePosesWithItsSmallRotationsFolded) {
  Calibration c;
  c.estimate.chain = test::nominal_robot();
  c.estimate.chain.base.small_rotation = Vec3(0.01, -0.02, 0.03);
  c.estimate.chain.tool.small_rotation = Vec3(-0.1, 0.05, 0.2);
  const Chain folded = corrected_chain(c);
  EXPECT_EQ(folded.base.small_rotation.norm() + folded.tool.small_rotation.norm(), 0.0);
  VectorXd q(6);
  q << 0.3, -0.5, 0.7, 1.0, -0.2, 0.4;
  const Pose before = forward(c.estimate.chain, q), after = forward(folded, q);
  EXPECT_LT((before.rotation - after.rotation).norm() + (before.position - after.position).norm(), 1e-12);
}

TEST(CompensationSummary, CountsWhatWasNotReached) {
  std::vector<CompensatedJoints> rows(3);
  rows[0].residual = 1e-9;
  rows[1].residual = 2e-3;
  rows[1].status = rows[2].status = InverseStatus::unreachable;
  const CompensationSummary summary = summarise(rows);
  EXPECT_EQ(summary.rows, 3);
  EXPECT_EQ(summary.unreached, (std::vector{1, 2}));
  EXPECT_EQ(summary.worst_residual, 2e-3);
  EXPECT_EQ(summarise({}).rows, 0);
}

TEST(ModelSelection, SelectedTermsWereTested) {
  ModelSelection selection;
  selection.steps.emplace_back();
  for (int d = 0; d <= static_cast<int>(Decision::data_missing); ++d) {
    const SelectionStep step{.term = Term::gain, .decision = static_cast<Decision>(d)};
    EXPECT_TRUE(!is_selected(step) || was_tested(step)) << name(step.decision);
    selection.steps.push_back(step);
  }
  EXPECT_EQ(selected_terms(selection).size(), 3U) << "of the start, accepted and requested; the geometry is no term";
  EXPECT_EQ(name(selection.steps[0]), "geometry");
}

TEST(Finding, OnlyAnUncorrectedFaultInvalidatesTheResult) {
  for (const Severity severity : {Severity::note, Severity::warning, Severity::fault})
    for (const bool applied : {false, true}) {
      const Finding finding{.kind = FindingKind::clock, .severity = severity, .applied = applied};
      EXPECT_EQ(invalidates_result(finding), severity == Severity::fault && !applied) << name(severity);
    }
}

TEST(JointForecast, OneInsufficientJointIsEnough) {
  EXPECT_TRUE(all_sufficient({}));
  std::vector<JointForecast> joints(3);
  for (JointForecast& joint : joints) joint.is_sufficient = true;
  EXPECT_TRUE(all_sufficient(joints));
  joints[1].is_sufficient = false;
  EXPECT_FALSE(all_sufficient(joints));
}

TEST(JointName, IsParentAndChild) {
  EXPECT_EQ(joint_name({.parent = "ins1", .child = "ins2"}), "ins1-ins2");
}

}  // namespace
}  // namespace kinfer

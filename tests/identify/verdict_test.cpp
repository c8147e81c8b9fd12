// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/findings/verdict.hpp"

#include <gtest/gtest.h>

#include "kinfer/words/identification/verdict.hpp"

namespace kinfer {
using namespace identify;
namespace {

Finding separated(Severity severity, bool applied) {
  return {.kind = FindingKind::no_joint,
          .severity = severity,
          .values = {{"sensor", "ins7"}, {"link", "ins1-ins7"}, {"residual", 0.5}, {"usual_residual", 0.01}},
          .applied = applied};
}

TEST(Usability, OnlyAnUncorrectedFaultForbidsUse) {
  const std::vector<JointVerdict> accurate{{.joint = "a-b"}};
  for (const Severity severity : {Severity::note, Severity::warning, Severity::fault})
    for (const bool applied : {false, true})
      EXPECT_EQ(usability({separated(severity, applied)}, {}, accurate),
                severity == Severity::fault && !applied ? Usability::do_not_use : Usability::use);
}

TEST(Usability, IsThatOfTheWorstJoint) {
  const JointVerdict good{.joint = "a-b"},
      inaccurate{.joint = "b-c",
                 .usability = JointUsability::use_with_care,
                 .doubts = {{JointDoubtKind::inaccurate, {{"line_sd", 0.1}, {"direction_sd", 0.1}}}}},
      never_moved{.joint = "c-d", .usability = JointUsability::unknown, .doubts = {{JointDoubtKind::not_moved, {}}}},
      wrong{.joint = "d-e",
            .usability = JointUsability::do_not_use,
            .doubts = {{JointDoubtKind::not_connected, {{"gain", 0.1}, {"needed", 5.0}}}}};
  EXPECT_EQ(usability({}, {}, {good, inaccurate}), Usability::use_with_care);
  EXPECT_EQ(usability({}, {}, {good, never_moved}), Usability::use);
  const JointVerdict undetermined{
      .joint = "e-f", .usability = JointUsability::unknown, .doubts = {{JointDoubtKind::undetermined, {}}}};
  EXPECT_EQ(usability({}, {}, {good, undetermined}), Usability::use_with_care);
  EXPECT_EQ(usability({}, {}, {undetermined, undetermined}), Usability::do_not_use);
  EXPECT_EQ(usability({}, {}, {good, inaccurate, wrong}), Usability::do_not_use);
  EXPECT_EQ(usability({}, {}, {never_moved}), Usability::do_not_use) << "nothing was identified";
  EXPECT_EQ(usability({}, {}, {}), Usability::use);
}

TEST(Usability, OfJointsThatAreAllWeaklyConnectedIsNone) {
  const JointVerdict weak{.joint = "a-b",
                          .usability = JointUsability::use_with_care,
                          .doubts = {{JointDoubtKind::weakly_connected, {{"gain", 3.0}, {"needed", 5.0}}}}},
      good{.joint = "b-c"};
  EXPECT_EQ(usability({}, {}, {weak, weak}), Usability::do_not_use);
  EXPECT_EQ(usability({}, {}, {weak, good}), Usability::use_with_care);
}

JointEstimate revolute_with(double probability) {
  JointEstimate joint{.parent = "a", .child = "b"};
  joint.type_probabilities.emplace().of(EstimatedJointType::revolute) = probability;
  joint.type_probabilities->of(EstimatedJointType::spherical) = 1.0 - probability;
  return joint;
}

TEST(Usability, NeedsTheTypesOfAllJointsTogether) {
  const std::vector<JointVerdict> verdicts(3, JointVerdict{.joint = "a-b"});
  EXPECT_EQ(usability({}, std::vector(3, revolute_with(0.99)), verdicts), Usability::use);
  EXPECT_EQ(usability({}, std::vector(3, revolute_with(0.97)), verdicts), Usability::use_with_care);
}

MotionEvidence motion_of_two_sensors() {
  MotionEvidence motion;
  motion.traces = {{.sensor = "a", .rms_fitted = 0.1, .rms_holdout = 0.3},
                   {.sensor = "a", .quantity = TraceQuantity::angular_velocity, .rms_fitted = 9.0, .rms_holdout = 9.0},
                   {.sensor = "b", .rms_fitted = 0.2, .rms_holdout = 0.25}};
  return motion;
}

TEST(PredictionSummary, IsOfTheWorstAccelerationInTheHeldOutWindowsIfThereAreAny) {
  MotionEvidence motion = motion_of_two_sensors();
  EXPECT_DOUBLE_EQ(summarise_prediction(motion).worst_acceleration, 0.2);
  EXPECT_DOUBLE_EQ(summarise_prediction(motion).held_out_seconds, 0.0);
  motion.held_out = {{1.0, 2.5}, {4.0, 5.0}};
  EXPECT_DOUBLE_EQ(summarise_prediction(motion).worst_acceleration, 0.3);
  EXPECT_DOUBLE_EQ(summarise_prediction(motion).held_out_seconds, 2.5);
}

Identification two_joints() {
  Identification result;
  result.joints = {{.parent = "a", .child = "b"}, {.parent = "b", .child = "c", .type = EstimatedJointType::rigid}};
  result.forecast = {{.joint = "a-b", .line_sd = 7e-4, .direction_sd = 2.4e-4, .is_sufficient = true}};
  result.prediction = {.held_out_seconds = 11.0, .worst_acceleration = 0.0123};
  return result;
}

TEST(IdentificationVerdict, SaysAccuracyForecastAndPrediction) {
  EXPECT_EQ(
      words::identification_verdict(two_joints()),
      "Use it: 2 joints found, 1 of them never moved, their axes to ± 0.7 mm and ± 0.24 mrad, enough for 5 mm and 3 "
      "mrad in every joint; accelerations in 11.0 s that it was not fitted to are predicted to 0.012 m/s² rms at "
      "worst");
}

TEST(IdentificationVerdict, PutsAFaultFirstAndAWarningLast) {
  Identification result = two_joints();
  result.usability = Usability::use_with_care;
  result.findings = {separated(Severity::warning, true), separated(Severity::note, false)};
  const std::string warned = words::identification_verdict(result);
  EXPECT_TRUE(warned.starts_with("Use with care: 2 joints"));
  EXPECT_TRUE(warned.ends_with("it is left out"));
  EXPECT_EQ(warned.find("ins7 shares"), warned.rfind("ins7 shares")) << "a note is not part of the verdict";
  result.findings = {separated(Severity::fault, false)};
  result.usability = usability(result.findings, result.joints, result.verdicts);
  EXPECT_TRUE(words::identification_verdict(result).starts_with("Do not use as it is: ins7 shares no joint"));
}

LinkEvidence searched_link(const std::string& segment, double holdout, double written) {
  LinkEvidence link;
  link.segment = segment;
  link.holdout.total = holdout;
  link.written_holdout.emplace().total = written;
  return link;
}

TEST(IdentificationVerdict, EnumerationCertifiesTheChainThatIsWritten) {
  Identification result = two_joints();
  result.search_method = LinkSearchMethod::enumeration;
  result.searches = {searched_link("ins1", 0.10, 0.09), searched_link("ins2", 0.10, 0.10)};
  EXPECT_TRUE(words::identification_verdict(result).ends_with(
      "; no chain of up to 3 leaves a link predicts the held-out rows better than the one written"));
  result.searches[1].written_holdout->total = 0.112;
  EXPECT_TRUE(words::identification_verdict(result).ends_with("by more than 12 % better than the one written"));
}

}  // namespace
}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
// The verdict as a function of the error statistics, and its words.
#include "kinfer/calibrate/conclusion/verdict.hpp"

#include <gtest/gtest.h>

#include "kinfer/words/calibration/calibration.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

Calibration with_errors(double before, double after, double final_rms) {
  Calibration c;
  c.before.position.holdout = {.mean = before, .rms = before, .max = 2.0 * before, .n = 50};
  c.after.position.holdout = {.mean = after, .rms = after, .max = 2.0 * after, .n = 50};
  c.after.position.train = {.mean = final_rms, .rms = final_rms, .max = final_rms, .n = 50};
  return c;
}

void expect_verdict(Calibration c, CalibrationReason reason, Usability usability, const std::string& words) {
  c.reason = judge(c), c.usability = usability_of(c.reason);
  EXPECT_EQ(c.reason, reason);
  EXPECT_EQ(c.usability, usability);
  EXPECT_NE(words::verdict(c).find(words), std::string::npos) << words::verdict(c);
}

TEST(Verdict, ABetterModelIsUsed) {
  const Calibration c = with_errors(1e-3, 1e-4, 1e-4);
  EXPECT_EQ(judge(c), CalibrationReason::improves_nominal);
  EXPECT_EQ(usability_of(judge(c)), Usability::use);
}

TEST(Verdict, AModelThatIsNoBetterIsNotUsed) {
  EXPECT_EQ(judge(with_errors(1e-3, 1e-3, 1e-4)), CalibrationReason::no_improvement);
  EXPECT_EQ(usability_of(CalibrationReason::no_improvement), Usability::do_not_use);
}

TEST(Verdict, ARefitThatFindsNoMovedOffsetKeepsTheEarlierModel) {
  Calibration c = with_errors(3.2e-5, 3.3e-5, 3.3e-5);
  c.expected_holdout_rms = 3e-5, c.chance_of_improvement = 0.995;
  EXPECT_EQ(judge(c), CalibrationReason::no_improvement) << "of the nominal model";
  c.notes.push_back({CalibrationNoteKind::no_offset_moved});
  expect_verdict(c, CalibrationReason::unchanged, Usability::use, "keep the earlier model");
  c.expected_holdout_rms = 5e-6;
  EXPECT_EQ(judge(c), CalibrationReason::no_improvement) << "the earlier model does not explain the poses";
  c = with_errors(1e-3, 3e-5, 3e-5);
  c.chance_of_improvement = 1e-6;
  c.notes.push_back({CalibrationNoteKind::joint_offset_moved});
  EXPECT_EQ(judge(c), CalibrationReason::improves_nominal);
}

TEST(Verdict, ARobotThatDoesNotMoveIsNotUsed) {
  Calibration c = with_errors(0.3, 1e-6, 1e-6);
  c.least_motion = 1e-5;
  EXPECT_EQ(judge(c), CalibrationReason::collapsed);
  EXPECT_EQ(usability_of(CalibrationReason::collapsed), Usability::do_not_use);
}

TEST(Verdict, AnImprovementThatMayBeChanceIsUsedWithCare) {
  Calibration c = with_errors(8e-3, 6e-3, 6e-3);
  c.chance_of_improvement = 0.04;
  EXPECT_EQ(judge(c), CalibrationReason::improves_nominal);
  c.chance_of_improvement = 0.12;
  c.reason = judge(c), c.usability = usability_of(c.reason);
  EXPECT_EQ(c.reason, CalibrationReason::unproven);
  EXPECT_EQ(c.usability, Usability::use_with_care);
  EXPECT_EQ(words::verdict(c),
            "Use with care: better, but these poses do not prove it: a model that is no better would look as good with "
            "a probability of 12 %: on poses that were not fitted the tool is 6.000 mm off on average and 12.000 mm at "
            "worst (8.000 mm and 16.000 mm before).");
}

TEST(Verdict, ErrorsFarAboveTheInstrumentsNoiseAreUsedWithCare) {
  Calibration c = with_errors(44e-3, 37e-3, 37e-3);
  c.expected_holdout_rms = 20e-3, c.noise_holdout_rms = 14e-3;
  EXPECT_EQ(judge(c), CalibrationReason::improves_nominal);
  c.noise_holdout_rms = 2e-3;
  expect_verdict(c, CalibrationReason::beyond_noise, Usability::use_with_care,
                 "the errors are 18 times what the instrument's noise explains");
}

TEST(Verdict, ErrorsThatNoToleranceOfTheRobotCouldMakeAreNotOfUse) {
  Calibration c = with_errors(1.2, 0.5, 0.5);
  c.expected_holdout_rms = 0.4, c.noise_holdout_rms = 3e-5, c.tolerated_error = 0.6;
  EXPECT_EQ(judge(c), CalibrationReason::beyond_noise);
  c.tolerated_error = 0.03;
  expect_verdict(c, CalibrationReason::beyond_tolerances, Usability::do_not_use,
                 "more than the tolerances of the robot's model could make");
  c.noise_is_stated = false;
  expect_verdict(c, CalibrationReason::unexplained, Usability::use_with_care,
                 "unless the instrument is that inaccurate (state its sigma)");
}

/// The tracker was moved, which is not corrected.
void expect_fault_of_moved_base(Calibration& c) {
  c.findings.push_back({.kind = FindingKind::base_moved,
                        .severity = Severity::fault,
                        .rows = {3, 4, 5, 6, 7},
                        .values = {{"distance_m", 0.076}}});
  expect_verdict(c, CalibrationReason::fault_remains, Usability::do_not_use,
                 "in rows 3-7 the tool is 76.0 mm elsewhere");
}

TEST(Verdict, AFaultThatIsNotCorrectedIsNotOfUse) {
  Calibration c = with_errors(40e-3, 39e-3, 39e-3);
  expect_fault_of_moved_base(c);
  c.findings.front().applied = true;
  EXPECT_EQ(judge(c), CalibrationReason::improves_nominal);
}

TEST(Verdict, ARobotFarFromItsNominalModelIsUsedWithCare) {
  Calibration c = with_errors(0.5, 1e-6, 1e-6);
  c.tolerance_factor = 10.0;
  EXPECT_EQ(judge(c), CalibrationReason::improves_nominal);
  c.tolerance_factor = 1000.0;
  expect_verdict(c, CalibrationReason::far_from_nominal, Usability::use_with_care,
                 "1000 times further from its nominal model");
}

TEST(Verdict, AFinalFitThatConvergedElsewhereIsNotValidated) {
  EXPECT_EQ(judge(with_errors(1e-3, 1e-4, 1.6e-4)), CalibrationReason::not_validated);
  EXPECT_EQ(judge(with_errors(1e-3, 1e-4, 1.4e-4)), CalibrationReason::improves_nominal);
}

TEST(Verdict, ErrorsFarAboveTheExpectedOnesAreNotModelled) {
  Calibration c = with_errors(1e-3, 1e-4, 1e-4);
  c.expected_holdout_rms = 0.3e-4;
  EXPECT_EQ(judge(c), CalibrationReason::unmodelled_effects);
  c.expected_holdout_rms = 0.4e-4;
  EXPECT_EQ(judge(c), CalibrationReason::improves_nominal);
}

TEST(Verdict, ErrorsThatThePredictionsHaveRoomForAreNotModelledEither) {
  Calibration c = with_errors(1e-3, 1e-4, 1e-4);
  c.expected_holdout_rms = 0.35e-4;
  c.predicted_holdout_rms = 0.8e-4;
  EXPECT_EQ(judge(c), CalibrationReason::improves_nominal);
  c.predicted_holdout_rms = 1.4e-4;
  expect_verdict(c, CalibrationReason::unmodelled_effects, Usability::do_not_use, "the errors are 4 times what");
  c.expected_holdout_rms = 0.3e-4;
  c.predicted_holdout_rms = 0.32e-4;
  EXPECT_EQ(judge(c), CalibrationReason::unmodelled_effects) << "the predictions promise too much";
}

TEST(Verdict, WithoutAMeasuredLengthTheSizeIsNotReliedOn) {
  Calibration c = with_errors(1e-3, 1e-4, 1e-4);
  c.unobserved_lengths = {UnobservedLength::size, 5e-4};
  c.usability = usability_of(judge(c), c.unobserved_lengths);
  EXPECT_EQ(c.usability, Usability::use_with_care);
  EXPECT_EQ(usability_of(CalibrationReason::overfitted, c.unobserved_lengths), Usability::do_not_use);
  EXPECT_EQ(words::verdict(c).find("Use with care: "), 0u) << words::verdict(c);
  EXPECT_NE(words::verdict(c).find("; the size of the robot is unobservable, since no length was measured: it rests on "
                                   "the tolerances of the lengths and may be 0.98 mm per metre off (95 %)"),
            std::string::npos)
      << words::verdict(c);
}

TEST(Verdict, WithoutADataSheetHeldOutRowsAreComparedWithFittedOnes) {
  Calibration c = with_errors(0.0, 1e-4, 0.3e-4);
  c.unknown_robot = UnknownRobotEvidence{};
  EXPECT_EQ(judge(c), CalibrationReason::overfitted);
  c.after.position.train.mean = 0.4e-4;
  EXPECT_EQ(judge(c), CalibrationReason::generalises);
  c.after.position.holdout.n = 0;
  EXPECT_EQ(judge(c), CalibrationReason::overfitted) << "nothing was held out";
}

TEST(Verdict, AFaultStandsWithoutADataSheetToo) {
  Calibration c = with_errors(0.0, 1e-4, 1e-4);
  c.unknown_robot = UnknownRobotEvidence{};
  EXPECT_EQ(judge(c), CalibrationReason::generalises);
  c.contradiction = Contradiction{.kind = kind_of<PairDistance>, .contradicted = 15, .measured = 15, .error = 0.1};
  expect_verdict(c, CalibrationReason::contradictory, Usability::do_not_use, "15 of 15 pairwise distances");
  c.contradiction.reset();
  expect_fault_of_moved_base(c);
  EXPECT_EQ(words::verdict(c).find("before"), std::string::npos) << "there is no earlier model: " << words::verdict(c);
  c.findings.front().applied = true;
  EXPECT_EQ(judge(c), CalibrationReason::generalises);
}

TEST(Verdict, OrientationsAreComparedWhereNoLengthWasMeasured) {
  Calibration c;
  c.before.orientation.holdout = {.mean = 1e-2, .rms = 1e-2, .n = 9};
  c.after.orientation.holdout = {.mean = 1e-3, .rms = 1e-3, .n = 9};
  c.after.orientation.train = {.mean = 1e-3, .rms = 1e-3, .n = 9};
  c.measured = kind_of<OrientationMeasurement>;
  EXPECT_EQ(judge(c), CalibrationReason::improves_nominal);
  EXPECT_NE(words::verdict(c).find("the orientation is 0.057 deg off on average"), std::string::npos)
      << words::verdict(c);
}

TEST(VerdictWords, FiguresAreThoseOfTheHeldOutRows) {
  EXPECT_EQ(words::verdict(with_errors(1e-3, 1e-4, 1e-4)),
            "Use it: on poses that were not fitted the tool is 0.100 mm off on average and 0.200 mm at worst (1.000 mm "
            "and 2.000 mm before).");
}

TEST(VerdictWords, ExcludedRowsAreNamed) {
  Calibration c = with_errors(1e-3, 1e-4, 1e-4);
  c.gross_error_rows = {3, 4, 5, 9};
  c.estimate.outliers.resize(5);
  c.after.position.holdout_all_rows.max = 7e-3;
  EXPECT_NE(words::verdict(c).find("; 4 rows are rejected as outliers: rows 3-5 and 9 (7.000 mm at worst with "
                                   "them); the fit gives 1 more row no weight"),
            std::string::npos)
      << words::verdict(c);
}

}  // namespace
}  // namespace kinfer

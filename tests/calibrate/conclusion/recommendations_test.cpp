// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/conclusion/recommendations.hpp"

#include <gtest/gtest.h>

#include "kinfer/calibrate/conclusion/notes.hpp"
#include "kinfer/calibrate/parameters/parameter_sets.hpp"
#include "kinfer/words/calibration/calibration.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

using enum CalibrationAdviceKind;

/// Poses that move every joint by two radians.
CalibrationTask task_with_rows(int rows) {
  CalibrationTask task{.nominal = test::er20()};
  task.data.joint_names = active_joint_names(task.nominal);
  task.data.joints.resize(6, rows);
  Rng rng(1);
  for (double& q : task.data.joints.reshaped()) q = rng.uniform(-1.0, 1.0);
  for (int row = 0; row < rows; ++row) task.data.points.push_back({.row = row, .position = Vec3::Zero(), .sd = {}});
  return task;
}

std::vector<CalibrationAdviceKind> advice_kinds(const CalibrationTask& task, const Calibration& calibration) {
  std::vector<CalibrationAdviceKind> kinds;
  for (const CalibrationAdvice& advice : make_recommendations(task, calibration)) {
    kinds.push_back(advice.kind);
    const auto [what, why] = words::advice(advice);
    EXPECT_FALSE(what.empty() || why.empty()) << name(advice.kind);
  }
  return kinds;
}

using Kinds = std::vector<CalibrationAdviceKind>;

TEST(Recommendations, OfFaultyDataIsToCorrectThemAndNoMore) {
  Calibration c;
  c.reason = CalibrationReason::fault_remains, c.usability = Usability::do_not_use;
  c.findings.push_back({.kind = FindingKind::base_moved, .severity = Severity::fault});
  EXPECT_EQ(advice_kinds(task_with_rows(20), c), (Kinds{correct_data}));
}

TEST(Recommendations, OfASoundCalibrationAreToUseAndToKeepIt) {
  EXPECT_EQ(advice_kinds(task_with_rows(80), {}), (Kinds{use_corrections, keep_verification_poses}));
  Calibration refused;
  refused.usability = Usability::do_not_use;
  EXPECT_EQ(advice_kinds(task_with_rows(80), refused), (Kinds{keep_verification_poses}));
}

TEST(Recommendations, ComeInTheOrderOfTheirUse) {
  Calibration c;
  c.estimate.chi2_per_n = 9.0;
  c.estimate.outliers.resize(2);
  c.estimate.predicted_error = 1e-4;
  c.plot_data.workspace.resize(1);
  c.plot_data.workspace[0].joints = VectorXd::Constant(6, 0.5);
  c.plot_data.workspace[0].predicted = 4e-4;
  CalibrationTask task = task_with_rows(25);
  task.data.joints.row(3) *= 0.1;
  EXPECT_EQ(advice_kinds(task, c), (Kinds{use_corrections, check_model, check_outliers, extend_joint_range,
                                          measure_uncertain_region, measure_more_poses, keep_verification_poses}));
  const auto list = make_recommendations(task, c);
  EXPECT_DOUBLE_EQ(list[1].values.number("residual_ratio"), 3.0);
  EXPECT_EQ(list[2].values.count("rows"), 2);
  EXPECT_EQ(list[3].values.text("joint"), "J4");
  EXPECT_LT(list[3].values.number("range_rad"), 0.2);
  EXPECT_EQ(list[4].values.numbers("positions"), std::vector<double>(6, 0.5));
  EXPECT_EQ(list[5].values.count("more"), 35);
}

TEST(Recommendations, AreMadeOnTheRightSideOfTheirThresholds) {
  Calibration c;
  c.estimate.chi2_per_n = 3.9;
  c.estimate.predicted_error = 1e-4;
  c.plot_data.workspace.resize(1);
  c.plot_data.workspace[0].joints = VectorXd::Zero(6);
  c.plot_data.workspace[0].predicted = 1.4e-4;
  EXPECT_EQ(advice_kinds(task_with_rows(60), c), (Kinds{use_corrections, keep_verification_poses}));
  c.estimate.chi2_per_n.reset();
  EXPECT_EQ(make_recommendations(task_with_rows(55), c)[1].values.count("more"), 10) << "never fewer than ten";
}

TEST(Recommendations, ASlideIsAskedForMillimetres) {
  CalibrationTask task = task_with_rows(80);
  task.nominal.joints[2].type = JointType::prismatic;
  task.data.joints.row(2) *= 0.01;
  const auto list = make_recommendations(task, {});
  ASSERT_EQ(list.at(1).kind, extend_joint_range);
  EXPECT_NEAR(list[1].values.number("range_m"), 0.02, 2e-3);
}

std::vector<CalibrationNoteKind> note_kinds(const std::vector<CalibrationNote>& notes) {
  std::vector<CalibrationNoteKind> kinds;
  for (const CalibrationNote& note : notes) {
    kinds.push_back(note.kind);
    EXPECT_FALSE(words::sentence(note).empty()) << name(note.kind);
  }
  return kinds;
}

Estimate unchanged_robot() {
  Estimate estimate;
  estimate.chain = test::er20();
  return estimate;
}

using NoteKinds = std::vector<CalibrationNoteKind>;

TEST(Notes, AreNoneOfAnEstimateThatDidNothingUnusual) {
  Estimate estimate = unchanged_robot();
  EXPECT_TRUE(make_notes(estimate, test::er20(), {}, {}, GeometricParameters{}).empty());
}

TEST(Notes, SayWhatWasDecidedOnTheWay) {
  Estimate estimate = unchanged_robot();
  estimate.chain.joints[1].backlash = 1e-4;
  estimate.chain.base.xyz = Vec3(0.03, 0.04, 0.0);
  const auto notes = make_notes(estimate, test::er20(), {.rows = {}, .too_many = true, .suspect_count = 9},
                                {.factor = 10.0}, GeometricParameters{});
  EXPECT_EQ(note_kinds(notes),
            (NoteKinds{CalibrationNoteKind::many_gross_errors, CalibrationNoteKind::tolerances_scaled,
                       CalibrationNoteKind::frames_from_data, CalibrationNoteKind::urdf_geometry_only}));
  EXPECT_NEAR(notes[2].values.number("distance_m"), 0.05, 1e-12);
  EXPECT_EQ(notes[0].values.count("rows"), 9);
}

TEST(Notes, ABaseThatIsAParameterHasNotBeenTakenFromTheData) {
  Estimate estimate = unchanged_robot();
  estimate.chain.base.xyz = Vec3(0.03, 0.04, 0.0);
  estimate.parameters = frame_parameters(test::er20(), task_with_rows(5).data);
  EXPECT_TRUE(make_notes(estimate, test::er20(), {}, {}, GeometricParameters{}).empty());
}

TEST(Notes, AnOffsetHasMovedIfChanceHardlyExplainsIt) {
  const PoseSet data = task_with_rows(20).data;
  Estimate estimate = unchanged_robot();
  estimate.parameters = joint_offset_parameters(test::er20(), data, {});
  for (const Parameter* parameter : estimate.parameters.free())
    estimate.values.push_back({.name = parameter->name, .quantity = parameter->quantity, .sd = 1e-4});
  const auto notes = [&] { return make_notes(estimate, test::er20(), {}, {}, JointOffsetParameters{}); };
  EXPECT_EQ(note_kinds(notes()), (NoteKinds{CalibrationNoteKind::no_offset_moved}));
  for (ParameterEstimate& value : estimate.values)
    if (value.name == "theta3") value.value = 3.0e-4;
  EXPECT_EQ(note_kinds(notes()), (NoteKinds{CalibrationNoteKind::no_offset_moved})) << "three of six by chance";
  for (ParameterEstimate& value : estimate.values)
    if (value.name == "theta3") value.value = -3.5e-4;
  ASSERT_EQ(note_kinds(notes()), (NoteKinds{CalibrationNoteKind::joint_offset_moved}));
  EXPECT_EQ(notes()[0].values.text("parameter"), "theta3");
  EXPECT_DOUBLE_EQ(notes()[0].values.number("change_rad"), -3.5e-4);
  EXPECT_NEAR(notes()[0].values.number("sigmas"), 3.5, 1e-9);
}

}  // namespace
}  // namespace kinfer

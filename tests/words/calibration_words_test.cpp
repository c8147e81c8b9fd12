// SPDX-License-Identifier: Apache-2.0
// Facts of calibrations in words: English sentences, and stable names for programs.
#include <gtest/gtest.h>

#include "kinfer/base/angle.hpp"
#include "kinfer/words/calibration/calibration.hpp"
#include "kinfer/words/calibration/checks.hpp"
#include "kinfer/words/calibration/frames.hpp"
#include "kinfer/words/calibration/model.hpp"
#include "kinfer/words/calibration/unknown_robot.hpp"
#include "kinfer/words/findings/findings.hpp"
#include "kinfer/words/findings/outliers.hpp"
#include "kinfer/words/findings/pose_set_findings.hpp"
#include "kinfer/words/findings/row_ranges.hpp"
#include "kinfer/words/language.hpp"

namespace kinfer {
namespace {

TEST(RowRanges, RunsAreJoined) {
  EXPECT_EQ(words::row_ranges({3}), "row 3");
  EXPECT_EQ(words::row_ranges({3, 5, 6, 9, 10, 11}), "rows 3, 5, 6 and 9-11");
}

TEST(RowRanges, LongListsAreCut) {
  std::vector<int> rows;
  for (int i = 0; i < 20; ++i) rows.push_back(2 * i);
  EXPECT_TRUE(words::row_ranges(rows).ends_with("22 and more, 20 in all"));
}

TEST(FindingWords, EveryKindHasASentenceAndASuggestion) {
  const std::vector<Finding> findings{
      {.kind = FindingKind::rows_shifted, .rows = {1, 2}, .values = {{"shift", -2}, {"whole_set", 0}}},
      {.kind = FindingKind::rows_swapped, .rows = {12, 40}},
      {.kind = FindingKind::base_moved, .rows = {4, 5}, .values = {{"distance_m", 0.1}}},
      {.kind = FindingKind::base_moved, .values = {{"distance_m", 1e-3}, {"from_row", 30}}},
      {.kind = FindingKind::base_drifts, .values = {{"distance_m", 4e-4}}},
      {.kind = FindingKind::degrees_for_radians,
       .values = {{"unit", std::string("deg")}, {"read_as", std::string("rad")}}},
      {.kind = FindingKind::wrong_sign, .values = {{"joint", std::string("J2")}, {"gain", -1.0}}},
      {.kind = FindingKind::joint_offset, .values = {{"joint", std::string("J2")}, {"offset_rad", -90.0 * degree}}},
      {.kind = FindingKind::mirrored},
      {.kind = FindingKind::robot_length_unit, .values = {{"reach_m", 1250.0}}},
      {.kind = FindingKind::orientation_convention, .values = {{"disagreement_rad", 1.0}}},
      {.kind = FindingKind::not_settled, .rows = {7}},
      {.kind = FindingKind::duplicate_rows, .rows = {5, 31}},
      {.kind = FindingKind::measurement_repeated, .rows = {20, 21}},
      {.kind = FindingKind::outside_limits, .rows = {1}, .values = {{"joint", std::string("J2")}}},
      {.kind = FindingKind::joint_hardly_moves, .values = {{"joint", std::string("J4")}}}};
  for (const Finding& finding : findings) {
    EXPECT_FALSE(words::sentence(finding).empty()) << name(finding.kind);
    EXPECT_FALSE(words::suggestion(finding).empty()) << name(finding.kind);
  }
  EXPECT_EQ(words::sentence(findings[1]), "the measurements of rows 12 and 40 are swapped");
  EXPECT_EQ(words::sentence(findings[7]), "J2 is -90 deg off its zero in the robot file");
}

TEST(FindingWords, UnitsAreNamedForPositionsAndForAJoint) {
  Finding finding{.kind = FindingKind::length_unit,
                  .values = {{"unit", std::string("mm")}, {"read_as", std::string("m")}}};
  EXPECT_EQ(words::sentence(finding), "the measured positions are millimetres, but were read as metres");
  EXPECT_EQ(words::suggestion(finding), "write the unit into the header: x[mm], y[mm], z[mm]");
  finding.values.set("joint", std::string("J3"));
  finding.values.set("column", 3);
  EXPECT_EQ(words::sentence(finding), "J3 is in millimetres, but was read as metres");
  EXPECT_EQ(words::suggestion(finding), "write its unit into the header: q3[mm]");
}

TEST(FindingWords, EquivalentFaultsAreNamedToo) {
  const Finding finding{.kind = FindingKind::wrong_sign,
                        .values = {{"joint", std::string("J5")}, {"gain", -1.0}},
                        .equivalents = {{.kind = FindingKind::mirrored}}};
  EXPECT_NE(words::sentence(finding).find("; or, which comes to the same, the measured positions are a mirror image"),
            std::string::npos);
}

TEST(OutlierWords, AllMeasurementsOfARowAreNamed) {
  const Outlier outlier{
      .row = 3,
      .reasons = {{kind_of<PointMeasurement>, 4.2134e-3, 84.2}, {kind_of<OrientationMeasurement>, 1.0 * degree, 9.0}},
      .held_out = true};
  EXPECT_EQ(
      words::sentence(outlier),
      "held out: the point lies 4.213 mm from where the model has it (84 sigma); the orientation is 1.000 deg from "
      "what the model has (9 sigma)");
}

TEST(OutlierWords, EveryKindOfMeasurementHasASentenceAndAName) {
  for (std::size_t i = 0; i < measurement_kinds; ++i) {
    const auto kind = static_cast<MeasurementKind>(i);
    EXPECT_FALSE(words::outlier_reasons({{kind, 1e-3, 5.0}}).empty());
    EXPECT_FALSE(words::measured_quantity(kind).empty());
    EXPECT_EQ(measurement_kind(name(kind)), kind);
  }
}

TEST(OutlierWords, TheHelpTextNamesEveryKindOfMeasurement) {
  const std::string list = words::measured_kinds();
  EXPECT_TRUE(list.starts_with("positions, orientations, socket contacts, "));
  for (std::size_t i = 0; i < measurement_kinds; ++i)
    EXPECT_NE(list.find(traits_of(static_cast<MeasurementKind>(i)).plural), std::string::npos);
}

TEST(UndeterminedWords, GroupsAreSortedSentences) {
  Identifiability identifiability;
  identifiability.undetermined = {{Undetermined::no_effect, {"theta6"}},
                                  {Undetermined::confounded, {"a2", "a3", "d4"}},
                                  {Undetermined::weaker_than_tolerance, {"a2"}}};
  EXPECT_EQ(words::undetermined_sentences(identifiability),
            (std::vector<std::string>{"a2 is not known better than its tolerance from these poses",
                                      "a2, a3 and d4 cannot be told apart from these poses",
                                      "theta6 has no effect that these measurements could show"}));
}

TEST(SelectionWords, EveryDecisionAndTermHasWords) {
  for (int i = 0; i <= static_cast<int>(Decision::data_missing); ++i)
    EXPECT_FALSE(words::reason({.decision = static_cast<Decision>(i), .missing = MissingData::torques}).empty()) << i;
  for (int i = 0; i < term_count; ++i) EXPECT_FALSE(words::description({.term = static_cast<Term>(i)}).empty()) << i;
  const SelectionStep step{.term = Term::gain,
                           .decision = Decision::extrapolation_worse,
                           .interpolation = {.mean_before = 1e-3, .mean_after = 5e-4, .t = 12.2},
                           .extrapolation = {.mean_before = 1e-3, .mean_after = 2e-3}};
  EXPECT_EQ(words::reason(step),
            "refused: the held-out mean goes from 1.0000 mm to 0.5000 mm (12 standard errors), but beyond the fitted "
            "poses the mean rises from 1.0000 mm to 2.0000 mm");
}

TEST(CalibrationWords, NotesComeInTheOrderOfThePipeline) {
  Calibration c;
  c.findings = {{.kind = FindingKind::mirrored}, {.kind = FindingKind::gross_outliers}};
  c.notes = {{CalibrationNoteKind::tolerances_scaled, {{"factor", 100.0}}}};
  c.accuracy = {{{0, 1}, 2e-3, 1e-3, 3e-3}};
  c.unknown_robot = UnknownRobotEvidence{.starts = 8, .agreeing = 5, .median_error = 1e-5};
  const std::vector<std::string> notes = words::notes(c);
  ASSERT_EQ(notes.size(), 4u) << "the fit lists its outliers itself";
  EXPECT_TRUE(notes[0].starts_with("the robot was found from its joint types and the measurements: 5 of 8"));
  EXPECT_TRUE(notes[1].starts_with("the measured positions are a mirror image"));
  EXPECT_TRUE(notes[2].ends_with("they were multiplied by 100"));
  EXPECT_EQ(notes[3],
            "ISO 9283 over all rows: pose accuracy AP 1.000 mm on average and 1.000 mm at worst (2.000 and 2.000 mm "
            "before); repeatability RP 3.000 mm on average and 3.000 mm at worst over 1 repeated pose");
}

TEST(CalibrationWords, AdviceShowsAnglesInDegreesAndLengthsInMillimetres) {
  const auto [what, why] = words::advice({CalibrationAdviceKind::measure_uncertain_region,
                                          {{"joints", std::vector<std::string>{"J1", "J2"}},
                                           {"positions", std::vector<double>{12.0 * degree, 0.085}},
                                           {"prismatic", std::vector<int>{0, 1}},
                                           {"error_there_m", 2e-4},
                                           {"error_m", 1e-4}}});
  EXPECT_TRUE(what.ends_with("J1=12°, J2=85 mm")) << what;
  EXPECT_EQ(why, "it expects 0.200 mm there against 0.100 mm over these poses");
}

TEST(CalibrationWords, HoldoutSchemes) {
  EXPECT_EQ(words::description(HoldoutScheme{HoldoutFolds{5}}), "5-fold cross-validation");
  EXPECT_EQ(words::description(HoldoutScheme{HoldoutFraction{0.3}}), "30 % of the rows, drawn at random");
  EXPECT_EQ(words::description(HoldoutScheme{HoldoutLabels{}}), "rows marked holdout");
}

TEST(CheckWords, ComparisonListsOnlySignificantChanges) {
  const CalibrationComparison changed{
      .parameters = {{.name = "theta3", .sigmas = -12.1, .significant = true}, {.name = "a2"}},
      .tool_rms = 1e-4,
      .tool_worst = 3e-4,
      .changed = true};
  EXPECT_EQ(
      words::verdict(changed),
      "Changed: theta3 (12.1 sigma); the tool differs by 0.100 mm rms and 0.300 mm at worst over the joint ranges.");
}

TEST(CheckWords, CompensationCountsUnreachedRows) {
  const std::vector<CompensatedJoints> rows{{.residual = 1e-9},
                                            {.residual = 4e-3, .status = InverseStatus::unreachable}};
  const CompensationSummary summary = summarise(rows);
  EXPECT_EQ(summary.unreached, std::vector<int>{1});
  EXPECT_EQ(words::summary(summary), "1 of 2 rows are compensated; the corrected model leaves 4.000000 mm at most");
}

TEST(FrameWords, SweepsWithoutANameAreCalledByTheirRows) {
  EXPECT_EQ(words::sweep_name({.name = "", .first_row = 3, .last_row = 15}), "rows 3 to 15");
  EXPECT_EQ(words::sweep_name({.name = "axis1"}), "axis1");
}

TEST(VerdictWords, PartsMakeTheSentence) {
  for (const CalibrationReason reason : {CalibrationReason::improves_nominal, CalibrationReason::no_improvement,
                                         CalibrationReason::not_validated, CalibrationReason::generalises}) {
    Calibration c;
    c.reason = reason;
    c.geometry_only = true;
    c.gross_error_rows = {4};
    c.estimate.outliers = {{.row = 4}, {.row = 6}};
    c.after.position.train = c.after.position.holdout = {1e-3, 1e-3, 1e-4, 2e-3, 20};
    const VerdictText text = words::verdict_text(c);
    EXPECT_EQ(words::verdict(c), sentence(text) + ".");
    EXPECT_EQ(text.recommendation, "Use it");
    EXPECT_FALSE(text.remarks.empty());
  }
}

/// Sets the language for one test.
struct InNames {
  InNames() { words::set_language(words::Language::names); }
  ~InNames() { words::set_language(words::Language::english); }
};

TEST(Names, FactsAreToldByTheirNamesAlone) {
  const InNames names;
  Calibration c;
  c.reason = CalibrationReason::overfitted;
  EXPECT_EQ(words::verdict(c), "overfitted");
  EXPECT_EQ(words::verdict_text(c).statement, "overfitted");
  EXPECT_EQ(words::sentence(Finding{.kind = FindingKind::mirrored}), "mirrored");
  EXPECT_EQ(words::reason({.decision = Decision::accepted}), "accepted");
  EXPECT_EQ(words::sentence(CalibrationNote{CalibrationNoteKind::no_offset_moved, {}}), "no_offset_moved");
}

}  // namespace
}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
// Sentences about verification, comparison, compensation, frames and robots without a data sheet.
#include <gtest/gtest.h>

#include <set>

#include "kinfer/base/constants.hpp"
#include "kinfer/words/calibration/calibration.hpp"
#include "kinfer/words/calibration/checks.hpp"
#include "kinfer/words/calibration/frames.hpp"
#include "kinfer/words/calibration/model.hpp"
#include "kinfer/words/calibration/unknown_robot.hpp"
#include "kinfer/words/findings/findings.hpp"
#include "kinfer/words/status.hpp"

namespace kinfer {
namespace {

TEST(VerificationWords, EveryResultHasItsOwnVerdictWithBothErrors) {
  Verification verification{.unmodified = {.mean = 2e-4, .max = 9e-4}, .frames_refitted = {.mean = 1e-4}};
  std::set<std::string> verdicts;
  for (int i = 0; i <= static_cast<int>(VerificationResult::moved_or_changed); ++i) {
    verification.result = static_cast<VerificationResult>(i);
    const std::string verdict = words::verdict(verification);
    verdicts.insert(verdict);
    EXPECT_NE(verdict.find("0.200 mm off on average and 0.900 mm at worst"), std::string::npos) << verdict;
    EXPECT_EQ(verdict.find("0.100 mm") != std::string::npos,
              verification.result == VerificationResult::frames_moved ||
                  verification.result == VerificationResult::robot_changed);
  }
  EXPECT_EQ(verdicts.size(), 4U);
}

TEST(ComparisonWords, NoChangeStatesHowMuchWasCompared) {
  CalibrationComparison same;
  same.parameters.resize(24);
  same.tool_rms = 2e-5, same.tool_worst = 6e-5;
  EXPECT_EQ(words::verdict(same),
            "No change beyond chance in 24 numbers; the tool differs by 0.020 mm rms and 0.060 mm at worst over the "
            "joint ranges.");
}

TEST(CompensationWords, ARowThatWasNotReachedSaysWhyAndByHowMuch) {
  for (const InverseStatus status : {InverseStatus::unreachable, InverseStatus::at_limit, InverseStatus::near_singular,
                                     InverseStatus::iteration_limit}) {
    const std::string text =
        words::unreached_row(7, {.residual = 1.5e-3, .residual_angle = 0.25 * degree, .status = status});
    EXPECT_TRUE(text.starts_with("row 7: ")) << text;
    EXPECT_TRUE(text.ends_with("; 1.5000 mm and 0.2500 deg are left")) << text;
    EXPECT_NE(text.find(words::sentence(status)), std::string::npos);
  }
  EXPECT_FALSE(words::compensation_frames_note().empty());
}

TEST(PlanWords, EveryCriterionHasADescription) {
  std::set<std::string> texts;
  for (int i = 0; i <= static_cast<int>(Criterion::e); ++i) texts.insert(words::description(static_cast<Criterion>(i)));
  EXPECT_EQ(texts.size(), 5U);
}

TEST(FrameWords, SayWhereBaseAndToolLengthComeFrom) {
  FrameEstimate frames;
  frames.base_joints = {"J1", "J2"};
  frames.tool_joint = "J5";
  EXPECT_EQ(words::base_source(frames), "joint J1 and joint J2");
  std::set<std::string> sources;
  for (int i = 0; i <= static_cast<int>(ToolLengthSource::radius_without_fit); ++i) {
    frames.tool_length_source = static_cast<ToolLengthSource>(i);
    sources.insert(words::tool_length_source(frames));
    EXPECT_EQ(words::tool_length_source(frames).find("J5") != std::string::npos,
              frames.tool_length_source != ToolLengthSource::mean_tool_point);
  }
  EXPECT_EQ(sources.size(), 3U);
}

TEST(UnknownRobotWords, AxesAreDescribedByAngleAndDistance) {
  UnknownRobotEvidence robot{.starts = 64, .agreeing = 9, .median_error = 2e-5};
  robot.axes.pairs = {
      {.first = "J1", .second = "J2", .relation = AxisRelation::intersecting, .angle = 1.5707963, .distance = 2e-5},
      {.first = "J2", .second = "J3", .relation = AxisRelation::parallel, .angle = 1e-4, .distance = 0.78},
      {.first = "J3", .second = "J4", .relation = AxisRelation::skew, .angle = 1.5707963, .distance = 0.14},
      {.first = "J4", .second = "P", .relation = AxisRelation::at_angle, .angle = 0.5, .distance = {}},
      {.first = "P", .second = "J6", .relation = AxisRelation::parallel, .angle = 0.0, .distance = {}}};
  robot.axes.wrists = {{"J4", "J5", "J6"}};
  const std::vector<std::string> list = words::unknown_robot_sentences(robot);
  ASSERT_EQ(list.size(), 7U);
  EXPECT_NE(list[0].find("9 of 64"), std::string::npos);
  EXPECT_NE(list[0].find("0.020 mm"), std::string::npos);
  EXPECT_EQ(list[1], "J1 and J2 intersect (0.020 mm) at 90.00 deg");
  EXPECT_EQ(list[2], "J2 and J3 are parallel (0.006 deg), 780.00 mm apart");
  EXPECT_EQ(list[4], "J4 and P are at 28.65 deg to each other");
  EXPECT_EQ(list[5], "P and J6 are parallel (0.000 deg)") << "a slide has no place";
  EXPECT_EQ(list[6], "J4, J5 and J6 meet in one point: a wrist");
  EXPECT_EQ(words::axis_sentences(robot.axes).size(), 6U);
}

TEST(CalibrationWords, EveryNoteAndEveryAdviceHasWords) {
  const FactValues values{{"faults", 2},
                          {"rows", 3},
                          {"factor", 10.0},
                          {"distance_m", 0.05},
                          {"parameter", std::string("theta3")},
                          {"change_rad", -0.01},
                          {"sigmas", 5.0},
                          {"residual_ratio", 3.0},
                          {"joint", std::string("J4")},
                          {"range_rad", 0.2},
                          {"joints", std::vector<std::string>{"J1"}},
                          {"positions", std::vector<double>{0.5}},
                          {"prismatic", std::vector<int>{0}},
                          {"error_there_m", 4e-4},
                          {"error_m", 1e-4},
                          {"robots", 12},
                          {"log_odds", -7.5},
                          {"more", 20},
                          {"poses", 40},
                          {"enough", 60}};
  std::set<std::string> sentences;
  for (int i = 0; i <= static_cast<int>(CalibrationNoteKind::no_offset_moved); ++i)
    sentences.insert(words::sentence(CalibrationNote{static_cast<CalibrationNoteKind>(i), values}));
  EXPECT_EQ(sentences.size(), 8U);
  EXPECT_EQ(sentences.count(""), 0U);
  std::set<std::string> what;
  for (int i = 0; i <= static_cast<int>(CalibrationAdviceKind::keep_verification_poses); ++i) {
    const auto text = words::advice(CalibrationAdvice{static_cast<CalibrationAdviceKind>(i), values});
    what.insert(text.what);
    EXPECT_FALSE(text.why.empty()) << i;
  }
  EXPECT_EQ(what.size(), 8U);
  EXPECT_EQ(words::sentence(CalibrationNote{CalibrationNoteKind::joint_offset_moved, values}),
            "theta3 has moved by -0.5730 deg since the earlier calibration (5 sd)");
}

TEST(CalibrationWords, LengthsOfASlideAreInMillimetres) {
  EXPECT_EQ(words::sentence(CalibrationNote{CalibrationNoteKind::joint_offset_moved,
                                            {{"parameter", std::string("d3")}, {"change_m", 2e-3}, {"sigmas", 8.0}}}),
            "d3 has moved by +2.0000 mm since the earlier calibration (8 sd)");
  const auto advice = words::advice(
      CalibrationAdvice{CalibrationAdviceKind::extend_joint_range, {{"joint", std::string("J3")}, {"range_m", 0.04}}});
  EXPECT_NE(advice.why.find("40 mm"), std::string::npos) << advice.why;
}

TEST(SelectionWords, MissingDataSayWhatToMeasure) {
  std::set<std::string> reasons;
  for (int i = 1; i <= static_cast<int>(MissingData::spectral_line); ++i)
    reasons.insert(words::reason(
        {.term = Term::gain, .decision = Decision::data_missing, .missing = static_cast<MissingData>(i)}));
  EXPECT_EQ(reasons.size(), 6U);
  const SelectionStep masses{.term = Term::gravity_compliance, .masses_approximate = true};
  EXPECT_NE(words::description(masses), words::description({.term = Term::gravity_compliance}));
}

TEST(OrientationFindings, NameTheConventionThatFits) {
  const auto sentence = [](const FactValues& values) {
    return words::sentence(Finding{.kind = FindingKind::orientation_convention, .values = values});
  };
  const auto remedy = [](const FactValues& values) {
    return words::suggestion(Finding{.kind = FindingKind::orientation_convention, .values = values});
  };
  std::set<std::string> remedies;
  for (const char* convention : {"inverse", "scalar_last", "mirrored_x", "mirrored_y", "mirrored_z"}) {
    const FactValues values{{"disagreement_rad", 90.0 * degree},
                            {"remaining_rad", 0.02 * degree},
                            {"quaternions", std::string(convention)}};
    EXPECT_NE(sentence(values).find("by 90 deg; they agree to 0.02 deg when read"), std::string::npos);
    remedies.insert(remedy(values));
  }
  EXPECT_EQ(remedies.size(), 5U);
  const FactValues euler{
      {"disagreement_rad", 1.0}, {"remaining_rad", 1e-4}, {"euler", std::string("ZYX")}, {"unit", std::string("deg")}};
  EXPECT_NE(remedy(euler).find("euler = \"ZYX\""), std::string::npos);
  EXPECT_NE(sentence({{"disagreement_rad", 1.0}}).find("no other convention"), std::string::npos);
}

TEST(SettlingFindings, DistinguishOneRowFromTheWholeSet) {
  const Finding some{.kind = FindingKind::not_settled, .rows = {4}, .values = {{"difference_rad", 1e-3}}};
  const Finding all{.kind = FindingKind::not_settled, .values = {{"difference_rad", 1e-3}}};
  EXPECT_NE(words::sentence(some).find("row 4"), std::string::npos);
  EXPECT_NE(words::sentence(all).find("0.057 deg typically"), std::string::npos);
  EXPECT_NE(words::suggestion(some), words::suggestion(all));
}

}  // namespace
}  // namespace kinfer

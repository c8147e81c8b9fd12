// SPDX-License-Identifier: Apache-2.0
// The names of kinds are the keys of evidence.json and the words of the command line.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "kinfer/evidence/calibration/calibration_facts.hpp"
#include "kinfer/evidence/calibration/estimate.hpp"
#include "kinfer/evidence/calibration/model_selection.hpp"
#include "kinfer/evidence/calibration/unknown_robot.hpp"
#include "kinfer/evidence/deployment/frame_estimate.hpp"
#include "kinfer/evidence/deployment/pose_plan.hpp"
#include "kinfer/evidence/deployment/verification.hpp"
#include "kinfer/evidence/facts/findings.hpp"
#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/measurement/measurements.hpp"

namespace kinfer {
namespace {

/// Of all enumerators up to the last one.
template <class Kind>
std::vector<std::string_view> names_up_to(Kind last) {
  std::vector<std::string_view> names;
  for (int i = 0; i <= static_cast<int>(last); ++i) names.push_back(name(static_cast<Kind>(i)));
  return names;
}

bool is_identifier(std::string_view name) {
  return !name.empty() && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

TEST(Names, EveryKindHasOneOfItsOwnThatAProgramCanUse) {
  const std::vector<std::vector<std::string_view>> lists{
      names_up_to(FindingKind::clock),
      names_up_to(Severity::fault),
      names_up_to(IdentificationNoteKind::relaxed_joint),
      names_up_to(IdentificationAdviceKind::measure_tool),
      names_up_to(UnobservableKind::offset_split),
      names_up_to(UnobservableRemedy::move_joint),
      names_up_to(EstimatedJointType::rigid),
      names_up_to(LinkSearchMethod::enumeration),
      names_up_to(Usability::do_not_use),
      names_up_to(JointUsability::unknown),
      names_up_to(JointDoubtKind::inaccurate),
      names_up_to(TraceQuantity::angular_velocity),
      names_up_to(TraceFrame::sensor),
      names_up_to(MeasurementKind{measurement_kinds - 1}),
      names_up_to(Undetermined::confounded),
      names_up_to(SearchMethod::bpnn_pso),
      names_up_to(Term::thermal_expansion),
      names_up_to(Decision::data_missing),
      names_up_to(MissingData::spectral_line),
      names_up_to(AxisRelation::skew),
      names_up_to(ToolLengthSource::radius_without_fit),
      names_up_to(VerificationResult::moved_or_changed),
      names_up_to(Criterion::e),
      names_up_to(CalibrationReason::unchanged),
      names_up_to(CalibrationNoteKind::no_offset_moved),
      names_up_to(CalibrationAdviceKind::keep_verification_poses),
  };
  for (const auto& list : lists) {
    EXPECT_EQ(std::set(list.begin(), list.end()).size(), list.size()) << list.front() << " … " << list.back();
    for (const std::string_view one : list) EXPECT_TRUE(is_identifier(one)) << one;
  }
  const auto swarms = names_up_to(InitialSwarm::network);
  EXPECT_EQ(std::set(swarms.begin(), swarms.end()).size(), swarms.size());
}

TEST(Names, AreReadBack) {
  for (const std::string_view one : names_up_to(FindingKind::clock)) EXPECT_EQ(name(*finding_kind(one)), one);
  for (const std::string_view one : names_up_to(MeasurementKind{measurement_kinds - 1}))
    EXPECT_EQ(name(*measurement_kind(one)), one);
  for (const std::string_view one : names_up_to(SearchMethod::bpnn_pso)) EXPECT_EQ(name(*search_method(one)), one);
  for (const std::string_view one : names_up_to(Criterion::e)) EXPECT_EQ(name(*criterion_named(one)), one);
  for (const std::string& one : term_names()) EXPECT_EQ(name(*term_named(one)), one);
  EXPECT_EQ(term_names().size(), static_cast<std::size_t>(term_count));
  EXPECT_EQ(names_up_to(MeasurementKind{measurement_kinds - 1}).size(), static_cast<std::size_t>(measurement_kinds));
}

TEST(Names, WhatIsNoNameIsNotRead) {
  for (const char* text : {"", "nothing", "Clock", "clock ", "LM", "points"}) {
    EXPECT_FALSE(finding_kind(text)) << text;
    EXPECT_FALSE(measurement_kind(text)) << text;
    EXPECT_FALSE(search_method(text)) << text;
    EXPECT_FALSE(criterion_named(text)) << text;
    EXPECT_FALSE(term_named(text)) << text;
  }
}

TEST(Names, AreThoseOfTheCommandLineAndThePapers) {
  EXPECT_EQ(name(LinkSearchMethod::memetic), "bmp");
  EXPECT_EQ(name(LinkSearchMethod::bacterial), "bp");
  EXPECT_EQ(name(LinkSearchMethod::enumeration), "enum");
  EXPECT_EQ(name(SearchMethod::levenberg_marquardt), "lm");
  EXPECT_EQ(name(Term::gravity_compliance), "gravity");
  EXPECT_EQ(name(TraceQuantity::angular_velocity), "rate");
  EXPECT_EQ(unit(TraceQuantity::angular_velocity), "rad/s");
  EXPECT_EQ(unit(TraceQuantity::acceleration), "m/s^2");
  EXPECT_EQ(name(TraceFrame::world), "ground");
}

TEST(Unobservable, AFreeChoiceNeedsNoMeasurementAndEverythingElseHasARemedy) {
  for (int i = 0; i <= static_cast<int>(UnobservableKind::offset_split); ++i) {
    const auto kind = static_cast<UnobservableKind>(i);
    const bool is_free_choice = kind == UnobservableKind::point_on_axis || kind == UnobservableKind::axis_position ||
                                kind == UnobservableKind::offset_split;
    EXPECT_EQ(remedy(kind) == UnobservableRemedy::none, is_free_choice) << name(kind);
  }
}

}  // namespace
}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
// Every fact of an identification has a sentence in English and a name for programs.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "kinfer/words/findings/findings.hpp"
#include "kinfer/words/identification/advice.hpp"
#include "kinfer/words/identification/forecast.hpp"
#include "kinfer/words/identification/joint_verdict.hpp"
#include "kinfer/words/identification/notes.hpp"
#include "kinfer/words/identification/unobservable.hpp"
#include "kinfer/words/identification/update.hpp"
#include "kinfer/words/identification/verdict.hpp"
#include "kinfer/words/language.hpp"

namespace kinfer::words {
namespace {

/// Sets the language for one test.
struct NamesOnly {
  NamesOnly() { set_language(Language::names); }
  ~NamesOnly() { set_language(Language::english); }
};

/// Facts about a joint arm-hand, with every value that any kind of note or advice needs.
FactValues all_values() {
  return {{"parent", std::string("arm")},
          {"child", std::string("hand")},
          {"sensor", std::string("hand")},
          {"joint", std::string("arm-hand")},
          {"reason", std::string("the fit diverged")},
          {"signals", 2},
          {"margin", 1.25},
          {"safe_margin", 2.0},
          {"force_ratio", 4.0},
          {"rate_ratio", 3.0},
          {"force_noise", 0.123},
          {"cutoff", 1.5},
          {"axis_deviation", 0.05},
          {"line_sd", 0.0123},
          {"direction_sd", 0.0045},
          {"acceleration_factor", 2.5},
          {"time_factor", 6.25},
          {"azimuths", std::vector<std::string>{"hand"}},
          {"uncertain_azimuths", std::vector<std::string>{"arm"}},
          {"azimuth_sds", std::vector<double>{0.011}},
          {"azimuth_unobservable", std::vector<int>{1}},
          {"points_in", std::vector<std::string>{"hand", "arm"}}};
}

/// Notes whose sentence names no sensor.
bool is_about_the_whole(IdentificationNoteKind kind) {
  using enum IdentificationNoteKind;
  return kind == unsafe_order || kind == phases_disagree || kind == refinement_failed || kind == limited_passband ||
         kind == assumed_force_sign;
}

std::vector<IdentificationNote> every_note() {
  std::vector<IdentificationNote> notes;
  for (int i = 0; i <= static_cast<int>(IdentificationNoteKind::relaxed_joint); ++i)
    notes.push_back({static_cast<IdentificationNoteKind>(i), all_values()});
  return notes;
}

std::vector<IdentificationAdvice> every_advice() {
  std::vector<IdentificationAdvice> list;
  for (int i = 0; i <= static_cast<int>(IdentificationAdviceKind::measure_tool); ++i)
    list.push_back({static_cast<IdentificationAdviceKind>(i), all_values()});
  return list;
}

TEST(IdentificationWords, EveryNoteHasASentenceOfItsOwnThatNamesItsSensors) {
  std::set<std::string> sentences;
  for (const IdentificationNote& note : every_note()) {
    const std::string sentence = note_sentence(note);
    sentences.insert(sentence);
    EXPECT_TRUE(is_about_the_whole(note.kind) || sentence.find("hand") != std::string::npos) << sentence;
  }
  EXPECT_EQ(sentences.size(), every_note().size());
}

TEST(IdentificationWords, NumbersOfNotesHaveTheirUnits) {
  using enum IdentificationNoteKind;
  EXPECT_NE(note_sentence({unsafe_order, all_values()}).find("margin 1.25, safe is 2"), std::string::npos);
  EXPECT_NE(note_sentence({unexplained_motion, all_values()}).find("(0.123 m/s²)"), std::string::npos);
  EXPECT_NE(note_sentence({limited_passband, all_values()}).find("below 1.5 Hz"), std::string::npos);
  EXPECT_EQ(note_sentence({refinement_failed, all_values()}), "the fit diverged; the geometry is that of the search");
  EXPECT_NE(note_sentence({several_signals, all_values()}).find("uses 2 signals"), std::string::npos);
}

TEST(IdentificationWords, EveryAdviceSaysWhatToDoAndWhy) {
  std::set<std::string> what, why;
  for (const IdentificationAdvice& advice : every_advice()) {
    const Advice text = advice_text(advice);
    EXPECT_FALSE(text.what.empty() || text.why.empty()) << name(advice.kind);
    what.insert(text.what), why.insert(text.why);
  }
  EXPECT_EQ(what.size(), every_advice().size());
  EXPECT_EQ(why.size(), every_advice().size() - 1) << "an inaccurate joint is inaccurate whatever the remedy";
  EXPECT_EQ(advice_text({IdentificationAdviceKind::check_mounts, all_values()}).why,
            "its line is known to 12.3 mm and its direction to 4.5 mrad only");
}

TEST(IdentificationWords, InTheLanguageOfNamesTheyAreTheNamesOfTheFacts) {
  const NamesOnly names;
  for (const IdentificationNote& note : every_note()) EXPECT_EQ(note_sentence(note), name(note.kind));
  for (const IdentificationAdvice& advice : every_advice()) {
    EXPECT_EQ(advice_text(advice).what, name(advice.kind));
    EXPECT_NE(advice_text(advice).why.find_first_not_of(' '), std::string::npos);
  }
}

JointEstimate joint_of_type(EstimatedJointType type) {
  return {.parent = "arm", .child = "hand", .type = type};
}

std::vector<Unobservable> every_unobservable() {
  std::vector<Unobservable> list;
  for (int i = 0; i <= static_cast<int>(UnobservableKind::offset_split); ++i)
    list.push_back({.kind = static_cast<UnobservableKind>(i),
                    .sensor = "hand",
                    .directions = {Vec3::UnitX(), Vec3::UnitZ()},
                    .other_joint = "base-arm"});
  return list;
}

TEST(UnobservableWords, EveryKindHasASentenceAndARemedy) {
  std::set<std::string> sentences, remedies;
  for (const Unobservable& u : every_unobservable()) {
    sentences.insert(unobservable_text(u, joint_of_type(EstimatedJointType::revolute)));
    remedies.insert(remedy_text(u));
  }
  EXPECT_EQ(sentences.size(), every_unobservable().size());
  EXPECT_EQ(remedies.size(), every_unobservable().size());
  const NamesOnly names;
  for (const Unobservable& u : every_unobservable())
    EXPECT_EQ(unobservable_text(u, joint_of_type(EstimatedJointType::revolute)), name(u.kind));
}

TEST(UnobservableWords, AJointWithSeveralAxesHasACentreInsteadOfAnAxis) {
  const Unobservable along{.kind = UnobservableKind::point_along, .sensor = "hand", .directions = {-Vec3::UnitX()}};
  for (const auto& [type, expected] : {std::pair{EstimatedJointType::revolute, "shifts of the axis in hand"},
                                       {EstimatedJointType::universal, "shifts of the centre of the joint in hand"},
                                       {EstimatedJointType::spherical, "shifts of the centre of the joint in hand"}})
    EXPECT_TRUE(unobservable_text(along, joint_of_type(type)).starts_with(expected)) << name(type);
  EXPECT_NE(unobservable_text(along, joint_of_type(EstimatedJointType::revolute)).find("[-1.00 0.00 0.00]"),
            std::string::npos)
      << "no negative zero";
}

TEST(ForecastWords, TheWorstJointSetsTheStatedAccuracy) {
  EXPECT_EQ(accuracy_text({}), "");
  EXPECT_EQ(accuracy_text({{.joint = "a-b", .line_sd = 1e-3, .direction_sd = 4e-4},
                           {.joint = "b-c", .line_sd = 2e-3, .direction_sd = 1e-4}}),
            "± 2.0 mm and ± 0.40 mrad");
  EXPECT_EQ(azimuth_text("arm", 0.0121, false), "the azimuth of arm about its only axis (± 12 mrad)");
  EXPECT_EQ(azimuth_text("arm", 1.0, true), "the azimuth of arm about its only axis (not known)");
}

TEST(ForecastWords, EveryInsufficientJointIsListed) {
  const std::string text = forecast_text({{.joint = "a-b", .acceleration_factor = 2.0, .time_factor = 4.0},
                                          {.joint = "b-c", .is_sufficient = true},
                                          {.joint = "c-d", .acceleration_factor = 3.0, .time_factor = 9.0}},
                                         {});
  EXPECT_NE(text.find("a-b (2.0 times the acceleration, or 4.0 times the time), c-d (3.0"), std::string::npos) << text;
  EXPECT_EQ(text.find("b-c"), std::string::npos);
}

TEST(ForecastWords, OfManyInsufficientJointsTheFirstAreListed) {
  const std::vector<JointForecast> joints(7, {.joint = "a-b", .acceleration_factor = 2.0, .time_factor = 4.0});
  const std::string text = forecast_text(joints, {});
  EXPECT_NE(text.find("4.0 times the time), and 3 more"), std::string::npos) << text;
}

TEST(IdentificationVerdict, ListsThreeFindingsOfAKindAndCountsTheOthers) {
  Identification result;
  const auto add = [&](const std::string& sensor) {
    result.findings.push_back(
        {.kind = FindingKind::clock,
         .severity = Severity::warning,
         .values = {{"sensor", sensor}, {"offset", 0.5}, {"drift", 0.0}, {"offset_sd", 1e-4}, {"drift_sd", 0.0}}});
  };
  for (const char* sensor : {"a", "b", "c"}) add(sensor);
  EXPECT_EQ(identification_verdict(result).find("more findings"), std::string::npos);
  for (const char* sensor : {"d", "e"}) add(sensor);
  const std::string text = identification_verdict(result);
  EXPECT_NE(text.find(", and 2 more findings like it"), std::string::npos) << text;
  EXPECT_EQ(text.find("of d are"), std::string::npos) << text;
}

TEST(IdentificationVerdict, BeginsWithTheRecommendation) {
  Identification result;
  result.prediction.worst_acceleration = 0.02;
  for (const auto& [usability, begin] : {std::pair{Usability::use, "Use it: "},
                                         {Usability::use_with_care, "Use with care: "},
                                         {Usability::do_not_use, "Do not use as it is: "}}) {
    result.usability = usability;
    EXPECT_TRUE(identification_verdict(result).starts_with(begin)) << name(usability);
    EXPECT_NE(identification_verdict(result).find("predicted to 0.020 m/s² rms"), std::string::npos);
  }
  const NamesOnly names;
  EXPECT_EQ(identification_verdict(result), "do_not_use");
}

FactValues doubt_values() {
  return {{"gain", 0.3},
          {"needed", 5.0},
          {"begin", 4.0},
          {"end", 27.0},
          {"sensor", "ins3"},
          {"distance", 65.0},
          {"reach", 15.0},
          {"first", "ins1"},
          {"second", "ins3"},
          {"margin", 1.2},
          {"safe_margin", 2.0},
          {"ratio", 12.0},
          {"line_sd", 0.0123},
          {"direction_sd", 0.02},
          {"types", std::vector<std::string>{"revolute", "universal"}},
          {"probabilities", std::vector{0.72, 0.28}}};
}

TEST(JointDoubtWords, EveryKindHasASentenceInUsersUnits) {
  std::string all;
  for (int kind = 0; kind <= static_cast<int>(JointDoubtKind::inaccurate); ++kind) {
    const std::string sentence = doubt_sentence({static_cast<JointDoubtKind>(kind), doubt_values()});
    EXPECT_FALSE(sentence.empty());
    all += sentence + "\n";
  }
  for (const char* part : {"its point is 65 m from ins3", "± 12.3 mm and ± 20.0 mrad", "from 4 to 27 s only",
                           "ins1 and ins3 may be joined instead (margin 1.20, safe is 2)",
                           "its type is uncertain: revolute with 72 %, universal with 28 %"})
    EXPECT_NE(all.find(part), std::string::npos) << part << " in " << all;
}

TEST(IdentificationVerdict, NamesTheRefusedJointFirstAndTheUsablePartNext) {
  Identification result;
  result.joints = {{.parent = "a", .child = "b"}, {.parent = "b", .child = "c"}};
  result.verdicts = {{.joint = "a-b"},
                     {.joint = "b-c",
                      .usability = JointUsability::do_not_use,
                      .doubts = {{JointDoubtKind::not_connected, doubt_values()}}}};
  result.usability = Usability::do_not_use;
  const std::string text = identification_verdict(result);
  EXPECT_TRUE(text.starts_with("Do not use as it is: b-c: a joint explains the motion no better")) << text;
  EXPECT_NE(text.find("of this, a-b may be used"), std::string::npos) << text;
  EXPECT_EQ(joint_usability_text(JointUsability::do_not_use), "do not use");
}

TEST(IdentificationVerdict, NamesUncertainTypes) {
  Identification result;
  JointEstimate joint{.parent = "a", .child = "b"};
  joint.type_probabilities = {{.of_type = {0.72, 0.0, 0.28, 0.0, 0.0}}};
  result.joints = {joint};
  result.verdicts = {{.joint = "a-b",
                      .usability = JointUsability::use_with_care,
                      .doubts = {{JointDoubtKind::uncertain_type, doubt_values()}}}};
  result.usability = Usability::use_with_care;
  EXPECT_NE(
      identification_verdict(result).find("joint types are uncertain: a-b is revolute with 72 %, universal with 28 %"),
      std::string::npos);
  joint.type_probabilities = {{.of_type = {0.97, 0.0, 0.03, 0.0, 0.0}}};
  result.joints.assign(3, joint), result.verdicts.clear();
  EXPECT_NE(identification_verdict(result).find("all joint types are right with 91 % only"), std::string::npos);
}

TEST(IdentificationVerdict, OneJointIsInTheSingular) {
  Identification result;
  result.joints = {{.parent = "a", .child = "b"}};
  EXPECT_NE(identification_verdict(result).find("1 joint found"), std::string::npos);
}

TEST(UpdateWords, ChangesAreNamedWithTheirSizesAndWhatWouldLookTheSame) {
  const ChainChange sensor{.kind = ChainChangeKind::sensor_moved,
                           .name = "hand",
                           .segment = "hand",
                           .alternative = "arm-hand",
                           .angle = ChangeSize{0.0174533, 0.000349},
                           .log_odds = 2000.0};
  EXPECT_EQ(change_sentence(sensor),
            "hand sits otherwise on its segment: turned by at least 1.00° (sd 0.02°) (beyond doubt); if it was not "
            "touched, the joint arm-hand moved on this segment");
  const ChainChange joint{.kind = ChainChangeKind::joint_moved,
                          .name = "arm-hand",
                          .segment = "arm",
                          .angle = ChangeSize{0.0, 0.000349},
                          .distance = ChangeSize{0.02, 0.001},
                          .log_odds = std::log(20.0)};
  EXPECT_EQ(change_sentence(joint),
            "the joint arm-hand is elsewhere on the segment of arm: turned by 0.00° (sd 0.02°), moved by 20.0 mm (sd "
            "1.0 mm) (odds 20 to 1)");
  EXPECT_EQ(update_sentence({}).find("nothing changed"), 0u);
  const std::string both = update_sentence({.changes = {sensor, joint}});
  EXPECT_EQ(both.find("2 changes"), 0u);
  EXPECT_NE(both.find(change_sentence(sensor)), std::string::npos);
  EXPECT_NE(both.find(change_sentence(joint)), std::string::npos);
}

}  // namespace
}  // namespace kinfer::words

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/findings/recording_findings.hpp"

#include <gmock/gmock.h>

#include "kinfer/words/findings/findings.hpp"
#include "kinfer/words/language.hpp"

namespace kinfer::words {
namespace {

using testing::HasSubstr;

FactValues unit_of(double unit) {
  return {{"sensors", std::vector<std::string>{"a", "b"}}, {"unit", unit}};
}

FactValues share_of(const char* instrument) {
  return {{"sensor", "a"}, {"instrument", std::string(instrument)}, {"share", 0.5}};
}

std::vector<Finding> one_of_each() {
  const FactValues cut{{"sensor", "e"}, {"link", "a-e"}, {"residual", 0.5}, {"usual_residual", 0.01}};
  FactValues group = cut;
  group.set("sensors", std::vector<std::string>{"e", "f"});
  const FactValues link{{"link", "a-b"},        {"replaced_link", "a-c"},    {"residual", 0.5},
                        {"off_axis_rate", 0.1}, {"replaced_residual", 0.01}, {"replaced_off_axis_rate", 0.001},
                        {"ratio", 12.0}};
  return {
      {.kind = FindingKind::given_link, .severity = Severity::note, .values = link},
      {.kind = FindingKind::given_link, .severity = Severity::fault, .values = link},
      {.kind = FindingKind::loop,
       .severity = Severity::note,
       .values = {{"segments", std::vector<std::string>{"a", "b", "c", "d"}},
                  {"first", "a"},
                  {"second", "d"},
                  {"gap", 0.0021},
                  {"mirrored_gap", 0.17},
                  {"log_odds", 45.0}},
       .applied = true},
      {.kind = FindingKind::other_machine, .values = {{"changes", 5}, {"sensors", 6}}},
      {.kind = FindingKind::several_machines, .values = group, .applied = true},
      {.kind = FindingKind::several_machines,
       .values = {{"sensors", std::vector<std::string>{"c", "d"}},
                  {"link", "b-c"},
                  {"residual", 0.9},
                  {"usual_residual", 0.02},
                  {"connection_gain", 6.0}},
       .applied = true},
      {.kind = FindingKind::several_machines, .values = {{"groups", std::vector<std::string>{"a, b", "c, d"}}}},
      {.kind = FindingKind::linkage, .values = cut, .applied = true},
      {.kind = FindingKind::no_joint, .values = cut, .applied = true},
      {.kind = FindingKind::fragmented_sensor,
       .values = {{"sensor", "c"}, {"pieces", 18}, {"piece", 1.46}, {"left_out", std::vector<std::string>{"c", "d"}}},
       .applied = true},
      {.kind = FindingKind::not_connected, .values = {{"sensor", "e"}}, .applied = true},
      {.kind = FindingKind::mixed_recording,
       .severity = Severity::fault,
       .values = {{"sensor", "e"}, {"begin", 4.0}, {"end", 27.3}}},
      {.kind = FindingKind::duplicate_sensor, .severity = Severity::fault, .values = {{"first", "a"}, {"second", "e"}}},
      {.kind = FindingKind::idle,
       .values = {{"stationary", std::vector<std::string>{"a", "b"}},
                  {"left_out", std::vector<std::string>{"b"}},
                  {"kept", "a"}},
       .applied = true},
      {.kind = FindingKind::remounted,
       .values = {{"sensor", "c"},
                  {"begin", 40.0},
                  {"end", 41.5},
                  {"axis_rotation", 0.174532925},
                  {"point_shift", 0.03},
                  {"used_part", "before"}},
       .applied = true},
      {.kind = FindingKind::clock,
       .values = {{"sensor", "d"}, {"offset", -0.05}, {"drift", 5e-5}, {"offset_sd", 1e-4}, {"drift_sd", 1e-6}},
       .applied = true},
      {.kind = FindingKind::timestamp_jitter,
       .values = {{"sensors", std::vector<std::string>{"a", "b"}},
                  {"jitter", 2.5e-3},
                  {"period", 0.01},
                  {"rows_per_packet", 1.0}},
       .applied = true},
      {.kind = FindingKind::timestamp_jitter,
       .values = {{"sensors", std::vector<std::string>{"a", "b"}},
                  {"jitter", 0.03},
                  {"period", 0.01},
                  {"rows_per_packet", 10.0}},
       .applied = true},
      {.kind = FindingKind::clock_unit, .values = {{"logger", "a.csv"}, {"unit", 1e-3}}, .applied = true},
      {.kind = FindingKind::clock_counts,
       .severity = Severity::fault,
       .values = {{"logger", "a.csv"}, {"unit", 0.01}, {"rate", 100.0}}},
      {.kind = FindingKind::force_unit, .values = unit_of(9.80665), .applied = true},
      {.kind = FindingKind::force_scale,
       .values = {{"scale", 0.0194}, {"sd", 0.002}, {"gravity", 9.997}},
       .applied = true},
      {.kind = FindingKind::rate_unit, .values = unit_of(0.017453292519943295), .applied = true},
      {.kind = FindingKind::field_unit, .values = unit_of(1e3), .applied = true},
      {.kind = FindingKind::repeated_rows, .values = share_of("gyroscope"), .applied = true},
      {.kind = FindingKind::interpolated_rows, .values = share_of("accelerometer"), .applied = true},
      {.kind = FindingKind::rates_unrelated, .severity = Severity::fault, .values = unit_of(1.0)},
      {.kind = FindingKind::rate_sign, .severity = Severity::fault, .values = {{"sensor", "b"}}, .applied = true},
      {.kind = FindingKind::rate_sign, .severity = Severity::fault, .values = {{"sensor", "b"}}},
      {.kind = FindingKind::left_handed, .severity = Severity::fault, .values = {{"sensor", "c"}}, .applied = true},
      {.kind = FindingKind::instrument_axes,
       .severity = Severity::fault,
       .values = {{"sensor", "b"}, {"instrument", "gyroscope"}, {"axes", "y, -x, z"}},
       .applied = true},
      {.kind = FindingKind::force_sign,
       .severity = Severity::fault,
       .values = {{"sensors", std::vector<std::string>{"d"}}},
       .applied = true},
      {.kind = FindingKind::force_sign, .values = {{"sensors", std::vector<std::string>{"a", "b"}}}},
      {.kind = FindingKind::opposite_verticals,
       .severity = Severity::fault,
       .values = {{"sensors", std::vector<std::string>{"a"}}, {"others", std::vector<std::string>{"b"}}}},
      {.kind = FindingKind::instrument_scale,
       .values = {{"sensor", "c"}, {"instrument", "gyroscope"}, {"part", "all"}, {"scale", 0.0195}, {"sd", 2e-4}},
       .applied = true},
      {.kind = FindingKind::instrument_scale,
       .values = {{"sensor", "c"}, {"instrument", "accelerometer"}, {"part", "y"}, {"scale", -0.01}, {"sd", 1e-3}},
       .applied = true},
      {.kind = FindingKind::instrument_scale,
       .values = {{"sensor", "c"}, {"instrument", "gyroscope"}, {"part", "axes"}, {"scale", 0.03491}, {"sd", 1e-3}},
       .applied = true},
      {.kind = FindingKind::instrument_scale,
       .values = {{"sensor", "c"}, {"instrument", "gyroscope"}, {"part", "turned"}, {"scale", 0.03491}, {"sd", 1e-3}}},
      {.kind = FindingKind::clock_rate, .values = {{"scale", 0.05}, {"sd", 1e-3}}},
      {.kind = FindingKind::instruments_out_of_step,
       .values = {{"sensor", "b"}, {"lag", 0.04}, {"sd", 0.002}},
       .applied = true},
  };
}

TEST(RecordingFindings, EveryKindHasASentenceAndItsNumbersInUsersUnits) {
  std::string all;
  for (const Finding& finding : one_of_each()) {
    ASSERT_TRUE(is_recording_finding(finding.kind)) << name(finding.kind);
    EXPECT_FALSE(sentence(finding).empty());
    EXPECT_EQ(sentence(finding).back() == '.', false);
    EXPECT_EQ(suggestion(finding).empty(), finding.severity == Severity::note);
    all += sentence(finding) + "\n";
  }
  EXPECT_THAT(all, HasSubstr("turned by 10.0 deg"));
  EXPECT_THAT(all, HasSubstr("the gyroscope of c reads 1.95 ± 0.02 % too much, more"));
  EXPECT_THAT(all, HasSubstr("the accelerometer of c reads 1.00 ± 0.10 % too little along its y axis, more"));
  EXPECT_THAT(all, HasSubstr("the axes of the gyroscope of c are off by 2.00 deg, more"));
  EXPECT_THAT(all, HasSubstr("gyroscope and accelerometer of c are turned by 2.00 deg against each other"));
  EXPECT_THAT(all, HasSubstr("the clock runs 5.00 % fast, and then every length is 0.91 times as long"));
  EXPECT_THAT(all, HasSubstr("e shares joints with the others from 4 to 27 s that it does not share in the rest"));
  EXPECT_THAT(all, HasSubstr("a and e hold the same measurements"));
  EXPECT_THAT(all, HasSubstr("moved by about 30 mm; only what was recorded before is used"));
  EXPECT_THAT(all, HasSubstr("d are logged 50.00 (± 0.10) ms late, and its clock runs 50.0 (± 1.00) ppm slow"));
  EXPECT_THAT(all, HasSubstr("fall into 2 groups that share only the ground (a, b; c, d)"));
  EXPECT_THAT(all, HasSubstr("the specific forces of a, b are in g, by the size of gravity"));
  EXPECT_THAT(all, HasSubstr("the angular rates of a, b are in deg/s"));
  EXPECT_THAT(all, HasSubstr("the accelerometer of b is logged 40 ± 2 ms later than its gyroscope"));
  EXPECT_THAT(all, HasSubstr("the gyroscope of b has other axes than its other instruments: theirs are its y, -x, z"));
  EXPECT_THAT(all, HasSubstr("a-b is against the log: a joint there leaves 0.500 m/s²"));
}

TEST(RecordingFindings, ADriftWithinItsUncertaintyIsNotStated) {
  const Finding clock{
      .kind = FindingKind::clock,
      .values = {{"sensor", "d"}, {"offset", 0.01}, {"drift", 3e-6}, {"offset_sd", 0.0}, {"drift_sd", 1e-6}}};
  EXPECT_EQ(sentence(clock), "the measurements of d are logged 10.00 ms early");
}

TEST(RecordingFindings, InTheLanguageOfNamesASentenceIsTheNameOfTheFact) {
  set_language(Language::names);
  for (const Finding& finding : one_of_each()) EXPECT_THAT(sentence(finding), testing::MatchesRegex("[a-z_]+"));
  set_language(Language::english);
}

TEST(Findings, AboutAPoseSetAreNotAboutARecording) {
  EXPECT_FALSE(is_recording_finding(FindingKind::rows_shifted));
  EXPECT_FALSE(is_recording_finding(FindingKind::not_rigid));
}

}  // namespace
}  // namespace kinfer::words

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/identification/notes.hpp"

#include <gmock/gmock.h>

namespace kinfer::words {
namespace {

using enum IdentificationNoteKind;

TEST(IdentificationNotes, StateAnglesInDegreesAndKeepTheNamesOfTheSensors) {
  EXPECT_EQ(
      note_sentence({relaxed_joint, {{"parent", "a"}, {"child", "b"}, {"axis_deviation", 0.0349066}}}),
      "the joint a-b is not strictly revolute: its axis deviates by 2.0 degrees (rms), due to play in the bearing, a "
      "flexible segment or a compliant mount; it was relaxed to a spherical joint, and the axis stated is the mean");
  EXPECT_EQ(note_sentence({prismatic_joint, {{"parent", "a"}, {"child", "b"}}}), "b slides on a");
}

TEST(IdentificationNotes, StateTheAssumedSignOfAccelerometers) {
  EXPECT_THAT(note_sentence({assumed_force_sign, {}}), testing::StartsWith("assumed: accelerometers read +g upwards"));
}

TEST(IdentificationNotes, PrecedeTheFindingsWithTheirSuggestions) {
  Identification result;
  result.notes = {{phases_disagree, {}}};
  result.findings = {{.kind = FindingKind::idle,
                      .values = {{"stationary", std::vector<std::string>{"a", "b"}},
                                 {"left_out", std::vector<std::string>{"b"}},
                                 {"kept", "a"}}}};
  EXPECT_THAT(note_sentences(result),
              testing::ElementsAre(testing::StartsWith("the phases in which the segments move give another order"),
                                   testing::EndsWith(": move every joint, and give each machine a log of its own")));
}

}  // namespace
}  // namespace kinfer::words

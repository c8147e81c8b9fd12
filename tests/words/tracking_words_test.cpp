// SPDX-License-Identifier: Apache-2.0
// Sentences about runs of a tracker.
#include "kinfer/words/tracking/track_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "kinfer/words/language.hpp"

namespace kinfer {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr auto last_alarm = TrackAlarmKind::sensor_exchanged;

/// Two sensors and a joint, tracked over 12.5 s without any alarm.
TrackRun sound_run() {
  TrackRun run{.begin = 1.0, .end = 13.5, .rows = 2500};
  run.positions.resize(1);
  run.sensors = {{.name = "chassis"}, {.name = "boom"}};
  run.joints = {{.name = "swing"}};
  return run;
}

TrackEvent event_of(TrackAlarmKind kind, double until) {
  return {.alarm = {.kind = kind, .sensor = 1, .joint = 0, .since = 3.0, .strength = 2.0}, .until = until};
}

TEST(AlarmWords, EveryKindHasASentenceOfItsOwnThatNamesWhatItIsAbout) {
  const std::vector<std::string> sensors{"chassis", "boom"}, joints{"swing"};
  std::set<std::string> sentences;
  for (int i = 0; i <= static_cast<int>(last_alarm); ++i) {
    const auto kind = static_cast<TrackAlarmKind>(i);
    const std::string text = words::sentence({.kind = kind, .sensor = 1, .joint = 0}, sensors, joints);
    EXPECT_TRUE(sentences.insert(text).second) << text;
    EXPECT_FALSE(text.ends_with(".")) << text;
    const std::string of_nobody = words::sentence({.kind = kind, .sensor = -1, .joint = -1}, sensors, joints);
    EXPECT_THAT(of_nobody, ::testing::Not(HasSubstr("boom")));
    EXPECT_THAT(of_nobody, ::testing::Not(HasSubstr("swing")));
    const bool is_about_sensor = name(kind).starts_with("sensor_");
    EXPECT_EQ(text.find("boom") != std::string::npos, is_about_sensor) << text;
    const bool is_about_joint = kind == TrackAlarmKind::joint_changed || kind == TrackAlarmKind::start_wrong;
    EXPECT_EQ(text.find("swing") != std::string::npos, is_about_joint) << text;
  }
}

TEST(AlarmWords, ASensorThatWasTurnedBeforeTheLogSaysByHowMuch) {
  const TrackAlarm alarm{.kind = TrackAlarmKind::sensor_moved, .sensor = 1, .turn = SensorTurn{0.0349, 0.0002, 0.05}};
  EXPECT_THAT(words::sentence(alarm, {"chassis", "boom"}, {}),
              HasSubstr("boom was turned by 2.00 ± 0.01 deg before the log began (± 2.86 deg about"));
}

TEST(AlarmWords, AnIndexBeyondTheListsIsNoCrash) {
  EXPECT_THAT(words::sentence({.kind = TrackAlarmKind::sensor_lost, .sensor = 7}, {"only"}, {}),
              HasSubstr("a sensor sends no samples"));
  EXPECT_THAT(words::sentence({.kind = TrackAlarmKind::joint_changed, .joint = 2}, {}, {}), HasSubstr("a joint"));
}

TEST(TrackVerdict, ARunWithoutAlarmsIsOfUse) {
  const TrackRun run = words::with_sentences(sound_run());
  EXPECT_EQ(run.verdict.usability, Usability::use);
  EXPECT_THAT(run.verdict.sentence, HasSubstr("1 joint positions tracked over 12.5 s, no alarm"));
  EXPECT_THAT(run.verdict.parts->remarks, IsEmpty());
}

/// What kind of alarm, active to the end or not, leaves of the verdict.
TEST(TrackVerdict, DependsOnTheKindOfAlarmAndWhetherItLasts) {
  constexpr double to_the_end = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i <= static_cast<int>(last_alarm); ++i)
    for (const bool lasts : {false, true}) {
      const auto kind = static_cast<TrackAlarmKind>(i);
      TrackRun run = sound_run();
      run.events = {event_of(kind, lasts ? to_the_end : 5.0)};
      run = words::with_sentences(run);
      const bool is_remark = kind == TrackAlarmKind::restarted || kind == TrackAlarmKind::sensor_clipped;
      const bool is_fatal = (kind == TrackAlarmKind::does_not_fit || kind == TrackAlarmKind::sensor_exchanged) && lasts;
      EXPECT_EQ(run.verdict.usability, is_remark  ? Usability::use
                                       : is_fatal ? Usability::do_not_use
                                                  : Usability::use_with_care)
          << name(kind) << lasts;
      EXPECT_FALSE(run.events[0].sentence.empty());
      if (!is_fatal) {
        EXPECT_THAT(run.verdict.sentence, HasSubstr(is_remark ? "no alarm" : "1 alarm"));
      }
    }
}

TEST(TrackVerdict, OfPositionsThatCouldBeAnyIsNotOfUse) {
  TrackRun run = sound_run();
  run.positions = {{.name = "swing", .sd = {1.8, 1.8, 0.01}}, {.name = "boom", .sd = {0.01, 0.01, 0.01}}};
  EXPECT_EQ(words::with_sentences(run).verdict.usability, Usability::use_with_care);
  run.positions[1].sd = {1.8, 1.8, 1.8};
  EXPECT_EQ(words::with_sentences(run).verdict.usability, Usability::do_not_use);
  EXPECT_THAT(words::with_sentences(run).verdict.sentence, HasSubstr("no joint position is known"));
  run.positions = {{.name = "telescope", .rotates = false, .sd = {0.6, 0.6, 0.6}}};
  EXPECT_EQ(words::with_sentences(run).verdict.usability, Usability::use);
}

TEST(TrackVerdict, OfNothingIsNotOfUse) {
  TrackRun run = sound_run();
  run.rows = 0;
  EXPECT_EQ(words::with_sentences(run).verdict.usability, Usability::do_not_use);
}

TEST(TrackVerdict, DoesNotGetBetterByFurtherAlarms) {
  TrackRun run = sound_run();
  Usability before = Usability::use;
  for (const TrackAlarmKind kind : {TrackAlarmKind::sensor_clipped, TrackAlarmKind::sensor_lost,
                                    TrackAlarmKind::restarted, TrackAlarmKind::does_not_fit}) {
    run.events.push_back(event_of(kind, std::numeric_limits<double>::quiet_NaN()));
    const Usability now = words::with_sentences(run).verdict.usability;
    EXPECT_FALSE(before == Usability::do_not_use && now != Usability::do_not_use) << name(kind);
    EXPECT_FALSE(before == Usability::use_with_care && now == Usability::use) << name(kind);
    before = now;
  }
  EXPECT_EQ(before, Usability::do_not_use);
}

TEST(JointSentences, NameJointsByTheShareOfTheTime) {
  TrackRun run = sound_run();
  run.joints = {{.name = "swing", .unknown = 1.0},
                {.name = "boom", .composed = 0.4, .relative_to_start = 0.97},
                {.name = "arm", .composed = 0.04, .unknown = 0.2}};
  const auto sentences = words::joint_sentences(run);
  ASSERT_EQ(sentences.size(), 3u);
  EXPECT_EQ(sentences[0], "unknown: swing, arm (20 % of the time)");
  EXPECT_TRUE(sentences[1].ends_with(": boom")) << sentences[1];
  EXPECT_TRUE(sentences[2].ends_with(": boom (40 % of the time)")) << sentences[2];
  EXPECT_EQ(words::with_sentences(run).verdict.usability, Usability::use_with_care);
  EXPECT_EQ(words::with_sentences(run).verdict.parts->remarks, sentences);
}

TEST(TrackVerdict, DoesNotDependOnTheLanguage) {
  TrackRun run = sound_run();
  run.events = {event_of(TrackAlarmKind::sensor_moved, 5.0)};
  run.joints[0].relative_to_start = 1.0;
  const TrackRun english = words::with_sentences(run);
  words::set_language(words::Language::names);
  const TrackRun names = words::with_sentences(run);
  words::set_language(words::Language::english);
  EXPECT_EQ(names.verdict.usability, english.verdict.usability);
  EXPECT_EQ(names.events[0].sentence, "sensor_moved");
  EXPECT_EQ(names.verdict.parts->remarks, std::vector<std::string>{"relative_to_start"});
  EXPECT_EQ(names.verdict.parts->recommendation, "use_with_care");
}

}  // namespace
}  // namespace kinfer

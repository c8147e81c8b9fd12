// SPDX-License-Identifier: Apache-2.0
#include "kinfer/fleet/merge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinfer/base/rng.hpp"
#include "kinfer/io/fleet/fleet_json.hpp"
#include "kinfer/io/fleet/fleet_table.hpp"
#include "kinfer/report/report.hpp"
#include "kinfer/words/fleet/fleet.hpp"

namespace kinfer {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// Calibrations of one type: rms errors that scatter by 10 %, theta2 by 1 mrad, known to 0.5 mrad.
std::vector<FleetRow> calibrations(int count) {
  std::vector<FleetRow> rows;
  for (int k = 0; k < count; ++k) {
    Rng rng = Rng(5).stream(k);
    const double rms = 1e-4 * std::exp(0.1 * rng.normal()), truth = 0.5 + 1e-3 * rng.normal();
    const double value = truth + 0.5e-3 * rng.normal();
    rows.push_back({.key = fmt::format("r{:03}", k),
                    .verb = "calibrate",
                    .processor_class = "x86_64 avx2, kernels avx2",
                    .summary = {.verb = "calibrate",
                                .usability = Usability::use,
                                .figures = {{"rms_after_m", rms}},
                                .parameters = {{.name = "theta2",
                                                .quantity = Quantity::angle,
                                                .nominal = 0.5,
                                                .value = value,
                                                .sd = 0.5e-3,
                                                .truth = truth}}}});
  }
  return rows;
}

TEST(Merge, NamesTheRobotThatIsUnlikeTheOthers) {
  auto rows = calibrations(60);
  rows[17].summary.parameters[0].value += 20e-3;
  rows[23].summary.figures[0].value *= 5.0;
  const Fleet fleet = fleet::merge_rows(rows);
  ASSERT_EQ(fleet.deviations.size(), 2U);
  std::vector<std::string> keys{fleet.deviations[0].key, fleet.deviations[1].key};
  EXPECT_THAT(keys, ::testing::UnorderedElementsAre("r017", "r023"));
  EXPECT_EQ(fleet.rows[17].most_deviant, "theta2");
  EXPECT_EQ(worst_first(fleet)[0] == 17 || worst_first(fleet)[0] == 23, true);
}

TEST(Merge, HealthyFleetsOfAnySizeAreCalledUnusualAsRarelyAsStated) {
  for (const int robots : {10, 13, 40}) {
    int unusual = 0;
    constexpr int fleets = 400;
    for (int k = 0; k < fleets; ++k) {
      auto rows = calibrations(robots);
      for (int i = 0; i < robots; ++i) {
        Rng rng = Rng(77).stream(k).stream(i);
        auto& summary = rows[static_cast<std::size_t>(i)].summary;
        summary.figures[0].value = 1e-4 * std::exp(0.1 * rng.normal());
        summary.parameters[0].value = 0.5 + 1e-3 * rng.normal();
        summary.parameters[0].sd = 0.0;
      }
      unusual += fleet::merge_rows(rows).deviations.empty() ? 0 : 1;
    }
    EXPECT_LE(unusual, 36) << robots << ": 20 of 400 are stated, and 36 are three and a half deviations above";
  }
}

TEST(Merge, FindsNothingInAHealthyFleet) {
  EXPECT_TRUE(fleet::merge_rows(calibrations(60)).deviations.empty());
  EXPECT_TRUE(fleet::merge_rows(calibrations(3)).deviations.empty());
}

TEST(Merge, CountsHowOftenTheTruthIsInTheInterval) {
  const Fleet fleet = fleet::merge_rows(calibrations(400));
  ASSERT_EQ(fleet.coverage.size(), 1U);
  EXPECT_EQ(fleet.coverage[0].count, 400);
  EXPECT_NEAR(fleet.coverage[0].inside / 400.0, 0.95, 0.03);
}

TEST(Merge, GivesTheSameBytesInAnyOrder) {
  auto rows = calibrations(50);
  const Fleet forward = fleet::merge_rows(rows);
  std::ranges::reverse(rows);
  std::swap(rows[3], rows[30]);
  const Fleet shuffled = fleet::merge_rows(rows);
  EXPECT_EQ(format_fleet_table(forward.rows), format_fleet_table(shuffled.rows));
  EXPECT_EQ(format_fleet(forward), format_fleet(shuffled));
  EXPECT_EQ(report::report_html(forward), report::report_html(shuffled));
}

TEST(Merge, GroupsFailuresBySentenceAndListsWhatIsUnfinished) {
  auto rows = calibrations(4);
  rows[0] = {.key = "a", .verb = "calibrate", .exit_code = 2, .sentence = "poses.csv: no such file"};
  rows[1] = {.key = "b", .verb = "calibrate", .exit_code = 2, .sentence = "poses.csv: no such file"};
  rows[2] = {.key = "c", .verb = "calibrate", .state = TaskState::unfinished};
  const Fleet fleet = fleet::merge_rows(rows);
  ASSERT_EQ(fleet.failures.size(), 1U);
  EXPECT_EQ(fleet.failures[0].keys, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(words::headline(fleet.counts), "4 tasks: 1 to use, 2 refused, 1 unfinished");
  EXPECT_THAT(format_fleet(fleet), HasSubstr("\"unfinished\": [\n  \"c\"\n ]"));
  EXPECT_EQ(fleet.rows[static_cast<std::size_t>(worst_first(fleet)[0])].key, "a");
}

TEST(Merge, SaysWhenProcessorClassesAreMixed) {
  auto rows = calibrations(2);
  EXPECT_THAT(words::remarks(fleet::merge_rows(rows)), Not(Contains(HasSubstr("classes"))));
  rows[0].processor_class = "x86_64 avx512, kernels avx512";
  EXPECT_THAT(words::remarks(fleet::merge_rows(rows)), Contains(HasSubstr("processors of different classes")));
}

TEST(Merge, SaysWhyThereIsNoPrior) {
  auto rows = calibrations(3);  // without what their data tell of the joint parameters
  EXPECT_THAT(words::remarks(fleet::merge_rows(rows)),
              Contains("no prior.json: 0 robots with a calibration that may be used, and a prior needs 2"));
  for (FleetRow& row : rows) row.verb = "verify";
  EXPECT_THAT(words::remarks(fleet::merge_rows(rows)), Not(Contains(HasSubstr("prior"))));
}

TEST(Merge, ThePageHoldsEveryRowAsData) {
  const std::string page = report::report_html(fleet::merge_rows(calibrations(300)));
  EXPECT_THAT(page, HasSubstr("\"kind\":\"fleet\""));
  for (const char* key : {"\"r000\"", "\"r150\"", "\"r299\""}) EXPECT_THAT(page, HasSubstr(key));
}

TEST(TaskSummary, IsReadBackAsItWasWritten) {
  TaskSummary summary = calibrations(1)[0].summary;
  summary.findings = {"gross_outliers"};
  const std::string text = format_task_summary(summary);
  const auto read = parse_task_summary(text);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(format_task_summary(*read), text);
  EXPECT_FALSE(parse_task_summary(text.substr(0, text.size() / 2)));
  EXPECT_FALSE(parse_task_summary("{}"));
}

TEST(Information, IsReadBackAsItWasWritten) {
  const ParameterInformation information{.names = {"theta2"},
                                         .nominal = VectorXd::Constant(1, 0.5),
                                         .tolerance = VectorXd::Constant(1, 1e-3),
                                         .information = MatrixXd::Constant(1, 1, 4.0),
                                         .vector = VectorXd::Constant(1, 2.0)};
  const std::string text = format_information(information);
  const auto read = parse_information(text);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(format_information(*read), text);
  EXPECT_FALSE(parse_information(text.substr(0, text.size() / 2)));
}

TEST(Merge, APriorIsMadeOfTheLatestCalibrationOfEachRobot) {
  auto rows = calibrations(4);
  rows[0].robot = rows[1].robot = rows[2].robot = "arm";
  rows[0].date = "2026-05-01", rows[1].date = "2026-07-01", rows[2].date = "2026-06-01";
  EXPECT_EQ(fleet::rows_of_prior(rows), (std::vector<int>{1, 3}));
  rows[1].exit_code = 1;
  EXPECT_EQ(fleet::rows_of_prior(rows), (std::vector<int>{2, 3}));
}

}  // namespace
}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
// The page of a run of the tracker, and its figures.
#include "kinfer/report/track/page.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "kinfer/base/angle.hpp"
#include "kinfer/report/track/figures.hpp"
#include "support/html_text.hpp"

namespace kinfer::report {
namespace {

using test::count_of;
using test::shows;

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

/// A hinge and a slide, tracked over 20 s in bins of 0.1 s; three sensors; the tool draws a circle of 2 m.
TrackRun example_run() {
  TrackRun run{.begin = 5.0, .end = 25.0, .rows = 4000};
  run.verdict = {"Use it: 2 joint positions tracked", Usability::use, {}};
  run.positions = {{.name = "swing <1>", .rotates = true}, {.name = "mast", .rotates = false}};
  run.sensors = {{.name = "chassis"}, {.name = "boom"}, {.name = "tool"}};
  run.joints = {{.name = "swing <1>"}, {.name = "mast"}};
  for (int i = 0; i < 200; ++i) {
    const double t = 0.1 * i;
    run.time.push_back(5.05 + t);
    run.positions[0].low.push_back(30.0 * degree * std::sin(t) - 1e-3);
    run.positions[0].high.push_back(30.0 * degree * std::sin(t) + 1e-3);
    run.positions[0].sd.push_back(0.2 * degree);
    run.positions[1].low.push_back(0.25 + 0.1 * std::cos(t));
    run.positions[1].high.push_back(0.25 + 0.1 * std::cos(t));
    run.positions[1].sd.push_back(0.004 - 1e-5 * i);
    run.tool.push_back(Vec3(2.0 * std::cos(t), 2.0 * std::sin(t), 1.0));
    run.tool_sd.push_back(0.01);
    for (TrackSensorCurve& sensor : run.sensors) sensor.innovation.push_back(1.0 + 0.2 * std::sin(3.0 * t));
  }
  return run;
}

TrackEvent alarm(TrackAlarmKind kind, int sensor, int joint, double since, double until) {
  return {.alarm = {.kind = kind, .sensor = sensor, .joint = joint, .since = since, .strength = 2.3},
          .until = until,
          .sentence = "something <odd> happened"};
}

std::string body_of(const Page& page, const std::string& id) {
  for (const html::Section& section : page.sections)
    if (section.id == id) return section.body;
  return "";
}

/// Numbers of the path of the first element of a class.
std::vector<double> path_numbers(const std::string& svg, const std::string& kind) {
  const auto at = svg.find(" d=\"", svg.find("class=\"" + kind)) + 4;
  std::string path = svg.substr(at, svg.find('"', at) - at);
  for (char& c : path)
    if (std::isalpha(static_cast<unsigned char>(c)) || c == ',') c = ' ';
  std::istringstream stream(path);
  std::vector<double> numbers;
  for (double x = 0.0; stream >> x;) numbers.push_back(x);
  return numbers;
}

TEST(TrackPage, HasASectionForEachQuestion) {
  TrackRun run = example_run();
  std::vector<std::string> ids;
  for (const html::Section& section : track_page(run).sections) ids.push_back(section.id);
  ASSERT_GE(ids.size(), 6u);
  EXPECT_EQ(std::vector<std::string>(ids.begin(), ids.begin() + 3),
            (std::vector<std::string>{"positions", "alarms", "sensors"}));
  EXPECT_EQ(body_of(track_page(run), "log"), "");
  run.remarks = {"12 rows were out of order"};
  EXPECT_TRUE(shows(body_of(track_page(run), "log"), "12 rows were out of order"));
}

TEST(TrackPage, FactsOfTheRunStandBesideTheVerdict) {
  const std::string first = track_page(example_run()).first;
  EXPECT_TRUE(shows(first, "chip good"));
  EXPECT_TRUE(shows(first, "<dt>Sensors</dt><dd>3</dd><dt>Log</dt><dd>20.0 s</dd><dt>Rows</dt><dd>4000</dd>")) << first;
  EXPECT_TRUE(shows(first, "Path of the tool"));
}

TEST(TrackPositions, AreInDegreesOrMillimetresWithTheRangeOfTheRun) {
  const TrackRun run = example_run();
  const std::string body = body_of(track_page(run), "positions");
  EXPECT_TRUE(shows(body, "swing &lt;1&gt;"));
  EXPECT_FALSE(shows(body, "swing <1>")) << "a name is no markup";
  EXPECT_TRUE(shows(body, ">deg<"));
  EXPECT_TRUE(shows(body, ">mm<"));
  double low = 1e9, high = -1e9;
  for (const double value : run.positions[1].low) low = std::min(low, value), high = std::max(high, value);
  EXPECT_TRUE(shows(body, html::fixed(1e3 * low, 1))) << body;
  EXPECT_TRUE(shows(body, html::fixed(1e3 * high, 1)));
  EXPECT_TRUE(shows(body, html::fixed(1e3 * run.positions[1].sd.back(), 2))) << "sd at the end";
  EXPECT_TRUE(shows(body, html::fixed(1e3 * run.positions[1].sd.front(), 2))) << "largest sd";
}

TEST(TrackPositions, ThatAreUnknownAreNotDrawn) {
  TrackRun run = example_run();
  EXPECT_EQ(count_of(position_drawings(run), "<svg"), 2u);
  for (std::size_t i = 0; i < run.time.size(); ++i)
    run.positions[1].low[i] = run.positions[1].high[i] = run.positions[1].sd[i] = no_value;
  EXPECT_EQ(count_of(position_drawings(run), "<svg"), 1u);
  EXPECT_TRUE(shows(body_of(track_page(run), "positions"), "–")) << "an unknown number is a dash";
  run.positions.clear();
  EXPECT_EQ(position_drawings(run), "");
}

TEST(TrackPositions, ALongRunIsDrawnWithFewPointsThatKeepItsExtremes) {
  TrackRun run = example_run();
  run.positions.resize(1);
  run.time.clear();
  TrackCurve& curve = run.positions[0];
  curve.low.clear(), curve.high.clear(), curve.sd.clear();
  constexpr int bins = 20000;
  for (int i = 0; i < bins; ++i) {
    run.time.push_back(5.0 + 20.0 * i / bins);
    curve.low.push_back(i == 7777 ? -1.0 : 0.0);
    curve.high.push_back(i == 12345 ? 1.0 : 0.0);
    curve.sd.push_back(1e-4);
  }
  const std::string drawing = position_drawings(run);
  EXPECT_LT(drawing.size(), 60000u);
  const auto first = path_numbers(drawing, "line-after");  // x and y in turn
  ASSERT_GT(first.size(), 100u);
  double lowest = -1e9, usual = first[1];
  for (std::size_t i = 1; i < first.size(); i += 2) lowest = std::max(lowest, first[i]);
  EXPECT_GT(lowest, usual + 20.0) << "the one low value is seen: y grows downwards";
}

TEST(TrackAlarms, AreBarsInOneRowForEachSubject) {
  TrackRun run = example_run();
  EXPECT_EQ(alarm_drawing(run), "");
  EXPECT_TRUE(shows(body_of(track_page(run), "alarms"), "There was no alarm"));
  run.events = {alarm(TrackAlarmKind::sensor_moved, 1, -1, 7.0, 9.0),
                alarm(TrackAlarmKind::sensor_lost, 1, -1, 12.0, 13.0),
                alarm(TrackAlarmKind::joint_changed, -1, 1, 15.0, no_value),
                alarm(TrackAlarmKind::does_not_fit, -1, -1, 15.0, 16.0)};
  const std::string drawing = alarm_drawing(run);
  EXPECT_EQ(count_of(drawing, "fill-bad"), 4u);
  for (const char* subject : {">boom<", ">mast<", ">chain<"}) EXPECT_TRUE(shows(drawing, subject)) << subject;
  EXPECT_TRUE(shows(drawing, "something &lt;odd&gt; happened"));
  const std::string table = body_of(track_page(run), "alarms");
  EXPECT_TRUE(shows(table, ">end<")) << "one is active to the end";
  EXPECT_TRUE(shows(table, ">9.00<"));
}

TEST(TrackAlarms, OverlappingOnesAreOneStripeBehindTheCurves) {
  TrackRun run = example_run();
  run.positions.resize(1);
  run.events = {alarm(TrackAlarmKind::sensor_moved, 1, -1, 7.0, 9.0),
                alarm(TrackAlarmKind::sensor_lost, 2, -1, 8.0, 10.0),
                alarm(TrackAlarmKind::sensor_lost, 2, -1, 14.0, 15.0)};
  EXPECT_EQ(count_of(position_drawings(run), "class=\"stripe\""), 2u);
}

TEST(TrackSensors, AreDrawnWithTheLevelThatIsExpected) {
  TrackRun run = example_run();
  const std::string drawing = innovation_drawing(run);
  for (const TrackSensorCurve& sensor : run.sensors) EXPECT_TRUE(shows(drawing, ">" + sensor.name + "<"));
  EXPECT_TRUE(shows(drawing, "as expected"));
  for (TrackSensorCurve& sensor : run.sensors) std::ranges::fill(sensor.innovation, no_value);
  EXPECT_EQ(innovation_drawing(run), "");
  EXPECT_TRUE(shows(body_of(track_page(run), "sensors"), "Not computed in this run"));
}

TEST(TrackTool, WithoutAPathThereIsNoDrawing) {
  TrackRun run = example_run();
  EXPECT_TRUE(shows(tool_path_drawing(run), "line-after"));
  std::ranges::fill(run.tool, Vec3::Constant(no_value));
  EXPECT_EQ(tool_path_drawing(run), "");
  EXPECT_FALSE(shows(track_page(run).first, "Path of the tool"));
}

TEST(TrackPage, OfAnEmptyRunIsStillAPage) {
  TrackRun run;
  run.verdict = {"Do not use it: the log does not fit the chain", Usability::do_not_use, {}};
  const Page page = track_page(run);
  EXPECT_TRUE(shows(page.first, "chip bad"));
  EXPECT_TRUE(shows(body_of(page, "alarms"), "There was no alarm"));
}

}  // namespace
}  // namespace kinfer::report

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/track/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/report/parts/html.hpp"
#include "kinfer/report/parts/plot.hpp"
#include "kinfer/report/parts/scene.hpp"

namespace kinfer::report {
namespace {

constexpr std::size_t points_on_paper = 500;
constexpr double two_sided_95 = 1.96;

svg::Axis time_axis(const TrackRun& run) {
  return {.label = "time [s]", .low = run.begin, .high = std::max(run.end, run.begin + 1e-3)};
}

std::string alarm_subject(const TrackRun& run, const TrackAlarm& alarm) {
  if (alarm.sensor >= 0 && static_cast<std::size_t>(alarm.sensor) < run.sensors.size())
    return run.sensors[static_cast<std::size_t>(alarm.sensor)].name;
  if (alarm.joint >= 0 && static_cast<std::size_t>(alarm.joint) < run.joints.size())
    return run.joints[static_cast<std::size_t>(alarm.joint)].name;
  return "chain";
}

double end_of(const TrackRun& run, const TrackEvent& event) {
  return std::isnan(event.until) ? run.end : event.until;
}

/// Spans of time in which at least one alarm was active, in order.
std::vector<std::pair<double, double>> times_with_alarms(const TrackRun& run) {
  std::vector<std::pair<double, double>> spans, merged;
  for (const TrackEvent& event : run.events) spans.emplace_back(event.alarm.since, end_of(run, event));
  std::ranges::sort(spans);
  for (const auto& span : spans)
    if (merged.empty() || span.first > merged.back().second)
      merged.push_back(span);
    else
      merged.back().second = std::max(merged.back().second, span.second);
  return merged;
}

std::string position_drawing(const TrackRun& run, const TrackCurve& curve) {
  const double unit = curve.rotates ? 1.0 / degree : 1e3;
  const std::size_t step = std::max<std::size_t>(1, run.time.size() / points_on_paper);
  std::vector<double> time, low, high, band_low, band_high, all;
  for (std::size_t i = 0; i < run.time.size(); i += step) {
    double least = NAN, most = NAN, sd = NAN;
    for (std::size_t k = i; k < std::min(i + step, run.time.size()); ++k) {
      least = std::fmin(least, unit * curve.low[k]);
      most = std::fmax(most, unit * curve.high[k]);
      sd = std::fmax(sd, unit * curve.sd[k]);
    }
    if (!std::isfinite(least)) continue;
    const double half = std::isfinite(sd) ? two_sided_95 * sd : 0.0;
    time.push_back(run.time[i]);
    low.push_back(least);
    high.push_back(most);
    band_low.push_back(least - half);
    band_high.push_back(most + half);
  }
  if (time.size() < 2) return "";
  all = low;
  all.insert(all.end(), high.begin(), high.end());
  const svg::Axis axis = svg::axis_for(curve.rotates ? "[deg]" : "[mm]", all, svg::From::least);
  svg::Plot plot(time_axis(run), axis, {480.0, 190.0});
  for (const auto& [begin, end] : times_with_alarms(run)) plot.window(begin, end, "stripe");
  std::vector<double> outline = time, edge = band_low;
  outline.insert(outline.end(), time.rbegin(), time.rend());
  edge.insert(edge.end(), band_high.rbegin(), band_high.rend());
  for (double& value : edge) value = std::clamp(value, axis.low, axis.high);
  plot.line(outline, edge, "band");
  plot.line(time, low, "line-after");
  if (step > 1 || low != high) plot.line(time, high, "line-after");
  return fmt::format("<div><h4>{}</h4>{}</div>", html::escape(curve.name),
                     plot.svg(fmt::format("Position of {} over time", curve.name)));
}

}  // namespace

std::string position_drawings(const TrackRun& run) {
  std::string drawings;
  for (const TrackCurve& curve : run.positions) drawings += position_drawing(run, curve);
  return drawings.empty() ? "" : "<div class=\"two\">" + drawings + "</div>";
}

std::string tool_path_drawing(const TrackRun& run) {
  svg::Scene scene;
  std::vector<Vec3> path;
  const std::size_t step = std::max<std::size_t>(1, run.tool.size() / (2 * points_on_paper));
  for (std::size_t i = 0; i < run.tool.size(); i += step)
    if (run.tool[i].allFinite()) path.push_back(run.tool[i]);
  if (path.size() < 2) return "";
  Vec3 least = path.front(), most = path.front();
  for (const Vec3& point : path) least = least.cwiseMin(point), most = most.cwiseMax(point);
  const double size = 0.15 * std::max((most - least).maxCoeff(), 1e-3);
  scene.line(path, "line-after");
  for (Eigen::Index k = 0; k < 3; ++k) {
    scene.line({Vec3::Zero(), size * Vec3::Unit(k)}, "arm");
    scene.name(1.15 * size * Vec3::Unit(k), std::string(1, "xyz"[k]));
  }
  scene.dot(Vec3::Zero(), 5.0, "ins");
  scene.dot(path.back(), 4.0, "tool");
  scene.name(path.back(), "tool");
  return scene.svg({640.0, 420.0}, "Path of the tool in space");
}

std::string innovation_drawing(const TrackRun& run) {
  constexpr double least = 1e-2;
  std::vector<double> all{0.3, 3.0};
  for (const TrackSensorCurve& sensor : run.sensors)
    for (const double value : sensor.innovation)
      if (value > least) all.push_back(value);
  if (all.size() < 4) return "";
  svg::Plot plot(time_axis(run), svg::log_axis_for("innovation", all), {960.0, 260.0});
  for (std::size_t s = 0; s < run.sensors.size(); ++s) {
    std::vector<double> time, value;
    for (std::size_t i = 0; i < run.time.size(); ++i)
      if (run.sensors[s].innovation[i] > least)
        time.push_back(run.time[i]), value.push_back(run.sensors[s].innovation[i]);
    if (time.size() < 2) continue;
    plot.line(time, value, s % 3 == 0 ? "line-after" : s % 3 == 1 ? "line-before" : "line-rest");
    plot.words(time.back(), value.back(), "level", run.sensors[s].name);
  }
  plot.across(1.0, "border", "as expected");
  return plot.svg("Innovation of each sensor over time");
}

std::string alarm_drawing(const TrackRun& run) {
  if (run.events.empty()) return "";
  std::vector<std::string> subjects;
  for (const TrackEvent& event : run.events) {
    const std::string subject = alarm_subject(run, event.alarm);
    if (std::ranges::find(subjects, subject) == subjects.end()) subjects.push_back(subject);
  }
  const auto rows = static_cast<double>(subjects.size());
  svg::Plot plot(time_axis(run), {.label = "", .low = 0.0, .high = rows, .numbers = svg::AxisNumbers::hidden},
                 {960.0, 70.0 + 36.0 * rows});
  for (const TrackEvent& event : run.events) {
    const std::string subject = alarm_subject(run, event.alarm);
    const auto row = static_cast<double>(std::ranges::find(subjects, subject) - subjects.begin());
    plot.bar(event.alarm.since, end_of(run, event), row + 0.1, row + 0.5, "fill-bad", event.sentence);
    plot.words(event.alarm.since, row + 0.6, "", subject);
  }
  return plot.svg("Alarms on a time line");
}

}  // namespace kinfer::report

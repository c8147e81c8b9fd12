// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/identify/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "kinfer/report/parts/chain_view.hpp"
#include "kinfer/report/parts/html.hpp"
#include "kinfer/report/parts/pages.hpp"
#include "kinfer/report/parts/plot.hpp"
#include "kinfer/report/parts/scene.hpp"

namespace kinfer::pages {
namespace {

using Json = nlohmann::json;

Vec3 vector_or_zero(const Json& json) {
  return json.is_array() ? Vec3(json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>())
                         : Vec3(Vec3::Zero());
}

/// world_T_sensor at one frame of the joint trajectory.
std::map<std::string, Pose> sensor_frames(const Json& evidence, std::size_t frame) {
  const Json &playback = evidence.at("motion").at("playback"), &chain_json = evidence.at("chain");
  ChainView chain = chain_view(chain_json);
  std::vector<double> q;
  if (frame < playback.at("q").size()) q = numbers(playback.at("q").at(frame));
  if (const Json& root = playback.at("root"); !root.empty()) {
    const auto r = numbers(root.at(std::min(frame, root.size() - 1)));
    chain.base = {Quat(r[0], r[1], r[2], r[3]).normalized().toRotationMatrix(), Vec3::Zero()};
  }
  std::map<std::string, Pose> frames{{string_at(evidence, "root"), chain.base}};
  const auto joints = placed(chain, q);
  for (std::size_t i = 0; i < joints.size(); ++i) frames[chain.joints[i].name] = joints[i].frame;
  return frames;
}

void draw_joint(svg::Scene& scene, const Json& evidence, const Json& joint, const std::map<std::string, Pose>& frames,
                double size) {
  const auto parent = frames.find(string_at(joint, "parent")), child = frames.find(string_at(joint, "child"));
  if (parent == frames.end() || child == frames.end()) return;
  const Vec3 point = child->second * vector_or_zero(joint.at("point_in_child"));
  const Vec3 axis = child->second.rotation * vector_or_zero(joint.at("axis_in_child"));
  const auto open = [&](const char* key, const Pose& frame) {
    for (const Json& direction : joint.at(key)) {
      const Vec3 along = 0.25 * size * (frame.rotation * vector_or_zero(direction));
      scene.line({point - along, point + along}, "open");
    }
  };
  open("not_identifiable_in_parent", parent->second);
  open("not_identifiable_in_child", child->second);
  scene.line({point, child->second.position}, "arm");
  scene.line({point - 0.12 * size * axis, point + 0.12 * size * axis}, "joint-axis");
  for (const Json& next : evidence.at("joints"))
    if (string_at(next, "parent") == string_at(joint, "child"))
      scene.line({point, child->second * vector_or_zero(next.at("point_in_parent"))}, "link");
  if (string_at(joint, "parent") == string_at(evidence, "root"))
    scene.line({parent->second.position, parent->second * vector_or_zero(joint.at("point_in_parent"))}, "link");
  scene.dot(point, 4.0, "joint");
}

const Json* trace_of(const Json& evidence, const std::string& sensor, const char* quantity) {
  for (const Json& trace : evidence.at("motion").at("traces"))
    if (string_at(trace, "sensor") == sensor && string_at(trace, "quantity") == quantity) return &trace;
  return nullptr;
}

double residual_rms(const Json& trace) {
  const double held = trace.value("rms_holdout", 0.0);
  return held > 0.0 ? held : trace.value("rms_fitted", 0.0);
}

/// The axis with the largest range.
std::size_t most_active_axis(const Json& trace) {
  std::size_t best = 0;
  double widest = -1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    double low = 0.0, high = 0.0;
    for (const double v : numbers(trace.at("measured").at(k).at("low")))
      if (v < low) low = v;
    for (const double v : numbers(trace.at("measured").at(k).at("high")))
      if (v > high) high = v;
    if (high - low > widest) widest = high - low, best = k;
  }
  return best;
}

/// Merges every `step` bins into one, by maximum or minimum.
std::vector<double> decimate(const std::vector<double>& values, std::size_t step, bool largest) {
  std::vector<double> result;
  for (std::size_t i = 0; i < values.size(); i += step) {
    double best = NAN;
    for (std::size_t k = i; k < std::min(i + step, values.size()); ++k)
      if (std::isfinite(values[k]) && (!std::isfinite(best) || (largest ? values[k] > best : values[k] < best)))
        best = values[k];
    result.push_back(best);
  }
  return result;
}

std::string trace_drawing(const Json& evidence, const Json& trace) {
  constexpr std::size_t bins_on_paper = 250;
  const std::vector<double> time = numbers(evidence.at("motion").at("time"));
  const std::size_t step = std::max<std::size_t>(1, time.size() / bins_on_paper), axis = most_active_axis(trace);
  const auto band = [&](const char* which, const char* side) {
    return decimate(numbers(trace.at(which).at(axis).at(side)), step, std::string_view(side) == "high");
  };
  std::vector<double> t;
  for (std::size_t i = 0; i < time.size(); i += step) t.push_back(time[i]);
  std::vector<double> all = band("measured", "low");
  for (const double v : band("measured", "high")) all.push_back(v);
  for (const double v : band("residual", "low")) all.push_back(v);
  std::string unit = string_at(trace, "unit");
  if (unit.ends_with("^2")) unit.replace(unit.size() - 2, 2, "²");
  svg::Plot plot({.label = "time [s]", .low = time.front(), .high = time.back()},
                 svg::axis_for(fmt::format("{} [{}]", "xyz"[axis], unit), all, svg::From::least), {480.0, 190.0});
  for (const Json& window : evidence.at("motion").at("held_out"))
    plot.window(window.at(0).get<double>(), window.at(1).get<double>(), "stripe");
  plot.area(t, band("measured", "low"), band("measured", "high"), "area-before");
  plot.area(t, band("predicted", "low"), band("predicted", "high"), "area-after");
  plot.area(t, band("residual", "low"), band("residual", "high"), "area-rest");
  return fmt::format(
      "<div><h4>{}, {} {}</h4>{}</div>", html::escape(string_at(trace, "sensor")),
      html::escape(string_at(trace, "quantity") == "rate" ? "angular rate" : string_at(trace, "quantity")), "xyz"[axis],
      plot.svg("Measured and predicted motion and their difference"));
}

}  // namespace

std::string identified_machine_drawing(const Json& evidence) {
  const std::size_t count = evidence.at("motion").at("playback").at("q").size();
  const auto frames = sensor_frames(evidence, count / 2);
  svg::Scene scene;
  for (const Json& sensor : evidence.at("order").at("sensors")) {
    const auto frame = frames.find(sensor.get<std::string>());
    if (frame == frames.end()) continue;
    scene.dot(frame->second.position, 5.0, "ins");
    scene.name(frame->second.position, frame->first);
  }
  const double size = 2.0 * scene.radius();
  for (const Json& joint : evidence.at("joints")) draw_joint(scene, evidence, joint, frames, size);
  return scene.svg({640, 460}, "The identified machine: segments, sensors, joint axes");
}

/// "0.016 m/s²": difference of the accelerations of the common point as measured on both segments.
std::string residual_text(const Json& evidence, const std::string& a, const std::string& b) {
  for (const Json& pair : evidence.at("order").at("pairs")) {
    const std::string first = string_at(pair, "first"), second = string_at(pair, "second");
    if ((first == a && second == b) || (first == b && second == a))
      return html::short_number(pair.at("residual").get<double>()) + " m/s²";
  }
  return "";
}

std::string tree_drawing(const Json& evidence) {
  constexpr double column = 150.0, row = 46.0, width = 80.0, height = 26.0;
  std::map<std::string, std::pair<double, double>> places;
  double rows = 0.0, columns = 0.0;
  std::string lines, boxes;
  const auto place = [&](const auto& self, const std::string& sensor, double depth) -> double {
    double first = -1.0, last = -1.0;
    for (const Json& joint : evidence.at("joints"))
      if (string_at(joint, "parent") == sensor) {
        last = self(self, string_at(joint, "child"), depth + 1.0);
        if (first < 0.0) first = last;
      }
    const double y = first < 0.0 ? row * rows++ : 0.5 * (first + last);
    places[sensor] = {column * depth, y};
    columns = std::max(columns, depth);
    return y;
  };
  place(place, string_at(evidence, "root"), 0.0);
  for (const Json& joint : evidence.at("joints")) {
    const auto [x0, y0] = places[string_at(joint, "parent")];
    const auto [x1, y1] = places[string_at(joint, "child")];
    const double x = 0.5 * (x0 + width + x1), y = 0.5 * (y0 + y1) + 0.5 * height;
    lines += fmt::format(
        "<path class=\"axis\" d=\"M{} {}L{} {}\"/><text class=\"tx\" x=\"{}\" y=\"{}\">{}</text>"
        "<text class=\"tx\" x=\"{}\" y=\"{}\">{}</text>",
        x0 + width, y0 + 0.5 * height, x1, y1 + 0.5 * height, x, y - 6, html::escape(string_at(joint, "type")), x,
        y + 15, residual_text(evidence, string_at(joint, "parent"), string_at(joint, "child")));
  }
  for (const auto& [sensor, at] : places)
    boxes += fmt::format(
        "<rect class=\"node\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"6\"/><text class=\"tx node\" "
        "x=\"{}\" y=\"{}\">{}</text>",
        at.first, at.second, width, height, at.first + 0.5 * width, at.second + 17,
        html::escape(sensor.size() > 10 ? sensor.substr(0, 9) + "…" : sensor));
  return fmt::format(
      "<div class=\"scroll\" tabindex=\"0\"><svg class=\"plot tree\" style=\"min-width:{2:.0f}px;max-width:{0:.0f}px\" "
      "viewBox=\"-4 -4 {0} "
      "{1}\" role=\"img\" aria-label=\"Which segment "
      "hangs on which\">{3}{4}</svg></div>",
      column * columns + width + 8, row * std::max(1.0, rows) - row + height + 8, 0.8 * (column * columns + width),
      lines, boxes);
}

std::string residual_drawing(const Json& evidence) {
  const Json* worst = nullptr;
  for (const Json& sensor : evidence.at("order").at("sensors"))
    if (const Json* trace = trace_of(evidence, sensor.get<std::string>(), "acceleration"))
      if (!worst || residual_rms(*trace) > residual_rms(*worst)) worst = trace;
  if (!worst) return "";
  const double motion = worst->value("rms_measured", 0.0), rest = residual_rms(*worst);
  const auto bar = [&](const char* kind, const char* words, double value) {
    return fmt::format(
        "<div class=\"gain-row {}\"><span class=\"gain-name\">{}</span><span class=\"gain-track\"><i "
        "style=\"width:{:.1f}%\"></i></span><span class=\"gain-value\"><b>{}</b> m/s²</span></div>",
        kind, words, 100.0 * value / std::max(motion, rest), html::short_number(value));
  };
  return "<div class=\"gain\" role=\"img\" aria-label=\"Motion and what of it the chain leaves unexplained\">" +
         bar("before", "motion", motion) + bar("after", "left", rest) + "</div>";
}

std::string trace_drawings(const Json& evidence) {
  std::string text;
  for (const Json& trace : evidence.at("motion").at("traces")) text += trace_drawing(evidence, trace);
  return "<div class=\"still two\">" + text + "</div>";
}

}  // namespace kinfer::pages

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/parts/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/report/parts/html.hpp"

namespace kinfer::report::svg {
namespace {

constexpr double farthest = 1e6;                                        // units of a drawing; beyond, nothing is seen
constexpr double left = 58.0, right = 12.0, top = 12.0, bottom = 44.0;  // margins around the plot area

double place(const Axis& axis, double value) {
  if (axis.scale == Scale::linear) return (value - axis.low) / (axis.high - axis.low);
  const double floor = std::max(value, axis.low * 1e-3);
  return std::log(floor / axis.low) / std::log(axis.high / axis.low);
}

std::vector<double> powers_of_ten(const Axis& axis, int count) {
  const int first = static_cast<int>(std::ceil(std::log10(axis.low) - 1e-9));
  const int last = static_cast<int>(std::floor(std::log10(axis.high) + 1e-9));
  const int step = std::max(1, (last - first) / count + 1);
  std::vector<double> list;
  for (int k = first; k <= last; k += step) list.push_back(std::pow(10.0, k));
  return list;
}

std::string tick_text(double value, double step, Scale scale) {
  if (scale == Scale::logarithmic) {
    const int power = static_cast<int>(std::lround(std::log10(value)));
    if (power >= -3 && power <= 4) return fmt::format("{:g}", value);
    return fmt::format("10<tspan class=\"power\" dy=\"-5\">{}</tspan>", html::fixed(power, 0));
  }
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  return html::fixed(value, decimals);
}

std::string title_of(std::string_view tip) {
  return tip.empty() ? "" : fmt::format("<title>{}</title>", html::escape(tip));
}

}  // namespace

std::string coordinate(double value) {
  if (std::isnan(value)) value = 0.0;  // of an axis without extent or an altered file: still a drawing
  std::string text = fmt::format("{:.1f}", std::clamp(value, -farthest, farthest));
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text == "-0" ? "0" : text;
}

std::string dots(const std::string& points, double radius, std::string_view kind) {
  return points.empty() ? ""
                        : fmt::format("<path class=\"dots {}\" stroke-width=\"{}\" d=\"{}\"/>", kind,
                                      coordinate(2.0 * radius), points);
}

std::vector<double> ticks(const Axis& axis, int count) {
  if (axis.scale == Scale::logarithmic) return powers_of_ten(axis, count);
  const double raw = (axis.high - axis.low) / count;
  if (!(raw > 0.0) || !std::isfinite(raw)) return {};
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double part = raw / power;
  const double step = power * (part <= 1.0 ? 1.0 : part <= 2.0 ? 2.0 : part <= 5.0 ? 5.0 : 10.0);
  std::vector<double> list;
  const double first = std::ceil(axis.low / step - 1e-9);
  for (int i = 0; i <= 2 * count; ++i) {  // bounded: k + 1 is k where the axis is narrow and far from zero
    const double k = first + i;
    if (!(k * step <= axis.high + 1e-9 * step)) break;
    list.push_back(k == 0.0 ? 0.0 : k * step);
  }
  return list;
}

Axis axis_for(std::string label, const std::vector<double>& values, From from) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double v : values)
    if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  if (!(low <= high)) low = 0.0, high = 1.0;
  if (from == From::zero) low = std::min(0.0, low);
  const double air = high > low ? 0.05 * (high - low) : std::max(1e-9, 0.1 * std::abs(high));
  return {std::move(label), from == From::zero && low == 0.0 ? 0.0 : low - air, high + air, Scale::linear};
}

Axis log_axis_for(std::string label, const std::vector<double>& values) {
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  for (const double v : values)
    if (std::isfinite(v) && v > 0.0) low = std::min(low, v), high = std::max(high, v);
  if (high == 0.0) low = 0.1, high = 1.0;
  low = std::clamp(low, 1e-300, 1e300), high = std::clamp(high, low, 1e300);
  return {std::move(label), low / 1.3, high * 1.3, Scale::logarithmic};
}

Plot::Plot(Axis x, Axis y, Size size) : x_(std::move(x)), y_(std::move(y)), size_(size) {}

double Plot::px(double x) const {
  return left + place(x_, x) * (size_.width - left - right);
}
double Plot::py(double y) const {
  return size_.height - bottom - place(y_, y) * (size_.height - top - bottom);
}

void Plot::bar(double x0, double x1, double y0, double y1, std::string_view kind, std::string_view tip) {
  if (!std::isfinite(x0 + x1) || !std::isfinite(y0 + y1)) return;
  marks_ += fmt::format("<rect class=\"{}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\">{}</rect>", kind,
                        coordinate(px(x0)), coordinate(py(y1)), coordinate(std::max(0.5, px(x1) - px(x0))),
                        coordinate(std::max(0.0, py(y0) - py(y1))), title_of(tip));
}

void Plot::dot(double x, double y, double radius, std::string_view kind, std::string_view attributes,
               std::string_view tip) {
  if (!std::isfinite(x) || !std::isfinite(y)) return;
  const std::string title = title_of(tip);
  marks_ +=
      fmt::format("<circle class=\"{}\" cx=\"{}\" cy=\"{}\" r=\"{}\"{}{}", kind, coordinate(px(x)), coordinate(py(y)),
                  coordinate(radius), attributes, title.empty() ? "/>" : ">" + title + "</circle>");
}

void Plot::cloud(const std::vector<double>& x, const std::vector<double>& y, double radius, std::string_view kind) {
  std::string points;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (std::isfinite(x[i]) && std::isfinite(y[i]))
      points += fmt::format("M{} {}h0", coordinate(px(x[i])), coordinate(py(y[i])));
  marks_ += dots(points, radius, kind);
}

void Plot::line(const std::vector<double>& x, const std::vector<double>& y, std::string_view kind) {
  std::string path;
  bool drawing = false;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const bool shown = std::isfinite(x[i]) && std::isfinite(y[i]);
    if (shown) path += fmt::format("{}{} {}", drawing ? "L" : "M", coordinate(px(x[i])), coordinate(py(y[i])));
    drawing = shown;
  }
  marks_ += fmt::format("<path class=\"{}\" d=\"{}\"/>", kind, path);
}

void Plot::area(const std::vector<double>& x, const std::vector<double>& low, const std::vector<double>& high,
                std::string_view kind) {
  std::string path;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (std::isfinite(low[i]) && std::isfinite(high[i]))
      path +=
          fmt::format("M{} {}V{}", coordinate(px(x[i])), coordinate(py(high[i]) - 0.4), coordinate(py(low[i]) + 0.4));
  marks_ += fmt::format("<path class=\"{}\" d=\"{}\"/>", kind, path);
}

void Plot::across(double y, std::string_view kind, std::string_view words) {
  if (!std::isfinite(y)) return;
  const std::string at = coordinate(py(y));
  marks_ += fmt::format("<path class=\"{}\" d=\"M{} {}H{}\"/><text class=\"level\" x=\"{}\" y=\"{}\">{}</text>", kind,
                        coordinate(left), at, coordinate(size_.width - right), coordinate(size_.width - right - 4),
                        coordinate(py(y) - 5), html::escape(words));
}

void Plot::window(double x0, double x1, std::string_view kind) {
  if (!std::isfinite(x0 + x1)) return;
  marks_ += fmt::format("<rect class=\"{}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>", kind, coordinate(px(x0)),
                        coordinate(top), coordinate(px(x1) - px(x0)), coordinate(size_.height - top - bottom));
}

void Plot::words(double x, double y, std::string_view kind, std::string_view text) {
  if (!std::isfinite(x) || !std::isfinite(y)) return;
  marks_ += fmt::format("<text class=\"{}\" x=\"{}\" y=\"{}\">{}</text>", kind, coordinate(px(x)), coordinate(py(y)),
                        html::escape(text));
}

std::string Plot::axes() const {
  const double x0 = left, x1 = size_.width - right, y0 = size_.height - bottom, y1 = top;
  std::string grid, labels;
  const auto y_ticks = y_.numbers == AxisNumbers::hidden ? std::vector<double>{} : ticks(y_, 4), x_ticks = ticks(x_, 5);
  const auto step = [](const std::vector<double>& t) { return t.size() > 1 ? t[1] - t[0] : 1.0; };
  for (const double t : y_ticks) {
    grid += fmt::format("M{} {}H{}", coordinate(x0), coordinate(py(t)), coordinate(x1));
    labels += fmt::format("<text class=\"ty\" x=\"{}\" y=\"{}\">{}</text>", coordinate(x0 - 7), coordinate(py(t) + 4),
                          tick_text(t, step(y_ticks), y_.scale));
  }
  std::string marks;
  for (const double t : x_ticks) {
    marks += fmt::format("M{} {}v5", coordinate(px(t)), coordinate(y0));
    labels += fmt::format("<text class=\"tx\" x=\"{}\" y=\"{}\">{}</text>", coordinate(px(t)), coordinate(y0 + 18),
                          tick_text(t, step(x_ticks), x_.scale));
  }
  labels += fmt::format("<text class=\"lx\" x=\"{}\" y=\"{}\">{}</text>", coordinate(0.5 * (x0 + x1)),
                        coordinate(size_.height - 6), html::escape(x_.label));
  labels += fmt::format("<text class=\"ly\" transform=\"translate(13 {})rotate(-90)\">{}</text>",
                        coordinate(0.5 * (y0 + y1)), html::escape(y_.label));
  return fmt::format("<path class=\"grid\" d=\"{}\"/><path class=\"axis\" d=\"M{} {}H{}{}\"/>{}", grid, coordinate(x0),
                     coordinate(y0), coordinate(x1), marks, labels);
}

std::string Plot::svg(std::string_view description) const {
  return fmt::format(
      "<svg class=\"plot\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">{}<g class=\"marks\">{}</g></svg>",
      coordinate(size_.width), coordinate(size_.height), html::escape(description), axes(), marks_);
}

std::string heat_map(const std::vector<std::string>& names, const std::vector<std::vector<double>>& values,
                     std::string_view description) {
  constexpr double cell = 14.0, margin = 74.0, faint = 0.15, strong = 0.5;
  const double side = margin + cell * static_cast<double>(names.size()) + 8.0;
  std::string marks, labels;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double middle = margin + cell * (static_cast<double>(i) + 0.5);
    labels += fmt::format("<text class=\"hy\" x=\"{}\" y=\"{}\">{}</text>", coordinate(margin - 5),
                          coordinate(middle + 4), html::escape(names[i]));
    labels += fmt::format("<text class=\"hx\" transform=\"translate({} {})rotate(-90)\">{}</text>",
                          coordinate(middle + 4), coordinate(margin - 5), html::escape(names[i]));
    for (std::size_t k = 0; k < names.size(); ++k) {
      const double v = values[i][k];
      if (!(std::abs(v) >= faint) || !std::isfinite(v)) continue;
      marks += fmt::format(
          "<rect class=\"{}\" fill-opacity=\"{:.2f}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\">{}</rect>",
          i == k  ? "self"
          : v > 0 ? "plus"
                  : "minus",
          std::min(std::abs(v), 1.0), coordinate(margin + cell * static_cast<double>(k)),
          coordinate(margin + cell * static_cast<double>(i)), coordinate(cell - 1), coordinate(cell - 1),
          i == k || std::abs(v) < strong ? "" : title_of(fmt::format("{} and {}: {:.2f}", names[i], names[k], v)));
    }
  }
  return fmt::format(
      "<svg class=\"plot heat\" viewBox=\"0 0 {0} {0}\" role=\"img\" aria-label=\"{1}\">"
      "<rect class=\"field\" x=\"{2}\" y=\"{2}\" width=\"{3}\" height=\"{3}\"/>{4}{5}</svg>",
      coordinate(side), html::escape(description), coordinate(margin - 1),
      coordinate(cell * static_cast<double>(names.size()) + 1), marks, labels);
}

}  // namespace kinfer::report::svg

// SPDX-License-Identifier: Apache-2.0
#include "studies/paper1/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

namespace kinfer::study::paper1_study {
namespace {

constexpr double width = 900.0, height = 260.0, left = 80.0, right = 170.0, top = 30.0, bottom = 45.0;

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double share(double value) const { return high > low ? (value - low) / (high - low) : 0.5; }
};

double on_scale(double value, Scale scale) {
  return scale == Scale::linear ? value : std::log10(std::max(value, 1e-12));
}

std::string text(double x, double y, const std::string& words, const char* anchor, const char* colour = "#333") {
  return fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='{}' fill='{}'>{}</text>\n", x, y, anchor, colour, words);
}

std::string chart_svg(const Chart& chart, double offset) {
  Range x, y;
  for (const Line& line : chart.lines) {
    for (const double value : line.x) x.take(value);
    for (const double value : line.y) y.take(on_scale(value, chart.y_scale));
  }
  const double inner_width = width - left - right, inner_height = height - top - bottom;
  const auto px = [&](double value) { return left + inner_width * x.share(value); };
  const auto py = [&](double value) { return offset + top + inner_height * (1.0 - y.share(value)); };
  std::string svg = text(left, offset + 18.0, chart.title, "start");
  svg += fmt::format("<rect x='{}' y='{}' width='{}' height='{}' fill='none' stroke='#999'/>\n", left, offset + top,
                     inner_width, inner_height);
  for (int tick = 0; tick <= 4; ++tick) {
    const double xv = x.low + 0.25 * tick * (x.high - x.low), yv = y.low + 0.25 * tick * (y.high - y.low);
    svg += text(px(xv), offset + height - bottom + 16.0, fmt::format("{:.4g}", xv), "middle");
    svg += text(left - 6.0, py(yv) + 4.0,
                fmt::format("{:.3g}", chart.y_scale == Scale::linear ? yv : std::pow(10.0, yv)), "end");
  }
  svg += text(left + 0.5 * inner_width, offset + height - 10.0, chart.x_label, "middle");
  svg += fmt::format("<text transform='translate(16 {:.1f}) rotate(-90)' text-anchor='middle' fill='#333'>{}</text>\n",
                     offset + top + 0.5 * inner_height, chart.y_label);
  for (std::size_t k = 0; k < chart.lines.size(); ++k) {
    const Line& line = chart.lines[k];
    svg += fmt::format("<polyline fill='none' stroke='{}' stroke-width='1.2' points='", line.colour);
    for (std::size_t i = 0; i < line.x.size(); ++i)
      svg += fmt::format("{:.1f},{:.1f} ", px(line.x[i]), py(on_scale(line.y[i], chart.y_scale)));
    svg += "'/>\n" + text(width - right + 8.0, offset + top + 14.0 + 16.0 * static_cast<double>(k), line.label, "start",
                          line.colour.c_str());
  }
  return svg;
}

}  // namespace

void write_svg(const std::filesystem::path& path, const std::vector<Chart>& charts) {
  std::ofstream file(path);
  file << fmt::format(
              "<svg xmlns='http://www.w3.org/2000/svg' width='{0}' height='{1}' viewBox='0 0 {0} {1}' "
              "font-family='sans-serif' font-size='11'>\n",
              width, height * static_cast<double>(charts.size()))
       << "<rect width='100%' height='100%' fill='white'/>\n";
  for (std::size_t i = 0; i < charts.size(); ++i) file << chart_svg(charts[i], height * static_cast<double>(i));
  file << "</svg>\n";
}

}  // namespace kinfer::study::paper1_study

// SPDX-License-Identifier: Apache-2.0
#include "output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "kinfer/io/files/text_file.hpp"

namespace kinfer::paper2 {
namespace {

constexpr double width = 640, height = 360, left = 70, right = 20, top = 40, bottom = 50;
constexpr const char* colours[] = {"#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e", "#8c564b", "#17becf"};

std::string joined(const std::vector<std::string>& cells, const char* separator) {
  std::string line;
  for (const std::string& cell : cells) line += (line.empty() ? "" : separator) + cell;
  return line;
}

std::string text(double x, double y, const std::string& words, const char* anchor = "middle", const char* more = "") {
  return fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='{}' {}>{}</text>\n", x, y, anchor, more, words);
}

std::string frame(const std::string& title, const std::string& x_label, const std::string& y_label) {
  std::string svg = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {} {}' font-family='sans-serif' font-size='12'>\n"
      "<rect width='100%' height='100%' fill='white'/>\n<rect x='{}' y='{}' width='{}' height='{}' fill='none' "
      "stroke='black'/>\n",
      width, height, left, top, width - left - right, height - top - bottom);
  svg += text(width / 2, 24, title, "middle", "font-size='14'");
  svg += text(width / 2, height - 12, x_label);
  return svg +
         text(16, height / 2, y_label, "middle", fmt::format("transform='rotate(-90 16 {})'", height / 2).c_str());
}

double x_at(double share) {
  return left + share * (width - left - right);
}
double y_at(double share) {
  return height - bottom - share * (height - top - bottom);
}

std::string y_tick(double share, const std::string& label) {
  return fmt::format("<line x1='{0}' x2='{1}' y1='{2:.1f}' y2='{2:.1f}' stroke='#ddd'/>\n", left, width - right,
                     y_at(share)) +
         text(left - 6, y_at(share) + 4, label, "end");
}

}  // namespace

std::string TextTable::csv() const {
  std::string out = joined(header, ",") + "\n";
  for (const auto& row : rows) out += joined(row, ",") + "\n";
  return out;
}

std::string TextTable::markdown() const {
  std::string out = "| " + joined(header, " | ") + " |\n|";
  for (std::size_t i = 0; i < header.size(); ++i) out += "---|";
  for (const auto& row : rows) out += "\n| " + joined(row, " | ") + " |";
  return out + "\n";
}

std::string bar_svg(const std::string& title, const std::string& x_label, const std::string& y_label,
                    const std::vector<double>& y) {
  const double highest = 1.1 * std::max(1e-300, *std::max_element(y.begin(), y.end()));
  std::string svg = frame(title, x_label, y_label);
  for (int i = 0; i <= 4; ++i) svg += y_tick(i / 4.0, fmt::format("{:.3g}", highest * i / 4));
  const double n = static_cast<double>(y.size());
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double share = y[i] / highest, x = x_at((static_cast<double>(i) + 0.15) / n);
    svg += fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' fill='{}'/>\n", x, y_at(share),
                       0.7 * (width - left - right) / n, y_at(0) - y_at(share), colours[0]);
    if ((i + 1) % 10 == 0 || i == 0)
      svg += text(x_at((static_cast<double>(i) + 0.5) / n), height - bottom + 16, fmt::format("{}", i + 1));
  }
  return svg + "</svg>\n";
}

std::string line_svg(const std::string& title, const std::string& x_label, const std::string& y_label,
                     const std::vector<Series>& series) {
  double low = 1e300, high = -1e300;
  std::size_t longest = 2;
  for (const Series& s : series) {
    longest = std::max(longest, s.y.size());
    for (const double y : s.y)
      if (y > 0.0) low = std::min(low, std::log10(y)), high = std::max(high, std::log10(y));
  }
  low = std::floor(low), high = std::max(low + 1.0, std::ceil(high));
  std::string svg = frame(title, x_label, y_label);
  for (int decade = static_cast<int>(low); decade <= high; ++decade)
    svg += y_tick((decade - low) / (high - low), fmt::format("1e{}", decade));
  const double last = static_cast<double>(longest - 1);
  for (int i = 0; i <= 4; ++i) svg += text(x_at(i / 4.0), height - bottom + 16, fmt::format("{:.0f}", last * i / 4));
  for (std::size_t k = 0; k < series.size(); ++k) {
    std::string points;
    for (std::size_t i = 0; i < series[k].y.size(); ++i)
      if (series[k].y[i] > 0.0)
        points += fmt::format("{:.1f},{:.1f} ", x_at(static_cast<double>(i) / last),
                              y_at((std::log10(series[k].y[i]) - low) / (high - low)));
    svg += fmt::format("<polyline points='{}' fill='none' stroke='{}' stroke-width='1.5'/>\n", points, colours[k % 7]);
    svg += text(width - right - 8, top + 16 + 15 * static_cast<double>(k), series[k].name, "end",
                fmt::format("fill='{}'", colours[k % 7]).c_str());
  }
  return svg + "</svg>\n";
}

void write(const std::filesystem::path& path, const std::string& content) {
  if (const auto done = write_text_file(path, content); !done) {
    fmt::print(stderr, "{}\n", done.error().what);
    std::exit(2);
  }
}

}  // namespace kinfer::paper2

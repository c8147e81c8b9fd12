// SPDX-License-Identifier: Apache-2.0
// Lists of points without header, as laser trackers and their programs write them: "x y z", "name x y z", and
// SpatialAnalyzer's "Collection::Group::Target, x, y, z".
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>

#include "kinfer/io/pose_set/foreign/tracker_file.hpp"

namespace kinfer {
namespace {

constexpr const char* slashes = "//";
constexpr std::string_view list_delimiters = "\t;, ";

/// How the rows of a list are cut, and where the coordinates stand.
struct ListShape {
  char delimiter = blanks;
  char decimal = '.';
  std::size_t names = 0;  // cells before the coordinates
  std::size_t cells = 3;  // that are used
};

bool is_number(std::string_view cell, char decimal) {
  const auto value = parse_number(cell, decimal);
  return value && std::isfinite(*value);
}

/// Up to three cells of names, three numbers, and whatever follows.
std::optional<ListShape> shape_of(const std::vector<std::string>& cells, char delimiter, char decimal) {
  constexpr std::size_t most_names = 3;                                       // collection, group, target
  if (!cells.empty() && cells.front().starts_with('$')) return std::nullopt;  // a sentence of an instrument's protocol
  std::size_t names = 0;
  while (names < cells.size() && names < most_names && !is_number(cells[names], decimal)) ++names;
  if (names == 0 && cells.size() >= 4) {
    // Four numbers: a number as the name, and the coordinates.
    double whole = 0.0;
    const bool is_whole = std::modf(*parse_number(cells[0], decimal), &whole) == 0.0;
    if (!is_whole || cells.size() > 4) return std::nullopt;
    names = 1;
  }
  if (cells.size() < names + 3) return std::nullopt;
  for (std::size_t c = names; c < names + 3; ++c)
    if (!is_number(cells[c], decimal)) return std::nullopt;
  return ListShape{delimiter, decimal, names, names + 3};
}

/// The shape that the first rows of a text agree about.
std::optional<ListShape> list_shape(std::string_view head) {
  constexpr int looked_at = 8;
  const std::vector<std::string> comments{slashes};
  for (const char delimiter : list_delimiters)
    for (const char decimal : {'.', ','}) {
      if (decimal == delimiter) continue;
      std::optional<ListShape> shape;
      bool agree = true;
      LineReader lines(head, head.starts_with("\xEF\xBB\xBF") ? 3 : 0, 0, comments);
      for (int row = 0; row < looked_at && agree && lines.next_content_line(); ++row) {
        if (lines.after() >= head.size() && row > 0) break;  // may be cut
        const auto found = shape_of(cells_of(lines.line(), delimiter), delimiter, decimal);
        agree = found && (!shape || found->names == shape->names);
        if (agree) shape = found;
      }
      if (agree && shape) return shape;
    }
  return std::nullopt;
}

/// The unit that a comment states; empty where none does.
std::string stated_unit(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, const char*>, 5> words{
      {{"millimeter", "mm"}, {"(mm)", "mm"}, {" mm", "mm"}, {"inch", "in"}, {"meter", "m"}}};
  for (std::size_t at = 0; at < text.size();) {
    std::string line(take_line(text, at));
    if (!line.starts_with(slashes) && !line.starts_with('#')) break;
    std::ranges::transform(line, line.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (line.find("unit") == std::string::npos) continue;
    for (const auto& [word, unit] : words)
      if (line.find(word) != std::string::npos) return unit;
  }
  return {};
}

/// [units of the file] largest extent of the points along an axis.
double extent_of(const ForeignRows& rows, const ListShape& shape) {
  double largest = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    for (std::size_t row = 0; row < rows.rows(); ++row)
      if (const auto value = parse_number(rows.cell(row, shape.names + axis), shape.decimal);
          value && std::isfinite(*value))
        lowest = std::min(lowest, *value), highest = std::max(highest, *value);
    if (highest > lowest) largest = std::max(largest, highest - lowest);
  }
  return largest;
}

}  // namespace

bool is_spatial_analyzer(std::string_view head) {
  const auto shape = list_shape(head);
  if (!shape || shape->names == 0) return false;
  const std::vector<std::string> comments{slashes};
  LineReader lines(head, 0, 0, comments);
  return shape->names == 3 || (lines.next_content_line() && lines.line().find("::") != std::string_view::npos);
}

bool is_point_list(std::string_view head) {
  return list_shape(head).has_value();
}

Result<PoseTable> read_point_list(std::string_view text, const std::string& name, const PoseTableChoice* choice) {
  const auto shape = list_shape(text);
  if (!shape) return error("{}:1: expected rows of x, y, z or name, x, y, z", name);
  const std::size_t begin = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
  TrackerFile file{.rows = ForeignRows(text, begin, 0, shape->delimiter, {slashes})};
  file.decimal = shape->decimal;
  if (shape->names > 0) file.name = shape->names - 1;
  file.markers = {{.name = "point", .position = {shape->names, shape->names + 1, shape->names + 2}}};
  const std::string stated = stated_unit(text.substr(begin));
  if (stated == "in") return error("{}: the unit inch is not read; export in mm or m", name);
  // No robot's poses span less than 20 mm or more than 20 m.
  constexpr double least_mm = 20.0;
  const double extent = extent_of(file.rows, *shape);
  file.length_unit = !stated.empty() ? stated : extent > least_mm ? "mm" : "m";
  if (stated.empty())
    file.remarks.push_back(fmt::format("{}: the file states no unit; as its points span {:.4g}, they are read in {}",
                                       name, extent, file.length_unit));
  return marker_table(std::move(file), name, choice);
}

}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
// Marker positions of motion capture: OpenSim's .trc, Qualisys' .tsv, OptiTrack Motive's .csv.
#include <algorithm>
#include <map>

#include "kinfer/io/pose_set/foreign/tracker_file.hpp"

namespace kinfer {
namespace {

constexpr int most_header_lines = 64;

/// Lines before the data by their first cell, and where the data begin.
struct HeaderLines {
  std::map<std::string, std::vector<std::string>> values{};  // without the first cell
  std::size_t data = 0;
  int lines = 0;
};

double positive_number(const std::vector<std::string>* cells) {
  const auto value = cells && !cells->empty() ? parse_number(cells->front()) : std::nullopt;
  return value && *value > 0.0 ? *value : 0.0;
}

const std::vector<std::string>* value_of(const HeaderLines& header, const std::string& key) {
  const auto found = header.values.find(key);
  return found == header.values.end() ? nullptr : &found->second;
}

// ---- Qualisys ----

bool begins_with_a_number(const std::vector<std::string>& cells) {
  return !cells.empty() && parse_number(cells.front()).has_value();
}

/// Lines "KEY\tvalue …" until the first row of numbers; the line of column names is under "Frame" or "columns".
HeaderLines qualisys_header(std::string_view text) {
  HeaderLines header;
  for (std::size_t at = 0; at < text.size() && header.lines < most_header_lines;) {
    header.data = at;
    std::vector<std::string> cells = cells_of(take_line(text, at), '\t');
    if (begins_with_a_number(cells)) return header;
    ++header.lines;
    if (cells.empty()) continue;
    const std::string key = cells.front();
    if (key != "Frame" && key != "Time") cells.erase(cells.begin());
    header.values.emplace(key, std::move(cells));
  }
  return header;
}

/// Columns by the names over them ("A X", then Y and Z), else three a marker behind frame and time.
void place_qualisys_markers(const HeaderLines& header, bool is_body, std::size_t width, TrackerFile& file) {
  const auto* columns = value_of(header, "Frame");
  if (!columns) columns = value_of(header, "Time");
  const std::size_t rest = width >= 3 * file.markers.size() ? width - 3 * file.markers.size() : 0;
  if (columns && std::ranges::find(*columns, "Time") != columns->end())
    file.time = static_cast<std::size_t>(std::ranges::find(*columns, "Time") - columns->begin());
  else if (!columns && rest == 2)
    file.time = 1;
  constexpr std::size_t body_columns = 16;  // X Y Z, three angles, residual, nine elements of a rotation
  std::size_t next = columns && file.time ? *file.time + 1 : columns ? 1 : rest == 2 ? 2 : 0;
  for (TrackedMarker& marker : file.markers) {
    const auto named =
        columns ? std::ranges::find(*columns, marker.name + " X") : std::vector<std::string>::const_iterator();
    if (columns && named != columns->end()) next = static_cast<std::size_t>(named - columns->begin());
    marker.is_body = is_body;
    marker.position = {next, next + 1, next + 2};
    next += is_body ? body_columns : 3;
  }
}

// ---- Motive ----

struct MotiveLabels {
  std::vector<std::string> types, names, kinds, axes;
};

std::string label_at(const std::vector<std::string>& labels, std::size_t column) {
  return column < labels.size() ? labels[column] : std::string();
}

/// Columns of one kind ("Position") of the asset that `column` belongs to, by axis ("XYZ", "WXYZ").
template <std::size_t n>
std::optional<std::array<std::size_t, n>> asset_columns(const MotiveLabels& labels, std::size_t column,
                                                        const char* kind, std::string_view axes) {
  std::array<std::size_t, n> found{};
  for (std::size_t a = 0; a < n; ++a) {
    std::size_t c = column;
    const auto is_same = [&] {
      return label_at(labels.names, c) == label_at(labels.names, column) &&
             label_at(labels.types, c) == label_at(labels.types, column);
    };
    while (c < labels.axes.size() && is_same() &&
           !(label_at(labels.kinds, c) == kind && labels.axes[c] == axes.substr(a, 1)))
      ++c;
    if (c >= labels.axes.size() || !is_same()) return std::nullopt;
    found[a] = c;
  }
  return found;
}

std::vector<TrackedMarker> motive_markers(const MotiveLabels& labels, bool has_quaternions) {
  std::vector<TrackedMarker> markers;
  std::string before;
  for (std::size_t c = 2; c < labels.axes.size(); ++c) {
    const std::string key = label_at(labels.types, c) + "\n" + label_at(labels.names, c);
    if (key == before || label_at(labels.names, c).empty()) continue;
    before = key;
    const auto position = asset_columns<3>(labels, c, "Position", "XYZ");
    if (!position) continue;
    TrackedMarker marker{.name = label_at(labels.names, c), .position = *position};
    marker.is_body = label_at(labels.types, c) == "Rigid Body";
    if (has_quaternions) marker.quaternion = asset_columns<4>(labels, c, "Rotation", "WXYZ");
    markers.push_back(std::move(marker));
  }
  return markers;
}

std::string value_after(const std::vector<std::string>& cells, std::string_view key) {
  const auto at = std::ranges::find(cells, key);
  return at == cells.end() || at + 1 == cells.end() ? std::string() : *(at + 1);
}

/// kinfer's unit and its count per unit of the file.
bool set_motive_unit(const std::string& unit, TrackerFile& file) {
  file.length_unit = unit == "Meters" || unit.empty() ? "m" : "mm";
  file.length_factor = unit == "Centimeters" ? 10.0 : 1.0;
  return unit.empty() || unit == "Meters" || unit == "Millimeters" || unit == "Centimeters";
}

}  // namespace

bool is_trc(std::string_view head) {
  return head.starts_with("PathFileType");
}

Result<PoseTable> read_trc(std::string_view text, const std::string& name, const PoseTableChoice* choice) {
  std::size_t at = 0;
  take_line(text, at);
  const std::vector<std::string> keys = cells_of(take_line(text, at), '\t'),
                                 values = cells_of(take_line(text, at), '\t');
  const auto units = static_cast<std::size_t>(std::ranges::find(keys, "Units") - keys.begin());
  const std::vector<std::string> names = cells_of(take_line(text, at), '\t');
  if (units >= values.size() || (values[units] != "mm" && values[units] != "m"))
    return error("{}:3: expected the unit mm or m under \"Units\", found \"{}\"", name,
                 units < values.size() ? values[units] : "");
  if (names.size() < 3 || names[1] != "Time")
    return error("{}:4: expected \"Frame#\", \"Time\" and the markers' names", name);
  take_line(text, at);  // X1 Y1 Z1 …
  TrackerFile file{.rows = ForeignRows(text, at, 5, '\t'), .length_unit = values[units], .time = 1};
  for (std::size_t c = 2; c < names.size(); ++c)
    if (!names[c].empty()) {
      const std::size_t first = 2 + 3 * file.markers.size();
      file.markers.push_back({.name = names[c], .position = {first, first + 1, first + 2}});
    }
  return marker_table(std::move(file), name, choice);
}

bool is_qualisys(std::string_view head) {
  return head.starts_with("NO_OF_FRAMES") && head.find("NO_OF_CAMERAS") != std::string_view::npos;
}

Result<PoseTable> read_qualisys(std::string_view text, const std::string& name, const PoseTableChoice* choice) {
  const HeaderLines header = qualisys_header(text);
  const auto* bodies = value_of(header, "BODY_NAMES");
  const auto* names = bodies ? bodies : value_of(header, "MARKER_NAMES");
  if (!names) return error("{}: the header has neither MARKER_NAMES nor BODY_NAMES", name);
  TrackerFile file{.rows = ForeignRows(text, header.data, header.lines, '\t'), .length_unit = "mm"};
  file.has_zeros_for_missing = true;
  file.rate = positive_number(value_of(header, "FREQUENCY"));
  for (const std::string& marker : *names)
    if (!marker.empty()) file.markers.push_back({.name = marker});
  std::size_t width = 0;
  if (file.rows.rows() > 0) {
    width = file.rows.width(0);
    while (width > 0 && file.rows.cell(0, width - 1).empty()) --width;  // a tab ends each line
  }
  place_qualisys_markers(header, bodies != nullptr, width, file);
  if (bodies) file.remarks.push_back(fmt::format("{}: the bodies' positions are used, not their orientations", name));
  return marker_table(std::move(file), name, choice);
}

bool is_motive(std::string_view head) {
  if (head.starts_with("\xEF\xBB\xBF")) head.remove_prefix(3);
  return head.starts_with("Format Version,") && head.find("\nFrame,") != std::string_view::npos;
}

Result<PoseTable> read_motive(std::string_view text, const std::string& name, const PoseTableChoice* choice) {
  std::size_t at = 0;
  const std::vector<std::string> facts = cells_of(take_line(text, at), ',');
  MotiveLabels labels;
  int lines = 1;
  while (at < text.size() && lines < most_header_lines) {
    std::vector<std::string> cells = cells_of(take_line(text, at), ',');
    ++lines;
    if (cells.size() < 3) continue;
    if (cells[0] == "Frame") {
      labels.axes = std::move(cells);
      break;
    }
    if (labels.types.empty())
      labels.types = cells;
    else if (labels.names.empty())
      labels.names = cells;
    labels.kinds = std::move(cells);  // the last before the axes
  }
  if (labels.axes.empty()) return error("{}: the header has no line \"Frame,Time (Seconds),X,Y,Z…\"", name);
  TrackerFile file{.rows = ForeignRows(text, at, lines, ','), .time = 1};
  const std::string unit = value_after(facts, "Length Units"), rotation = value_after(facts, "Rotation Type");
  if (!set_motive_unit(unit, file))
    return error("{}:1: the length unit \"{}\" is not read; export in millimeters or meters", name, unit);
  file.markers = motive_markers(labels, rotation == "Quaternion");
  return marker_table(std::move(file), name, choice);
}

}  // namespace kinfer

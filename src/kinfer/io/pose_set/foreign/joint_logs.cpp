// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/pose_set/foreign/joint_logs.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "kinfer/io/pose_set/foreign/foreign_rows.hpp"

namespace kinfer {
namespace {

/// A column of the file under kinfer's name.
struct TakenColumn {
  std::size_t column = 0;
  std::string ours;
};

/// The taken columns alone.
PoseTable with_columns(CsvTable table, const std::vector<TakenColumn>& taken) {
  PoseTable found;
  found.table.header = table.header;
  found.table.header.columns.clear();
  for (const TakenColumn& column : taken) found.table.header.columns.push_back(column.ours);
  for (std::size_t row = 0; row < table.rows(); ++row)
    for (const TakenColumn& column : taken) found.table.cells.push_back(table.cell(row, column.column));
  found.table.line = std::move(table.line);
  found.table.unquoted = std::move(table.unquoted);
  return found;
}

/// "actual_q_3": 3; empty where the column has another prefix.
std::optional<int> index_behind(std::string_view column, std::string_view prefix) {
  if (!column.starts_with(prefix) || column.size() == prefix.size() || column.size() > prefix.size() + 2)
    return std::nullopt;
  int index = 0;
  for (const char c : column.substr(prefix.size())) {
    if (c < '0' || c > '9') return std::nullopt;
    index = 10 * index + (c - '0');
  }
  return index;
}

std::string first_lines(std::string_view text, std::size_t most = 4096) {
  return std::string(text.substr(0, most));
}

// ---- KUKA ----

/// Value of an attribute (A1="…" or A1='…') inside an element's text.
std::optional<std::string_view> attribute(std::string_view element, std::string_view key) {
  for (std::size_t at = 0; (at = element.find(key, at)) != std::string_view::npos; at += key.size()) {
    const bool begins = at > 0 && std::isspace(static_cast<unsigned char>(element[at - 1]));
    std::size_t next = at + key.size();
    if (!begins || next + 1 >= element.size() || element[next] != '=') continue;
    const char quote = element[next + 1];
    if (quote != '"' && quote != '\'') continue;
    const std::size_t end = element.find(quote, next + 2);
    if (end == std::string_view::npos) return std::nullopt;
    return element.substr(next + 2, end - next - 2);
  }
  return std::nullopt;
}

/// Text of <name …/> or <name>…</name> inside a telegram, without its tag; empty where it has none.
std::string_view element_of(std::string_view telegram, std::string_view opening, std::string_view closing) {
  const auto begin = telegram.find(opening);
  if (begin == std::string_view::npos) return {};
  const std::string_view rest = telegram.substr(begin + opening.size());
  const auto end = rest.find(closing);
  return end == std::string_view::npos ? std::string_view() : rest.substr(0, end);
}

constexpr std::array axis_names{"A1", "A2", "A3", "A4", "A5", "A6"};
constexpr std::array external_names{"E1", "E2", "E3", "E4", "E5", "E6"};

std::string rsi_unit(const PoseTableChoice* choice, std::size_t joint) {
  return choice && joint < choice->translates.size() && choice->translates[joint] ? "[mm]" : "[deg]";
}

Result<PoseTable> read_rsi_telegrams(std::string_view text, const std::string& name, const PoseTableChoice* choice) {
  PoseTable found;
  found.contents.assign(axis_names.begin(), axis_names.end());
  const std::size_t wanted = choice ? choice->joints.size() : axis_names.size();
  if (wanted > axis_names.size() + external_names.size())
    return error("{}: the robot has {} joints; RSI telegrams hold six axes and six external ones", name, wanted);
  auto& columns = found.table.header.columns;
  columns.push_back("t[ms]");
  for (std::size_t j = 0; j < wanted; ++j) columns.push_back(fmt::format("q{}{}", j + 1, rsi_unit(choice, j)));
  int line = 1;
  std::size_t counted = 0;
  for (std::size_t at = 0; (at = text.find("<Rob", at)) != std::string_view::npos;) {
    const std::size_t end = std::min(text.find("</Rob>", at), text.size());
    const std::string_view telegram = text.substr(at, end - at);
    line += static_cast<int>(std::ranges::count(text.substr(counted, at - counted), '\n'));
    counted = at;
    at = end;
    if (telegram.find("<AIPos") == std::string_view::npos) continue;
    const std::string_view clock = element_of(telegram, "<IPOC>", "</IPOC>");
    const std::string_view axes = element_of(telegram, "<AIPos", ">"), external = element_of(telegram, "<EIPos", ">");
    if (clock.empty()) return error("{}:{}: a telegram without <IPOC>, its time", name, line);
    found.table.cells.push_back(clock);
    for (std::size_t j = 0; j < wanted; ++j) {
      const bool is_axis = j < axis_names.size();
      const char* key = is_axis ? axis_names[j] : external_names[j - axis_names.size()];
      const auto value = attribute(is_axis ? axes : external, key);
      if (!value) return error("{}:{}: a telegram without {} in <{}>", name, line, key, is_axis ? "AIPos" : "EIPos");
      found.table.cells.push_back(*value);
    }
    found.table.line.push_back(line);
  }
  if (found.table.rows() == 0) return error("{}: no telegram holds <AIPos>, the measured axis positions", name);
  found.table.header.line = found.table.line.front();
  return found;
}

Result<PoseTable> read_rsi_table(std::string_view text, const std::string& name, const PoseTableChoice* choice) {
  KINFER_TRY(table, split_csv(text, name, CsvFormat{.delimiter = automatic, .decimal = automatic}));
  std::vector<TakenColumn> taken;
  std::vector<std::string> contents;
  for (std::size_t c = 0; c < table.header.columns.size(); ++c) {
    const std::string& column = table.header.columns[c];
    if (column.ends_with("IPOC") && taken.empty()) taken.push_back({c, "t[ms]"});
    for (std::size_t j = 0; j < axis_names.size(); ++j)
      if (column.ends_with(axis_names[j]) && column.find("AIPos") != std::string::npos) {
        taken.push_back({c, fmt::format("q{}{}", j + 1, rsi_unit(choice, j))});
        contents.emplace_back(axis_names[j]);
      }
  }
  PoseTable found = with_columns(std::move(table), taken);
  found.contents = std::move(contents);
  return found;
}

// ---- OpenSim ----

/// "/jointset/knee/knee_angle/value" → "knee_angle".
std::string coordinate_name(std::string path) {
  if (path.ends_with("/value")) path.erase(path.size() - 6);
  if (const auto at = path.rfind('/'); at != std::string::npos) path.erase(0, at + 1);
  return path;
}

}  // namespace

bool is_ur_rtde(std::string_view head) {
  return first_lines(head).find("actual_q_0") != std::string::npos;
}

Result<PoseTable> read_ur_rtde(std::string_view text, const std::string& name, const PoseTableChoice*) {
  const CsvFormat format{.delimiter = automatic, .header_line = HeaderLine::with_word, .header_word = "actual_q_0"};
  KINFER_TRY(table, split_csv(text, name, format));
  std::vector<TakenColumn> taken;
  std::vector<std::string> contents;
  for (std::size_t c = 0; c < table.header.columns.size(); ++c) {
    const std::string& column = table.header.columns[c];
    if (column == "timestamp") taken.push_back({c, "t[s]"});
    if (const auto joint = index_behind(column, "actual_q_")) {
      taken.push_back({c, fmt::format("q{}[rad]", *joint + 1)});
      contents.push_back(column);
    }
  }
  PoseTable found = with_columns(std::move(table), taken);
  found.contents = std::move(contents);
  return found;
}

bool is_kuka_rsi(std::string_view head) {
  return head.find("<AIPos") != std::string_view::npos ||
         (first_lines(head).find("AIPos") != std::string::npos && first_lines(head).find("IPOC") != std::string::npos);
}

Result<PoseTable> read_kuka_rsi(std::string_view text, const std::string& name, const PoseTableChoice* choice) {
  return text.find("<AIPos") != std::string_view::npos ? read_rsi_telegrams(text, name, choice)
                                                       : read_rsi_table(text, name, choice);
}

bool is_opensim_storage(std::string_view head) {
  return head.find("inDegrees=") != std::string_view::npos && head.find("endheader") != std::string_view::npos;
}

Result<PoseTable> read_opensim_storage(std::string_view text, const std::string& name, const PoseTableChoice* choice) {
  const std::size_t end_of_header = text.find("endheader");
  if (end_of_header == std::string_view::npos) return error("{}: the file has no line \"endheader\"", name);
  const std::string_view header = text.substr(0, end_of_header);
  const bool in_degrees = header.find("inDegrees=yes") != std::string_view::npos;
  if (header.find("DataType=Quaternion") != std::string_view::npos)
    return error("{}: the file holds orientations, not joint positions", name);
  CsvFormat format{.delimiter = automatic};
  format.skip_lines = static_cast<int>(std::ranges::count(header, '\n')) + 1;
  KINFER_TRY(table, split_csv(text, name, format));
  std::vector<TakenColumn> taken;
  std::vector<std::string> contents;
  for (std::size_t c = 0; c < table.header.columns.size(); ++c) {
    const std::string coordinate = coordinate_name(table.header.columns[c]);
    if (coordinate == "time") {
      taken.push_back({c, "t[s]"});
      continue;
    }
    contents.push_back(coordinate);
    if (!choice) continue;
    const auto joint = std::ranges::find(choice->joints, coordinate);
    if (joint == choice->joints.end()) continue;
    const auto j = static_cast<std::size_t>(joint - choice->joints.begin());
    const char* unit = j < choice->translates.size() && choice->translates[j] ? "m" : in_degrees ? "deg" : "rad";
    taken.push_back({c, fmt::format("q{}[{}]", j + 1, unit)});
  }
  PoseTable found = with_columns(std::move(table), taken);
  if (choice && taken.size() <= 1) {
    std::string names;
    for (const std::string& column : contents) names += (names.empty() ? "" : ", ") + column;
    return error("{}: no coordinate is named after a joint of the robot; the file has {}", name, names);
  }
  found.contents = std::move(contents);
  return found;
}

}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "kinfer/io/pose_set/foreign/tracker_file.hpp"
#include "kinfer/io/text/format_number.hpp"

namespace kinfer {
namespace {

std::string listed(const std::vector<TrackedMarker>& markers) {
  constexpr std::size_t most = 12;
  std::string text;
  for (std::size_t i = 0; i < std::min(markers.size(), most); ++i) text += (i > 0 ? ", " : "") + markers[i].name;
  return markers.size() > most ? text + ", …" : text;
}

/// The marker that is asked for, the only one, or the only rigid body.
Result<const TrackedMarker*> chosen_marker(const TrackerFile& file, const std::string& name, const std::string& asked) {
  if (file.markers.empty()) return error("{}: the file names no markers", name);
  if (!asked.empty()) {
    const auto found = std::ranges::find(file.markers, asked, &TrackedMarker::name);
    if (found == file.markers.end())
      return error("{}: there is no marker \"{}\"; the file has {}", name, asked, listed(file.markers));
    return &*found;
  }
  if (file.markers.size() == 1) return &file.markers.front();
  if (std::ranges::count(file.markers, true, &TrackedMarker::is_body) == 1)
    return &*std::ranges::find(file.markers, true, &TrackedMarker::is_body);
  return error("{}: the file has {} markers ({}); --marker NAME says which is the tool point", name,
               file.markers.size(), listed(file.markers));
}

class MarkerTableWriter {
 public:
  MarkerTableWriter(const TrackerFile& file, const TrackedMarker& marker) : file_(file), marker_(marker) {
    auto& columns = made_.table.header.columns;
    if (file.name) columns.push_back("id");
    if (file.time || file.rate > 0.0) columns.push_back("t[s]");
    for (const char axis : {'x', 'y', 'z'}) columns.push_back(fmt::format("{}[{}]", axis, file.length_unit));
    if (marker.quaternion) columns.insert(columns.end(), {"qw", "qx", "qy", "qz"});
    made_.table.header.decimal = file.decimal;
    made_.remarks = file.remarks;
  }

  Result<PoseTable> write(const std::string& name) {
    made_.table.header.line = file_.rows.rows() > 0 ? file_.rows.line(0) : 1;
    for (std::size_t row = 0; row < file_.rows.rows(); ++row)
      if (is_measured(row)) {
        add(row);
      } else {
        ++missing_;
      }
    if (made_.table.rows() == 0) return error("{}: no row has a position of {}", name, marker_.name);
    if (missing_ > 0)
      made_.remarks.push_back(fmt::format("{}: {} of {} rows have no position of {} and are not used", name, missing_,
                                          file_.rows.rows(), marker_.name));
    return std::move(made_);
  }

 private:
  bool is_measured(std::size_t row) const {
    double largest = 0.0;
    for (const std::size_t column : marker_.position) {
      const std::string_view cell = file_.rows.cell(row, column);
      if (cell.empty()) return false;
      const auto value = parse_number(cell, file_.decimal);
      if (value && std::isnan(*value)) return false;
      largest = std::max(largest, value ? std::abs(*value) : 1.0);  // what is no number is named by the reader
    }
    return !(file_.has_zeros_for_missing && largest == 0.0);
  }

  void put(std::string_view cell) { made_.table.cells.push_back(cell); }
  void put(std::string cell) { put(std::string_view(made_.table.unquoted.emplace_back(std::move(cell)))); }

  void add(std::size_t row) {
    if (file_.name) {
      const std::string_view full = file_.rows.cell(row, *file_.name);  // "Collection::Group::Target"
      const auto colons = full.rfind("::");
      put(colons == std::string_view::npos ? full : full.substr(colons + 2));
    }
    if (file_.time)
      put(file_.rows.cell(row, *file_.time));
    else if (file_.rate > 0.0)
      put(localised(static_cast<double>(row) / file_.rate));
    for (const std::size_t column : marker_.position) {
      const std::string_view cell = file_.rows.cell(row, column);
      const auto value = parse_number(cell, file_.decimal);
      if (value && file_.length_factor != 1.0)
        put(localised(file_.length_factor * *value));
      else
        put(cell);
    }
    if (marker_.quaternion)
      for (const std::size_t column : *marker_.quaternion) put(file_.rows.cell(row, column));
    made_.table.line.push_back(file_.rows.line(row));
  }

  std::string localised(double value) const {
    std::string text = format_number(value, 1.0);
    std::ranges::replace(text, '.', file_.decimal);
    return text;
  }

  const TrackerFile& file_;
  const TrackedMarker& marker_;
  PoseTable made_;
  std::size_t missing_ = 0;
};

}  // namespace

Result<PoseTable> marker_table(TrackerFile file, const std::string& name, const PoseTableChoice* choice) {
  std::vector<std::string> contents;
  for (const TrackedMarker& marker : file.markers) contents.push_back(marker.name);
  PoseTable found;
  if (choice) {
    KINFER_TRY(marker, chosen_marker(file, name, choice->marker));
    KINFER_TRY(made, MarkerTableWriter(file, *marker).write(name));
    found = std::move(made);
  } else {
    found.table.line.resize(file.rows.rows());
    found.remarks = file.remarks;
  }
  found.contents = std::move(contents);
  found.unquoted = file.rows.take_unquoted();
  return found;
}

}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/pose_set/pose_sheet.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/expect.hpp"
#include "kinfer/io/text/csv_text.hpp"
#include "kinfer/io/text/format_number.hpp"

namespace kinfer {
PoseSheet::PoseSheet(std::size_t rows, FileUnits units) : rows_(rows), in_mm_(units == FileUnits::mm_deg) {}

double PoseSheet::angle() const {
  return in_mm_ ? degree : 1.0;
}

std::size_t PoseSheet::column(const std::string& header) {
  const auto known =
      std::find_if(columns_.begin(), columns_.end(), [&](const Column& c) { return c.header == header; });
  if (known != columns_.end()) return static_cast<std::size_t>(known - columns_.begin());
  columns_.push_back({header, std::vector<std::string>(rows_)});
  return columns_.size() - 1;
}

std::size_t PoseSheet::add_three(const std::string& prefix, const std::string& unit) {
  const std::size_t first = column(prefix + "x" + unit);
  column(prefix + "y" + unit), column(prefix + "z" + unit);
  return first;
}

void PoseSheet::set(std::size_t column, int row, std::string cell) {
  std::string& stored_cell = columns_[column].cells[row];
  KINFER_EXPECT(stored_cell.empty(), "two values of column {} in row {}", columns_[column].header, row);
  stored_cell = std::move(cell);
}

void PoseSheet::set(std::size_t column, int row, double value, double unit) {
  if (!std::isnan(value)) set(column, row, format_number(value, unit));
}

void PoseSheet::set(std::size_t first_column, int row, const Vec3& values, double unit) {
  for (int i = 0; i < 3; ++i) set(first_column + i, row, values[i], unit);
}

template <class CellOf>
void PoseSheet::write_line(std::string& text, CellOf cell_of) const {
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (i > 0) text += ',';
    text += csv_cell(cell_of(columns_[i]));
  }
  text += '\n';
}

std::string PoseSheet::csv() const {
  std::string text;
  write_line(text, [](const Column& column) -> const std::string& { return column.header; });
  for (std::size_t row = 0; row < rows_; ++row)
    write_line(text, [row](const Column& column) -> const std::string& { return column.cells[row]; });
  return text;
}

}  // namespace kinfer

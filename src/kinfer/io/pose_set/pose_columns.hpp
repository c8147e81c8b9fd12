// SPDX-License-Identifier: Apache-2.0
// The columns of a pose-set file under kinfer's names. Readers take the columns that they need, with their units; a
// column that no reader takes is an error.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/io/pose_set/column_map.hpp"
#include "kinfer/io/text/csv.hpp"
#include "kinfer/io/text/first_error.hpp"
#include "kinfer/io/text/units.hpp"

namespace kinfer {

/// Numbers of one column in SI, NaN where the cell is empty.
using NumberColumn = std::vector<double>;

/// Three columns that belong together; each row has all three or none.
struct VectorColumns {
  std::array<NumberColumn, 3> of;
  bool measured(std::size_t row) const;
  Vec3 at(std::size_t row) const { return {of[0][row], of[1][row], of[2][row]}; }
};

/// Distinct names in order of first appearance, and which of them each row has.
struct NameColumn {
  std::vector<std::string> names;
  std::vector<int> index;  ///< −1 where the cell is empty
};

class PoseColumns {
 public:
  PoseColumns(const CsvTable& table, const ColumnMap& map, FirstError& first_error);

  bool has(std::string_view name) const { return find(name) != nullptr; }
  std::vector<std::string_view> names() const;
  std::vector<std::string_view> untaken_names() const;
  std::size_t rows() const { return table_.rows(); }
  int line(std::size_t row) const { return table_.line[row]; }
  int header_line() const { return table_.header.line; }

  std::optional<NumberColumn> numbers(std::string_view name, Dimension dimension);
  std::optional<VectorColumns> vectors(const std::array<std::string, 3>& names, Dimension dimension);
  std::optional<std::vector<std::string>> texts(std::string_view name);
  std::optional<NameColumn> name_indices(std::string_view name);

  void expect_all_taken();
  void report_error(std::size_t row, const std::string& sentence) { first_error_.report(line(row), sentence); }
  void report_header_error(const std::string& sentence) { first_error_.report(header_line(), sentence); }

 private:
  struct Column {
    std::string name, unit;
    bool has_unit = false;
    std::size_t index = 0;  ///< in the table
    bool taken = false;
  };
  void use_header_names();
  void apply_map();
  std::optional<std::size_t> index_of(const ColumnHeader& theirs, std::string_view full_header);
  const Column* find(std::string_view name) const;
  Column* take(std::string_view name);
  Unit unit_of(const Column& column, Dimension dimension);
  double number(const Column& column, const Unit& unit, std::size_t row);
  void expect_one_unit(const std::array<std::string, 3>& names);

  const CsvTable& table_;
  const ColumnMap& map_;
  FirstError& first_error_;
  std::vector<Column> columns_;
};

}  // namespace kinfer

// The columns of a pose-set file under our names, taken one after the other with their unit; what nobody takes is a
// mistake.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/io/complaint.hpp"
#include "kinfer/io/csv.hpp"
#include "kinfer/io/pose_set_csv.hpp"
#include "kinfer/io/units.hpp"

namespace kinfer {

/// Numbers of one column in SI, NaN where the cell is empty.
using NumberColumn = std::vector<double>;

/// Three columns that belong together; each row has all three or none.
struct VectorColumns {
  std::array<NumberColumn, 3> of;
  bool measured(std::size_t row) const;
  Vec3 at(std::size_t row) const { return {of[0][row], of[1][row], of[2][row]}; }
};

/// Names in the order of their first row, and which of them each row has.
struct NameColumn {
  std::vector<std::string> names;
  std::vector<int> index;  ///< −1 where the cell is empty
};

class PoseColumns {
 public:
  PoseColumns(const CsvTable& table, const ColumnMap& map, Complaint& complaint);

  bool has(std::string_view name) const { return find(name) != nullptr; }
  std::vector<std::string_view> names() const;
  std::size_t rows() const { return table_.rows(); }
  int line(std::size_t row) const { return table_.line[row]; }
  int header_line() const { return table_.header.line; }

  std::optional<NumberColumn> numbers(std::string_view name, Dimension dimension);
  std::optional<VectorColumns> vectors(const std::array<std::string, 3>& names, Dimension dimension);
  std::optional<std::vector<std::string>> texts(std::string_view name);
  std::optional<NameColumn> name_indices(std::string_view name);

  void expect_all_taken();
  void complain(std::size_t row, const std::string& sentence) { complaint_.say(line(row), sentence); }
  void complain_about_header(const std::string& sentence) { complaint_.say(header_line(), sentence); }

 private:
  struct Column {
    std::string name, unit;
    bool has_unit = false;
    std::size_t place = 0;  ///< in the table
    bool taken = false;
  };
  void use_own_names();
  void use_map();
  std::optional<std::size_t> place_of(const Header& theirs, std::string_view whole);
  const Column* find(std::string_view name) const;
  Column* take(std::string_view name);
  Unit unit_of(const Column& column, Dimension dimension);
  double number(const Column& column, const Unit& unit, std::size_t row);
  void expect_one_unit(const std::array<std::string, 3>& names);

  const CsvTable& table_;
  const ColumnMap& map_;
  Complaint& complaint_;
  std::vector<Column> columns_;
};

}  // namespace kinfer

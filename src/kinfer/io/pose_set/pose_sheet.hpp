// SPDX-License-Identifier: Apache-2.0
// A pose-set file that is filled cell by cell; an empty cell means "not measured".
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kinfer/geometry/rotation.hpp"
#include "kinfer/io/text/units.hpp"

namespace kinfer {

class PoseSheet {
 public:
  PoseSheet(std::size_t rows, FileUnits units);

  /// Index of the column with this header, which is added if it is new.
  std::size_t column(const std::string& header);
  /// Index of the first of the columns `prefix`x, `prefix`y, `prefix`z, which are added.
  std::size_t add_three(const std::string& prefix, const std::string& unit);

  /// A cell is written once.
  void set(std::size_t column, int row, std::string cell);
  void set(std::size_t column, int row, double value, double unit = 1.0);
  void set(std::size_t first_column, int row, const Vec3& values, double unit);

  double length() const { return in_mm_ ? 1e-3 : 1.0; }  ///< [m] of the file's unit
  double angle() const;                                  ///< [rad] of the file's unit
  std::string in_lengths() const { return in_mm_ ? "[mm]" : "[m]"; }
  std::string in_angles() const { return in_mm_ ? "[deg]" : "[rad]"; }
  std::string in_areas() const { return in_mm_ ? "[mm^2]" : "[m^2]"; }
  std::string in_square_angles() const { return in_mm_ ? "[deg^2]" : "[rad^2]"; }
  std::string in_lengths_times_angles() const { return in_mm_ ? "[mm.deg]" : "[m.rad]"; }

  std::string csv() const;

 private:
  struct Column {
    std::string header;
    std::vector<std::string> cells;
  };
  template <class CellOf>
  void write_line(std::string& text, CellOf cell_of) const;

  std::size_t rows_;
  bool in_mm_;
  std::vector<Column> columns_;
};

}  // namespace kinfer

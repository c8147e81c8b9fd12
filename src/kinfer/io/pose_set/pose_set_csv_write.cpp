// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/expect.hpp"
#include "kinfer/io/pose_set/pose_covariances.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/io/text/format_number.hpp"

namespace kinfer {
namespace {

std::string quoted_where_needed(const std::string& text) {
  if (text.find_first_of(",\"#") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + '"';
}

/// A table that is filled cell by cell; an empty cell means "not measured".
class Sheet {
 public:
  explicit Sheet(Eigen::Index rows) : rows_(static_cast<std::size_t>(rows)) {}

  /// Returns the index of the new column.
  std::size_t add(std::string header) {
    columns_.push_back({std::move(header), std::vector<std::string>(rows_)});
    return columns_.size() - 1;
  }

  void set(std::size_t column, int row, std::string cell) {
    std::string& stored_cell = columns_[column].cells[row];
    KINFER_EXPECT(stored_cell.empty(), "two values of column {} in row {}", columns_[column].header, row);
    stored_cell = std::move(cell);
  }

  void set(std::size_t column, int row, double value, double unit = 1.0) {
    if (!std::isnan(value)) set(column, row, format_number(value, unit));
  }

  void set(std::size_t first_column, int row, const Vec3& values, double unit) {
    for (int i = 0; i < 3; ++i) set(first_column + i, row, values[i], unit);
  }

  std::string csv() const {
    std::string text;
    write_line(text, [](const Column& column) -> const std::string& { return column.header; });
    for (std::size_t row = 0; row < rows_; ++row)
      write_line(text, [row](const Column& column) -> const std::string& { return column.cells[row]; });
    return text;
  }

 private:
  struct Column {
    std::string header;
    std::vector<std::string> cells;
  };

  template <class CellOf>
  void write_line(std::string& text, CellOf cell_of) const {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (i > 0) text += ',';
      text += quoted_where_needed(cell_of(columns_[i]));
    }
    text += '\n';
  }

  std::size_t rows_;
  std::vector<Column> columns_;
};

class Writer {
 public:
  Writer(const PoseSet& set, const Chain& chain, FileUnits units)
      : set_(set),
        chain_(chain),
        in_mm_(units == FileUnits::mm_deg),
        length_(in_mm_ ? 1e-3 : 1.0),
        angle_(in_mm_ ? degree : 1.0),
        sheet_(set.rows()) {}

  std::string write() {
    write_joint_values(set_.joints, "q", "");
    write_joint_values(set_.commanded, "q", "_cmd");
    write_torques();
    write_points(-1, "");
    for (std::size_t i = 0; i < set_.targets.size(); ++i) write_points(static_cast<int>(i), set_.targets[i] + "_");
    write_orientations();
    write_orientation_deviations();
    write_distances();
    write_contacts();
    write_tilts();
    write_row_attributes();
    return sheet_.csv();
  }

 private:
  std::string with_unit(const std::string& name, bool is_length) const {
    return fmt::format("{}[{}]", name, is_length ? (in_mm_ ? "mm" : "m") : (in_mm_ ? "deg" : "rad"));
  }

  std::size_t add_three(const std::string& prefix, const char* unit) {
    const std::size_t first = sheet_.add(fmt::format("{}x{}", prefix, unit));
    sheet_.add(fmt::format("{}y{}", prefix, unit));
    sheet_.add(fmt::format("{}z{}", prefix, unit));
    return first;
  }

  void write_joint_values(const MatrixXd& values, const char* prefix, const char* suffix) {
    const std::vector<int> joints = active_joints(chain_);
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
      const bool is_prismatic = translates(chain_.joints[joints[i]].type);
      const std::size_t column = sheet_.add(with_unit(fmt::format("{}{}{}", prefix, i + 1, suffix), is_prismatic));
      for (int row = 0; row < values.cols(); ++row)
        sheet_.set(column, row, values(i, row), is_prismatic ? length_ : angle_);
    }
  }

  void write_torques() {
    for (Eigen::Index i = 0; i < set_.torques.rows(); ++i) {
      const std::size_t column = sheet_.add(fmt::format("tau{}", i + 1));
      for (int row = 0; row < set_.torques.cols(); ++row) sheet_.set(column, row, set_.torques(i, row));
    }
  }

  void write_points(int target, const std::string& prefix) {
    std::optional<std::size_t> positions, deviations, covariance;
    const char* unit = in_mm_ ? "[mm]" : "[m]";
    for (const PointMeasurement& point : set_.points) {
      if (point.target != target) continue;
      if (!positions) positions = add_three(prefix, unit);
      sheet_.set(*positions, point.row, point.position, length_);
      if (point.axes)
        write_covariance(covariance, target < 0 ? "p" : set_.targets[target], point, CovarianceQuantity::lengths);
      if (!point.sd || point.axes || target >= 0) continue;
      if (!deviations) deviations = add_three("s", unit);
      sheet_.set(*deviations, point.row, *point.sd, length_);
    }
  }

  enum class CovarianceQuantity { lengths, angles };
  /// `first`: index of the xx column, once it was added.
  template <class Measurement>
  void write_covariance(std::optional<std::size_t>& first, const std::string& of, const Measurement& measured,
                        CovarianceQuantity what) {
    const bool of_length = what == CovarianceQuantity::lengths;
    const double unit = of_length ? length_ : angle_;
    const std::string unit_name = of_length ? (in_mm_ ? "[mm^2]" : "[m^2]") : (in_mm_ ? "[deg^2]" : "[rad^2]");
    if (!first)
      for (const std::string& name : covariance_names(of)) {
        const std::size_t column = sheet_.add(name + unit_name);
        if (!first) first = column;
      }
    const Mat3 c = covariance_of(*measured.sd, measured.axes);
    std::size_t column = *first;
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) sheet_.set(column++, measured.row, c(i, j), unit * unit);
  }
  void write_cross_covariance(std::optional<std::size_t>& first, const OrientationMeasurement& measured) {
    if (!first)
      for (const std::string& name : cross_covariance_names()) {
        const std::size_t column = sheet_.add(name + (in_mm_ ? "[mm.deg]" : "[m.rad]"));
        if (!first) first = column;
      }
    for (int k = 0; k < 9; ++k)
      sheet_.set(*first + static_cast<std::size_t>(k), measured.row, (*measured.covariance_with_point)(k / 3, k % 3),
                 length_ * angle_);
  }

  void write_orientations() {
    if (set_.orientations.empty()) return;
    const std::size_t scalar = sheet_.add("qw"), vector = add_three("q", "");
    for (const OrientationMeasurement& measured : set_.orientations) {
      sheet_.set(scalar, measured.row, measured.orientation.w());
      sheet_.set(vector, measured.row, measured.orientation.vec(), 1.0);
    }
  }

  void write_orientation_deviations() {
    std::optional<std::size_t> deviations, covariance, cross;
    for (const OrientationMeasurement& measured : set_.orientations) {
      if (measured.axes) write_covariance(covariance, "r", measured, CovarianceQuantity::angles);
      if (measured.covariance_with_point) write_cross_covariance(cross, measured);
      if (!measured.sd || measured.axes) continue;
      if (!deviations) deviations = add_three("sr", in_mm_ ? "[deg]" : "[rad]");
      sheet_.set(*deviations, measured.row, *measured.sd, angle_);
    }
  }

  void write_distances() {
    if (set_.distances.empty() && set_.pairs.empty()) return;
    const std::size_t distance = sheet_.add(with_unit("distance", true));
    if (!set_.distances.empty()) {
      const std::size_t anchor = sheet_.add("anchor");
      for (const DistanceMeasurement& measured : set_.distances) {
        sheet_.set(anchor, measured.row, fmt::format("{}", measured.anchor + 1));
        sheet_.set(distance, measured.row, measured.distance, length_);
      }
    }
    if (set_.pairs.empty()) return;
    const std::size_t pair = sheet_.add("pair");
    for (std::size_t i = 0; i < set_.pairs.size(); ++i)
      for (const int row : {set_.pairs[i].row, set_.pairs[i].other}) {
        sheet_.set(pair, row, fmt::format("{}", i + 1));
        sheet_.set(distance, row, set_.pairs[i].distance, length_);
      }
  }

  void write_contacts() {
    if (!set_.contacts.empty()) {
      const std::size_t socket = sheet_.add("socket");
      for (const SocketContact& contact : set_.contacts) sheet_.set(socket, contact.row, set_.sockets[contact.socket]);
    }
    if (!set_.plane_contacts.empty()) {
      const std::size_t plane = sheet_.add("plane");
      for (const PlaneContact& contact : set_.plane_contacts)
        sheet_.set(plane, contact.row, set_.planes[contact.plane]);
    }
  }

  void write_tilts() {
    if (set_.tilts.empty()) return;
    const std::size_t tilt = add_three("tilt_", "");
    for (const TiltMeasurement& measured : set_.tilts) sheet_.set(tilt, measured.row, measured.specific_force, 1.0);
  }

  void write_numbers(const std::vector<double>& values, const char* header) {
    if (values.empty()) return;
    const std::size_t column = sheet_.add(header);
    for (std::size_t row = 0; row < values.size(); ++row) sheet_.set(column, static_cast<int>(row), values[row]);
  }

  void write_names(const std::vector<int>& index, const std::vector<std::string>& names, const char* header) {
    if (names.empty()) return;
    const std::size_t column = sheet_.add(header);
    for (std::size_t row = 0; row < index.size(); ++row)
      if (index[row] >= 0) sheet_.set(column, static_cast<int>(row), names[index[row]]);
  }

  void write_row_attributes() {
    write_numbers(set_.payload, "payload[kg]");
    write_numbers(set_.temperature, "temperature[C]");
    write_names(set_.setup, set_.setups, "setup");
    write_names(set_.tip, set_.tips, "tip");
    write_names(set_.sweep, set_.sweeps, "sweep");
    if (!set_.id.empty()) {
      const std::size_t id = sheet_.add("id");
      for (std::size_t row = 0; row < set_.id.size(); ++row) sheet_.set(id, static_cast<int>(row), set_.id[row]);
    }
    if (set_.set.empty()) return;
    const std::size_t label = sheet_.add("set");
    for (std::size_t row = 0; row < set_.set.size(); ++row)
      if (set_.set[row] != SplitLabel::none)
        sheet_.set(label, static_cast<int>(row), std::string(set_.set[row] == SplitLabel::train ? "train" : "holdout"));
  }

  const PoseSet& set_;
  const Chain& chain_;
  bool in_mm_;
  double length_, angle_;  ///< of the file's units, in SI
  Sheet sheet_;
};

}  // namespace

std::string format_pose_set_csv(const PoseSet& set, const Chain& chain, FileUnits units) {
  return Writer(set, chain, units).write();
}

}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/pose_set/pose_covariances.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

/// Columns that belong together; each row has all or none.
template <std::size_t n>
struct ColumnGroup {
  std::array<NumberColumn, n> of;

  std::ptrdiff_t given(int row) const {
    return std::count_if(of.begin(), of.end(), [&](const NumberColumn& c) { return !std::isnan(c[row]); });
  }
};
using CovarianceColumns = ColumnGroup<6>;
using CrossColumns = ColumnGroup<9>;

Mat3 symmetric_matrix_at(const CovarianceColumns& columns, int row) {
  const auto& of = columns.of;
  Mat3 c;
  c << of[0][row], of[1][row], of[2][row], of[1][row], of[3][row], of[4][row], of[2][row], of[4][row], of[5][row];
  return c;
}

Mat3 matrix_at(const CrossColumns& columns, int row) {
  Mat3 c;
  for (int k = 0; k < 9; ++k) c(k / 3, k % 3) = columns.of[k][row];
  return c;
}

template <std::size_t n>
std::optional<ColumnGroup<n>> find(PoseColumns& columns, const std::array<std::string, n>& names, Dimension dimension) {
  const auto has = [&](const std::string& name) { return columns.has(name); };
  if (std::none_of(names.begin(), names.end(), has)) return std::nullopt;
  if (const auto missing = std::find_if_not(names.begin(), names.end(), has); missing != names.end()) {
    columns.report_header_error(
        fmt::format("column {} is missing: a covariance is {} to {}", *missing, names.front(), names.back()));
    return std::nullopt;
  }
  ColumnGroup<n> found;
  for (std::size_t k = 0; k < names.size(); ++k) found.of[k] = *columns.numbers(names[k], dimension);
  return found;
}

/// Sets the covariance of one measurement.
template <class Measurement>
void set_covariance(PoseColumns& columns, const std::array<std::string, 6>& names, const CovarianceColumns& covariances,
                    Measurement& measured) {
  const auto given = covariances.given(measured.row);
  if (given == 0) return;
  const auto report_error = [&](const std::string& what) {
    columns.report_error(measured.row, fmt::format("{} to {}: {}", names.front(), names.back(), what));
  };
  if (given < 6) return report_error(fmt::format("expected six numbers or none of them, found {}", given));
  if (measured.sd) return report_error("the row has standard deviations too, expected one of both");
  const Mat3 covariance = symmetric_matrix_at(covariances, measured.row);
  const PrincipalDeviations found = principal_deviations(covariance);
  constexpr double rounding = 1e-6;  // of the largest variance: files have few digits
  const double largest = covariance.diagonal().maxCoeff();
  if (!(covariance_of(found.sd, found.axes) - covariance).isZero(rounding * std::abs(largest)))
    return report_error("expected a covariance, found a direction with a negative variance");
  measured.sd = found.sd, measured.axes = found.axes;
}

/// Whether the 6 x 6 covariance of the pose is positive definite.
bool is_positive_definite(const PointMeasurement& point, const OrientationMeasurement& orientation) {
  if (point.sd->minCoeff() <= 0.0 || orientation.sd->minCoeff() <= 0.0) return false;
  constexpr double rounding = 1e-9;  // of the variances
  const Mat3 y = correlation(*point.sd, point.axes, *orientation.sd, orientation);
  return symmetric_eigen(y.transpose() * y).values.maxCoeff() < 1.0 - rounding;
}

/// Sets the cross-covariance of each orientation with the tool point of its row.
void set_cross_covariances(PoseColumns& columns, const CrossColumns& cross, PoseSet& set) {
  const auto names = cross_covariance_names();
  std::vector<const PointMeasurement*> point_of(columns.rows(), nullptr);
  for (const PointMeasurement& point : set.points)
    if (point.target < 0) point_of[point.row] = &point;
  std::vector<bool> used(columns.rows(), false);
  const auto report_error = [&](int row, const std::string& what) {
    columns.report_error(row, fmt::format("{} to {}: {}", names.front(), names.back(), what));
  };
  for (OrientationMeasurement& measured : set.orientations) {
    const int row = measured.row;
    const auto given = cross.given(row);
    used[row] = true;
    if (given == 0) continue;
    const PointMeasurement* point = point_of[row];
    if (given < 9) {
      report_error(row, fmt::format("expected nine numbers or none of them, found {}", given));
    } else if (!point || !point->sd || !measured.sd) {
      report_error(row, "expected a position and an orientation beside it, both with p_cov and r_cov or sx and srx");
    } else {
      measured.covariance_with_point = matrix_at(cross, row);
      if (!is_positive_definite(*point, measured))
        report_error(row, "with p_cov and r_cov of the row, expected a positive definite 6 x 6 covariance of the pose");
    }
  }
  for (int row = 0; row < static_cast<int>(columns.rows()); ++row)
    if (!used[row] && cross.given(row) > 0) report_error(row, "expected an orientation beside it");
}

}  // namespace

std::array<std::string, 9> cross_covariance_names() {
  return {"pr_cov_xx", "pr_cov_xy", "pr_cov_xz", "pr_cov_yx", "pr_cov_yy",
          "pr_cov_yz", "pr_cov_zx", "pr_cov_zy", "pr_cov_zz"};
}

std::array<std::string, 6> covariance_names(const std::string& of) {
  return {of + "_cov_xx", of + "_cov_xy", of + "_cov_xz", of + "_cov_yy", of + "_cov_yz", of + "_cov_zz"};
}

void read_covariances(PoseColumns& columns, PoseSet& set) {
  for (int target = -1; target < static_cast<int>(set.targets.size()); ++target) {
    const auto names = covariance_names(target < 0 ? "p" : set.targets[target]);
    const auto covariances = find(columns, names, Dimension::area);
    if (!covariances) continue;
    for (PointMeasurement& point : set.points)
      if (point.target == target) set_covariance(columns, names, *covariances, point);
  }
  const auto names = covariance_names("r");
  if (const auto covariances = find(columns, names, Dimension::square_angle))
    for (OrientationMeasurement& measured : set.orientations) set_covariance(columns, names, *covariances, measured);
  if (const auto cross = find(columns, cross_covariance_names(), Dimension::length_times_angle))
    set_cross_covariances(columns, *cross, set);
}

void write_covariance(PoseSheet& sheet, const std::string& of, int row, const Mat3& covariance,
                      CovarianceQuantity quantity) {
  const bool of_lengths = quantity == CovarianceQuantity::lengths;
  const double unit = of_lengths ? sheet.length() : sheet.angle();
  const std::array<std::string, 6> names = covariance_names(of);
  std::array<std::size_t, 6> columns;
  for (std::size_t k = 0; k < 6; ++k)
    columns[k] = sheet.column(names[k] + (of_lengths ? sheet.in_areas() : sheet.in_square_angles()));
  std::size_t k = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) sheet.set(columns[k++], row, covariance(i, j), unit * unit);
}

void write_cross_covariance(PoseSheet& sheet, int row, const Mat3& covariance) {
  const std::array<std::string, 9> names = cross_covariance_names();
  for (int k = 0; k < 9; ++k)
    sheet.set(sheet.column(names[static_cast<std::size_t>(k)] + sheet.in_lengths_times_angles()), row,
              covariance(k / 3, k % 3), sheet.length() * sheet.angle());
}

}  // namespace kinfer

#include "kinfer/io/pose_covariances.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer {
namespace {

/// Six columns that belong together; each row has all or none.
struct CovarianceColumns {
  std::array<NumberColumn, 6> of;

  std::ptrdiff_t given(int row) const {
    return std::count_if(of.begin(), of.end(), [&](const NumberColumn& c) { return !std::isnan(c[row]); });
  }
  Mat3 at(int row) const {
    Mat3 c;
    c << of[0][row], of[1][row], of[2][row], of[1][row], of[3][row], of[4][row], of[2][row], of[4][row], of[5][row];
    return c;
  }
};

std::optional<CovarianceColumns> find(PoseColumns& columns, const std::array<std::string, 6>& names,
                                      Dimension dimension) {
  const auto has = [&](const std::string& name) { return columns.has(name); };
  if (std::none_of(names.begin(), names.end(), has)) return std::nullopt;
  if (const auto missing = std::find_if_not(names.begin(), names.end(), has); missing != names.end()) {
    columns.complain_about_header(
        fmt::format("column {} is missing: a covariance is {} to {}", *missing, names.front(), names.back()));
    return std::nullopt;
  }
  CovarianceColumns found;
  for (std::size_t k = 0; k < names.size(); ++k) found.of[k] = *columns.numbers(names[k], dimension);
  return found;
}

/// Of one measurement.
template <class Measurement>
void take(PoseColumns& columns, const std::array<std::string, 6>& names, const CovarianceColumns& covariances,
          Measurement& measured) {
  const auto given = covariances.given(measured.row);
  if (given == 0) return;
  const auto complain = [&](const std::string& what) {
    columns.complain(measured.row, fmt::format("{} to {}: {}", names.front(), names.back(), what));
  };
  if (given < 6) return complain(fmt::format("expected six numbers or none of them, found {}", given));
  if (measured.sd) return complain("the row has standard deviations too, expected one of both");
  const Mat3 covariance = covariances.at(measured.row);
  const PrincipalDeviations found = principal_deviations(covariance);
  constexpr double rounding = 1e-6;  // of the largest variance: files have few digits
  const double largest = covariance.diagonal().maxCoeff();
  if (!(covariance_of(found.sd, found.axes) - covariance).isZero(rounding * std::abs(largest)))
    return complain("expected a covariance, found a direction with a negative variance");
  measured.sd = found.sd, measured.axes = found.axes;
}

}  // namespace

std::array<std::string, 6> covariance_names(const std::string& of) {
  return {of + "_cov_xx", of + "_cov_xy", of + "_cov_xz", of + "_cov_yy", of + "_cov_yz", of + "_cov_zz"};
}

void read_covariances(PoseColumns& columns, PoseSet& set) {
  for (int target = -1; target < static_cast<int>(set.targets.size()); ++target) {
    const auto names = covariance_names(target < 0 ? "p" : set.targets[target]);
    const auto covariances = find(columns, names, Dimension::area);
    if (!covariances) continue;
    for (PointMeasurement& point : set.points)
      if (point.target == target) take(columns, names, *covariances, point);
  }
  const auto names = covariance_names("r");
  if (const auto covariances = find(columns, names, Dimension::square_angle))
    for (OrientationMeasurement& measured : set.orientations) take(columns, names, *covariances, measured);
}

}  // namespace kinfer

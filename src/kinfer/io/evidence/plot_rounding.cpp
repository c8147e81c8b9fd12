// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/plot_rounding.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer {
namespace {

/// Rounds one member of all elements for a plot.
template <class Element>
void round_column(std::vector<Element>& list, double Element::*member) {
  std::vector<double> values;
  for (const Element& element : list) values.push_back(element.*member);
  values = rounded_for_plot(std::move(values));
  for (std::size_t i = 0; i < list.size(); ++i) list[i].*member = values[i];
}

void round_if_any(std::optional<Vec3>& value) {
  if (value) value = rounded(*value);
}

}  // namespace

double rounded(double value) {
  constexpr double step = 1e-7;
  if (!std::isfinite(value)) return value;
  const double steps = std::round(value / step);
  return steps == 0.0 ? 0.0 : steps / 1e7;
}

Vec3 rounded(const Vec3& value) {
  return {rounded(value.x()), rounded(value.y()), rounded(value.z())};
}

MatrixXd rounded(const MatrixXd& values) {
  return values.unaryExpr([](double value) { return rounded(value); });
}

std::vector<double> rounded_for_plot(std::vector<double> values) {
  double largest = 0.0;
  for (const double value : values)
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  const double per_unit = largest > 0.0 ? std::pow(10.0, std::ceil(std::log10(4000.0 / largest))) : 1.0;
  for (double& value : values) {
    const double steps = std::round(value * per_unit);
    value = steps == 0.0 ? 0.0 : steps / per_unit;
  }
  return values;
}

MotionEvidence rounded(MotionEvidence motion) {
  for (Trace& trace : motion.traces)
    for (auto* signal : {&trace.measured, &trace.predicted, &trace.residual})
      for (Envelope& envelope : *signal) {
        envelope.low = rounded_for_plot(std::move(envelope.low));
        envelope.high = rounded_for_plot(std::move(envelope.high));
      }
  for (auto* times : {&motion.time, &motion.trajectory.time})
    for (double& time : *times) time = rounded(time);
  for (auto& quaternion : motion.trajectory.root)
    for (double& value : quaternion) value = rounded(value);
  motion.trajectory.q = rounded(motion.trajectory.q);
  return motion;
}

std::vector<PlotRow> rounded(std::vector<PlotRow> rows) {
  for (PlotRow& row : rows)
    for (auto* point : {&row.measured, &row.error_before, &row.error_after}) round_if_any(*point);
  round_column(rows, &PlotRow::predicted);
  return rows;
}

std::vector<WorkspacePoint> rounded(std::vector<WorkspacePoint> points) {
  for (WorkspacePoint& point : points) point.tool = rounded(point.tool);
  round_column(points, &WorkspacePoint::predicted);
  return points;
}

}  // namespace kinfer

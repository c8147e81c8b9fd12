// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/conclusion/plot_data.hpp"

#include <cmath>

#include "kinfer/calibrate/conclusion/thresholds.hpp"
#include "kinfer/estimate/poses/bundle.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer::calibrate {
namespace {

Load load_of(const PoseSet& data, int row) {
  return {data.payload.empty() ? 0.0 : data.payload[row]};
}

Vec3 point_on_tool(const Chain& chain, const PointMeasurement& point, ConstVectorRef q, const Load& load) {
  const Pose tool = forward(chain, q, load);
  return point.target < 0 ? tool.position : tool * chain.targets[point.target].xyz;
}

void add_points(CalibrationPlotData& plot_data, const CalibrationTask& task, const Chain& after) {
  for (const PointMeasurement& point : task.data.points) {
    PlotRow& row = plot_data.rows[point.row];
    if (row.measured) continue;
    const auto q = task.data.joints.col(point.row);
    const Load load = load_of(task.data, point.row);
    row.measured = point.position;
    row.error_before = point_on_tool(plot_data.before, point, q, load) - point.position;
    row.error_after = point_on_tool(after, point, q, load) - point.position;
  }
}

/// Fractional parts of k · phi^-1, phi^-2, ..., with phi the root of x^(n+1) = x + 1: covers the unit cube evenly
/// (Roberts' generalisation of the golden ratio).
VectorXd low_discrepancy_point(int k, Eigen::Index n) {
  double phi = 2.0;
  for (int i = 0; i < 30; ++i) phi = std::pow(1.0 + phi, 1.0 / static_cast<double>(n + 1));
  VectorXd point(n);
  double step = 1.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    step /= phi;
    point[i] = std::fmod(0.5 + step * (k + 1), 1.0);
  }
  return point;
}

/// The rms error by the covariance of the parameters, and by the model error there.
double with_model_error(double by_parameters, const std::optional<PredictionModel>& prediction, ConstVectorRef q) {
  if (!prediction) return by_parameters;
  return std::sqrt(by_parameters * by_parameters + model_error_at(*prediction, q).topLeftCorner<3, 3>().trace());
}

std::vector<WorkspacePoint> sample_workspace(const MatrixXd& joints, const Estimate& estimate,
                                             const std::optional<PredictionModel>& prediction) {
  const VectorXd lowest = joints.rowwise().minCoeff(), range = joints.rowwise().maxCoeff() - lowest;
  MatrixXd q(joints.rows(), thresholds::workspace_points);
  for (int k = 0; k < thresholds::workspace_points; ++k)
    q.col(k) = lowest + range.cwiseProduct(low_discrepancy_point(k, joints.rows()));
  const VectorXd errors = predicted_errors(estimate, q);
  std::vector<WorkspacePoint> points;
  for (int k = 0; k < thresholds::workspace_points; ++k)
    points.push_back(
        {forward(estimate.chain, q.col(k)).position, with_model_error(errors[k], prediction, q.col(k)), q.col(k)});
  return points;
}

}  // namespace

CalibrationPlotData make_plot_data(const CalibrationTask& task, const Chain& before, const Estimate& estimate,
                                   const std::optional<PredictionModel>& prediction) {
  CalibrationPlotData plot_data{.nominal = task.nominal, .before = before, .joints = task.data.joints};
  const VectorXd errors = predicted_errors(estimate, task.data.joints);
  for (Eigen::Index row = 0; row < errors.size(); ++row)
    plot_data.rows.push_back({.predicted = with_model_error(errors[row], prediction, task.data.joints.col(row))});
  add_points(plot_data, task, estimate.chain);
  plot_data.workspace = sample_workspace(task.data.joints, estimate, prediction);
  return plot_data;
}

}  // namespace kinfer::calibrate

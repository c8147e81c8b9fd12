// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/conclusion/plot_data.hpp"

#include <cmath>

#include "kinfer/base/parallel.hpp"
#include "kinfer/calibrate/conclusion/thresholds.hpp"
#include "kinfer/estimate/poses/bundle.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"

namespace kinfer::calibrate {
namespace {

Vec3 point_on_tool(const Chain& chain, const PointMeasurement& point, const Pose& tool) {
  return point.target < 0 ? tool.position : tool * chain.targets[point.target].xyz;
}

void add_points(CalibrationPlotData& plot_data, const CalibrationTask& task, const Chain& after, int threads) {
  const EvaluatedPoses tool_before = evaluate_poses(plot_data.before, {}, task.data, Derivative::no, threads),
                       tool_after = evaluate_poses(after, {}, task.data, Derivative::no, threads);
  for (const PointMeasurement& point : task.data.points) {
    PlotRow& row = plot_data.rows[point.row];
    if (row.measured) continue;
    row.measured = point.position;
    row.error_before = point_on_tool(plot_data.before, point, tool_before.pose[point.row]) - point.position;
    row.error_after = point_on_tool(after, point, tool_after.pose[point.row]) - point.position;
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
                                             const std::optional<PredictionModel>& prediction, int threads) {
  const VectorXd lowest = joints.rowwise().minCoeff(), range = joints.rowwise().maxCoeff() - lowest;
  MatrixXd q(joints.rows(), thresholds::workspace_points);
  for (int k = 0; k < thresholds::workspace_points; ++k)
    q.col(k) = lowest + range.cwiseProduct(low_discrepancy_point(k, joints.rows()));
  const VectorXd errors = predicted_errors(estimate, q);
  const PoseEvaluator evaluator(estimate.chain, {});
  std::vector<WorkspacePoint> points(thresholds::workspace_points);
  parallel_for(points.size(), threads, [&](std::size_t i) {
    const auto at = q.col(static_cast<Eigen::Index>(i));
    points[i] = {evaluator.pose(at).position, with_model_error(errors[static_cast<Eigen::Index>(i)], prediction, at),
                 at};
  });
  return points;
}

}  // namespace

CalibrationPlotData make_plot_data(const CalibrationTask& task, const Chain& before, const Estimate& estimate,
                                   const std::optional<PredictionModel>& prediction, int threads) {
  const MatrixXd& joints = task.data.joints;
  CalibrationPlotData plot_data{.nominal = task.nominal, .before = before, .joints = joints};
  const VectorXd errors = predicted_errors(estimate, joints);
  plot_data.rows.resize(static_cast<std::size_t>(errors.size()));
  parallel_for(plot_data.rows.size(), threads, [&](std::size_t i) {
    const auto row = static_cast<Eigen::Index>(i);
    plot_data.rows[i].predicted = with_model_error(errors[row], prediction, joints.col(row));
  });
  add_points(plot_data, task, estimate.chain, threads);
  plot_data.workspace = sample_workspace(joints, estimate, prediction, threads);
  return plot_data;
}

}  // namespace kinfer::calibrate

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/conclusion/plot_data.hpp"

#include <cmath>

#include "kinfer/calibrate/conclusion/thresholds.hpp"
#include "kinfer/estimate/poses/bundle.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/estimate/poses/pose_uncertainty.hpp"

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

/// The rms error of the tool point at each row: by the prediction model, or by the parameters alone.
std::vector<double> expected_errors(const Estimate& estimate, const std::optional<PredictionModel>& prediction,
                                    const PoseSet& rows, int threads) {
  if (!prediction) {
    const VectorXd errors = predicted_errors(estimate, rows.joints);
    return {errors.begin(), errors.end()};
  }
  std::vector<double> errors;
  for (const PoseUncertainty& at : pose_uncertainties(estimate.chain, *prediction, rows, threads))
    errors.push_back(std::sqrt(at.position.trace()));
  return errors;
}

std::vector<WorkspacePoint> sample_workspace(const MatrixXd& joints, const Estimate& estimate,
                                             const std::optional<PredictionModel>& prediction, int threads) {
  const VectorXd lowest = joints.rowwise().minCoeff(), range = joints.rowwise().maxCoeff() - lowest;
  PoseSet samples;
  samples.joints.resize(joints.rows(), thresholds::workspace_points);
  for (int k = 0; k < thresholds::workspace_points; ++k)
    samples.joints.col(k) = lowest + range.cwiseProduct(low_discrepancy_point(k, joints.rows()));
  const std::vector<double> errors = expected_errors(estimate, prediction, samples, threads);
  const std::vector<Pose> poses = evaluate_poses(estimate.chain, {}, samples, Derivative::no, threads).pose;
  std::vector<WorkspacePoint> points;
  for (std::size_t i = 0; i < poses.size(); ++i)
    points.push_back({poses[i].position, errors[i], samples.joints.col(static_cast<Eigen::Index>(i))});
  return points;
}

}  // namespace

CalibrationPlotData make_plot_data(const CalibrationTask& task, const Chain& before, const Estimate& estimate,
                                   const std::optional<PredictionModel>& prediction, int threads) {
  const MatrixXd& joints = task.data.joints;
  CalibrationPlotData plot_data{.nominal = task.nominal, .before = before, .joints = joints};
  for (const double error : expected_errors(estimate, prediction, task.data, threads))
    plot_data.rows.push_back({.predicted = error});
  add_points(plot_data, task, estimate.chain, threads);
  plot_data.workspace = sample_workspace(joints, estimate, prediction, threads);
  return plot_data;
}

double expected_error(const CalibrationPlotData& plot_data) {
  double squares = 0.0;
  for (const PlotRow& row : plot_data.rows) squares += row.predicted * row.predicted;
  return plot_data.rows.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(plot_data.rows.size()));
}

}  // namespace kinfer::calibrate

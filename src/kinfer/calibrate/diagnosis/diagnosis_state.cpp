// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/diagnosis/diagnosis_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/calibrate/diagnosis/thresholds.hpp"
#include "kinfer/calibrate/parameters/parameter_sets.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/geometry/fit.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/measurement/row_selection.hpp"

namespace kinfer::calibrate {
namespace {

/// Base from rigid alignment of the measured points with those predicted by the chain.
Chain with_aligned_base(Chain chain, const PoseSet& data) {
  chain.base = Frame{};
  const EvaluatedPoses at = evaluate_poses(chain, {}, data, Derivative::no);
  std::vector<Vec3> measured, predicted;
  for (const PointMeasurement& point : data.points) {
    measured.push_back(point.position);
    predicted.push_back(at.pose[point.row] *
                        (point.target < 0 ? Vec3::Zero().eval() : chain.targets[point.target].xyz));
  }
  chain.base = Frame::from_pose(align_points(measured, predicted));
  return chain;
}

/// The set with its point measurements only.
PoseSet keep_points_only(PoseSet data) {
  static_cast<PoseMeasurements&>(data) = {.points = std::move(data.points)};
  return data;
}

/// Fits base and tool with a robust loss; few iterations, since correct data need no more.
FrameFit refine_base_and_tool(const Chain& chain, const PoseSet& data) {
  ParameterSet frames = frame_parameters(chain, data);
  for (Parameter& parameter : frames.parameters) parameter.prior_sd = std::numeric_limits<double>::infinity();
  LeastSquaresOptions options;
  options.loss = Loss::cauchy;
  options.max_iterations = 12;
  constexpr int rounds = 3;  // the noise level decreases with the residuals
  FrameFit fit{chain, median(point_errors(chain, data))};
  for (int i = 0; i < rounds && std::isfinite(fit.median_error); ++i) {
    Weights weights;
    weights.of<PointMeasurement>().assign(data.points.size(), Vec3::Constant(std::max(fit.median_error, 1e-9)));
    const Chain from = with_small_rotations_folded(fit.chain);
    fit.chain =
        unpack(frames, from, least_squares(pose_residuals(from, frames, data, weights), pack(frames, from), options).x);
    const double before = fit.median_error;
    fit.median_error = median(point_errors(fit.chain, data));
    if (fit.median_error > 0.9 * before) break;
  }
  return fit;
}

/// Of the tool's position (rows of its twist from 0 on, [m]) or rotation (from 3 on, [rad]), base refitted.
double rms_by_tolerances(const CalibrationTask& task, Eigen::Index first) {
  ParameterSet set = geometric_parameters(task.nominal, task.data, task.tolerances);
  std::erase_if(set.parameters, [](const Parameter& p) {
    return is_own_frame_parameter(p.at, SetupFrame::base) || std::holds_alternative<FixtureNumber>(p.at);
  });
  constexpr auto most = static_cast<int>(thresholds::hypothesis_rows);
  const PoseSet data =
      select(task.data, task.data.points.empty() ? spread_indices(static_cast<int>(task.data.rows()), most)
                                                 : thinned_rows(task.data, thresholds::hypothesis_rows));
  const EvaluatedPoses at = evaluate_poses(task.nominal, set, data, Derivative::yes);
  VectorXd sd(set.free_count());
  for (Eigen::Index k = 0; k < sd.size(); ++k) sd[k] = set.free()[k]->prior_sd;
  double squares = 0.0;
  for (const Twists& twist : at.twists) squares += (twist.middleRows<3>(first) * sd.asDiagonal()).squaredNorm();
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, at.twists.size())));
}

}  // namespace

void add_finding(DiagnosisState& state, Finding finding) {
  const std::vector<int>& line = state.task.data.line;
  for (const int row : finding.rows)
    if (!line.empty()) finding.lines.push_back(line[row]);
  state.findings.push_back(std::move(finding));
}

std::optional<FrameFit> fit_frames_quickly(const Chain& nominal, const PoseSet& all) {
  const PoseSet data = keep_points_only(all);
  if (data.points.size() < thresholds::min_points_of_quick_fit) return std::nullopt;
  Chain bare = nominal;
  bare.tool.xyz.setZero();
  std::optional<FrameFit> best;
  for (const Chain& start : {nominal, bare}) {
    const FrameFit fit = refine_base_and_tool(with_aligned_base(start, data), data);
    if (!best || fit.median_error < best->median_error) best = fit;
  }
  return std::isfinite(best->median_error) ? best : std::nullopt;
}

double max_plausible_error(const CalibrationTask& task) {
  const Instrument with = task.instrument.value_or(Instrument{});
  const double sigma = std::max({with.sigma, with.sigma_distance.value_or(0.0), with.sigma_contact.value_or(0.0)});
  return thresholds::plausible_error_ratio * (rms_by_tolerances(task, 0) + sigma);
}

double max_plausible_angle(const CalibrationTask& task) {
  const Instrument with = task.instrument.value_or(Instrument{});
  const double sigma = std::max(
      {with.sigma_angle, with.sigma_direction.value_or(0.0), with.sigma_tilt.value_or(0.0) / standard_gravity});
  return thresholds::plausible_error_ratio * (rms_by_tolerances(task, 3) + sigma);
}

}  // namespace kinfer::calibrate

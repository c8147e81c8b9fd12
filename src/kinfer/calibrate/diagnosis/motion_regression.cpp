// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/diagnosis/motion_regression.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/calibrate/diagnosis/thresholds.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::calibrate {
namespace {

using Eigen::Index;

bool is_usable(const JointMotions& motion, Index row) {
  return motion.col(row).allFinite();
}

/// The linear system over the points of the usable rows, three equations each.
struct PointSystem {
  MatrixXd columns;      ///< parameters, then the other motions, then the motion
  VectorXd residual;     ///< [m] measured − predicted, large ones clipped
  std::vector<int> row;  ///< of each point
};

/// Gross errors keep their direction, but no more weight than a large residual.
void clip(VectorXd& residual) {
  std::vector<double> norms;
  for (Index i = 0; i < residual.size(); i += 3) norms.push_back(residual.segment<3>(i).norm());
  const double limit = thresholds::clipped_residual * median(norms);
  for (Index i = 0; i < residual.size(); i += 3)
    if (const double norm = norms[static_cast<std::size_t>(i / 3)]; norm > limit && norm > 0.0)
      residual.segment<3>(i) *= limit / norm;
}

PointSystem point_system(const Estimate& fit, const PoseSet& data, const JointMotions& motion,
                         const std::vector<JointMotions>& others) {
  const Chain& chain = fit.chain;
  const EvaluatedPoses at = evaluate_poses(chain, fit.parameters, data, Derivative::yes);
  std::vector<const PointMeasurement*> used;
  for (const PointMeasurement& point : data.points)
    if (is_usable(motion, point.row) &&
        std::ranges::all_of(others, [&](const JointMotions& other) { return is_usable(other, point.row); }))
      used.push_back(&point);
  const Index parameters = fit.parameters.free_count(), further = static_cast<Index>(others.size()) + 1;
  PointSystem system{MatrixXd(3 * static_cast<Index>(used.size()), parameters + further),
                     VectorXd(3 * static_cast<Index>(used.size())),
                     {}};
  for (std::size_t i = 0; i < used.size(); ++i) {
    const PointMeasurement& point = *used[i];
    const Pose& tool = at.pose[point.row];
    const Vec3 arm = point.target < 0 ? Vec3::Zero().eval() : Vec3(tool.rotation * chain.targets[point.target].xyz);
    const Chain mounted =
        data.mounting.empty() ? chain : with_mounting(chain, data.mounting[static_cast<std::size_t>(point.row)]);
    const auto by_joints =
        point_columns(jacobian(mounted, data.joints.col(point.row), load_at(chain, data, point.row)), arm);
    auto rows = system.columns.middleRows<3>(3 * static_cast<Index>(i));
    rows.leftCols(parameters) = point_columns(at.twists[point.row], arm);
    for (std::size_t k = 0; k < others.size(); ++k)
      rows.col(parameters + static_cast<Index>(k)) = by_joints * others[k].col(point.row);
    rows.col(parameters + further - 1) = by_joints * motion.col(point.row);
    system.residual.segment<3>(3 * static_cast<Index>(i)) = point.position - tool.position - arm;
    system.row.push_back(point.row);
  }
  clip(system.residual);
  return system;
}

/// Sum of squares of (weight · residual) added up within each row: the middle of the sandwich.
double squares_by_row(const VectorXd& weight, const VectorXd& residual, const std::vector<int>& row) {
  double squares = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const auto at = 3 * static_cast<Index>(i);
    sum += weight.segment<3>(at).dot(residual.segment<3>(at));
    if (i + 1 < row.size() && row[i + 1] == row[i]) continue;
    squares += sum * sum;
    sum = 0.0;
  }
  return squares;
}

}  // namespace

std::optional<MotionShare> regress_on_motion(const Estimate& fit, const PoseSet& data, const JointMotions& motion,
                                             const std::vector<JointMotions>& others) {
  if (data.points.empty()) return std::nullopt;
  PointSystem system = point_system(fit, data, motion, others);
  const Index count = system.columns.cols(), equations = system.columns.rows();
  if (equations < 2 * count) return std::nullopt;
  // Columns of unit length, so that one small ridge serves parameters of every unit and unobservable combinations.
  VectorXd length = system.columns.colwise().norm();
  for (double& l : length) l = std::max(l, 1e-300);
  const MatrixXd unit = system.columns * length.cwiseInverse().asDiagonal();
  const auto rest = unit.leftCols(count - 1);
  const VectorXd target = unit.col(count - 1);
  MatrixXd square = rest.transpose() * rest;
  square.diagonal().array() += thresholds::regression_ridge;
  const auto of_target = solve_spd(square, rest.transpose() * target),
             of_residual = solve_spd(square, rest.transpose() * system.residual);
  if (!of_target || !of_residual) return std::nullopt;
  const VectorXd own = target - rest * *of_target;
  const double own_square = own.squaredNorm();
  if (own_square < thresholds::least_own_part) return std::nullopt;
  const double slope = own.dot(system.residual) / own_square;
  const VectorXd left = system.residual - rest * (*of_residual - slope * *of_target) - slope * target;
  const double freedom = static_cast<double>(equations) / static_cast<double>(equations - count);
  MotionShare share;
  share.fraction = slope / length[count - 1];
  share.sd = std::sqrt(freedom * squares_by_row(own, left, system.row)) / own_square / length[count - 1];
  share.distance = std::abs(slope) * std::sqrt(3.0 * own_square / static_cast<double>(equations));
  share.explained = slope * slope * own_square / std::max(1e-300, left.squaredNorm() + slope * slope * own_square);
  const VectorXd rest_slopes = *of_residual - slope * *of_target;
  for (Index k = count - 1 - static_cast<Index>(others.size()); k < count - 1; ++k)
    share.others.push_back(rest_slopes[k] / length[k]);
  return share;
}

}  // namespace kinfer::calibrate

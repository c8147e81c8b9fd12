// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/start/circle_point_analysis.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kinfer/calibrate/start/initial_frames.hpp"
#include "kinfer/calibrate/start/thresholds.hpp"
#include "kinfer/geometry/fit.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer::calibrate {
namespace {

/// The measured tool point of each row; nullopt where it was not measured.
std::vector<std::optional<Vec3>> tool_points(const PoseSet& data) {
  std::vector<std::optional<Vec3>> points(data.rows());
  for (const PointMeasurement& point : data.points)
    if (point.target < 0) points[point.row] = point.position;
  return points;
}

double range(const PoseSet& data, const std::vector<int>& rows, Eigen::Index q_index) {
  double low = data.joints(q_index, rows.front()), high = low;
  for (const int row : rows) {
    low = std::min(low, data.joints(q_index, row));
    high = std::max(high, data.joints(q_index, row));
  }
  return high - low;
}

/// The joints that move within the rows.
std::vector<int> find_moving_joints(const PoseSet& data, const std::vector<int>& rows) {
  std::vector<int> moving;
  for (Eigen::Index k = 0; k < data.joints.rows(); ++k)
    if (range(data, rows, k) > thresholds::min_motion) moving.push_back(static_cast<int>(k));
  return moving;
}

Result<std::vector<Sweep>> read_marked_sweeps(const PoseSet& data) {
  std::vector<Sweep> sweeps(data.sweeps.size());
  const auto points = tool_points(data);
  for (std::size_t i = 0; i < sweeps.size(); ++i) sweeps[i].name = data.sweeps[i];
  for (Eigen::Index row = 0; row < data.rows(); ++row)
    if (data.sweep[row] >= 0 && points[row]) sweeps[data.sweep[row]].rows.push_back(static_cast<int>(row));
  for (Sweep& sweep : sweeps) {
    if (sweep.rows.size() < thresholds::min_marked_points)
      return error("sweep {} has {} measured points; a circle needs at least {}", sweep.name, sweep.rows.size(),
                   thresholds::min_marked_points);
    const std::vector<int> moving = find_moving_joints(data, sweep.rows);
    if (moving.size() != 1)
      return error("sweep {} moves {} joints; expected one joint alone", sweep.name, moving.size());
    sweep.q_index = moving.front();
  }
  return sweeps;
}

std::vector<Sweep> find_single_joint_runs(const PoseSet& data) {
  const auto points = tool_points(data);
  std::vector<Sweep> sweeps;
  std::vector<int> run;
  const auto close = [&] {
    if (run.size() >= thresholds::min_run_rows) {
      const std::vector<int> moving = find_moving_joints(data, run);
      if (moving.size() == 1 && range(data, run, moving.front()) >= thresholds::min_run_motion)
        sweeps.push_back({"", moving.front(), run});
    }
    run.clear();
  };
  for (Eigen::Index row = 0; row < data.rows(); ++row) {
    if (!points[row]) continue;
    std::vector<int> longer = run;
    longer.push_back(static_cast<int>(row));
    if (find_moving_joints(data, longer).size() > 1) {
      // The previous row may start the next sweep: adjacent sweeps share it.
      const int last = run.back();
      close();
      if (find_moving_joints(data, {last, static_cast<int>(row)}).size() == 1) run.push_back(last);
    }
    run.push_back(static_cast<int>(row));
  }
  close();
  return sweeps;
}

/// Largest standard deviation of the first two unknowns of a linear fit with this Jacobian and this scatter.
double max_sd_of_first_two(const MatrixXd& jacobian, double scatter) {
  const auto covariance = invert_spd(gram(jacobian));
  if (!covariance) return std::numeric_limits<double>::infinity();
  return scatter * std::sqrt(symmetric_eigen(covariance->topLeftCorner(2, 2)).values[1]);
}

/// Uncertainty by the linearised fit: radius and centre from the distances in the plane, tilt from the heights.
void estimate_uncertainty(SweepCircle& circle, const std::vector<Vec3>& points) {
  const auto n = static_cast<Eigen::Index>(points.size());
  const Vec3 u = any_perpendicular(circle.axis), v = circle.axis.cross(u);
  MatrixXd in_plane(n, 3), across(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vec3 r = points[i] - circle.centre;
    const double x = u.dot(r), y = v.dot(r);
    in_plane.row(i) << x / std::hypot(x, y), y / std::hypot(x, y), 1.0;
    across.row(i) << x, y, 1.0;
  }
  // 2n residuals, six estimated parameters: three of the circle in its plane, three of the plane.
  const double scatter =
      circle.rms * std::sqrt(static_cast<double>(n) / std::max(1.0, 2.0 * static_cast<double>(n) - 6.0));
  circle.centre_sd = max_sd_of_first_two(in_plane, scatter);
  circle.axis_sd = max_sd_of_first_two(across, scatter);
  const auto covariance = invert_spd(gram(in_plane));
  circle.radius_sd = covariance ? scatter * std::sqrt((*covariance)(2, 2)) : std::numeric_limits<double>::infinity();
}

/// A line in space.
struct Line {
  Vec3 point, direction;
};

/// The point of `a` nearest to `b`; the reference point of `a` if they are parallel.
Vec3 foot_of_common_perpendicular(const Line& a, const Line& b) {
  const Vec3 normal = a.direction.cross(b.direction);
  const double squared = normal.squaredNorm();
  if (squared < 1e-12) return a.point;
  return a.point + a.direction * ((b.point - a.point).cross(b.direction).dot(normal) / squared);
}

/// Origin on `a`, z along it, x along the common perpendicular of both.
Pose frame_from_axes(const Line& a, const Line& b) {
  const Vec3 z = a.direction, x = z.cross(b.direction).normalized();
  Pose pose;
  pose.rotation << x, z.cross(x), z;
  pose.position = foot_of_common_perpendicular(a, b);
  return pose;
}

Line line_of(const SweepCircle& circle) {
  return {circle.centre, circle.axis};
}

/// The axis of the swept joint as predicted by the chain.
Line predicted_axis(const Chain& chain, const PoseSet& data, const Sweep& sweep) {
  const int joint = active_joints(chain)[sweep.q_index];
  const JointPlacement placed = joint_placements(chain, data.joints.col(sweep.rows.front()))[joint];
  return {placed.point, chain.joints[joint].gain < 0.0 ? Vec3(-placed.axis) : placed.axis};
}

double distance(const Line& line, const Vec3& point) {
  return (point - line.point).cross(line.direction).norm();
}

/// The pair of sweeps that gives the base: lowest joints first, axes not parallel.
struct SweepPair {
  std::size_t first = 0, second = 0;
};
std::optional<SweepPair> select_base_pair(const std::vector<SweepCircle>& circles) {
  std::vector<std::size_t> order(circles.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return circles[a].q_index < circles[b].q_index; });
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t k = i + 1; k < order.size(); ++k)
      if (circles[order[i]].axis.cross(circles[order[k]].axis).norm() > std::sin(thresholds::parallel_axes))
        return SweepPair{order[i], order[k]};
  return std::nullopt;
}

/// zt at which the tool point is `radius` from the axis, for a tool on the flange's z axis: the root that lies furthest
/// out.
std::optional<double> tool_length(const Chain& chain, const PoseSet& data, const Sweep& sweep, double radius) {
  Chain bare = chain;
  bare.tool = Frame{};
  const Pose flange = forward(bare, data.joints.col(sweep.rows.front()));
  const Line axis = predicted_axis(chain, data, sweep);
  const auto across = [&](const Vec3& v) { return Vec3(v - axis.direction * axis.direction.dot(v)); };
  const Vec3 p = across(flange.position - axis.point), z = across(flange.rotation.col(2));
  const double a = z.squaredNorm(), b = p.dot(z), c = p.squaredNorm() - radius * radius, root = b * b - a * c;
  if (a < 1e-6 || root < 0.0) return std::nullopt;
  return (-b + std::sqrt(root)) / a;
}

/// The tool point on the flange for a known base: the mean over all rows.
Vec3 mean_tool_point(const Chain& chain, const PoseSet& data) {
  Chain bare = chain;
  bare.tool = Frame{};
  Vec3 sum = Vec3::Zero();
  double count = 0.0;
  for (const PointMeasurement& point : data.points) {
    if (point.target >= 0) continue;
    sum += forward(bare, data.joints.col(point.row)).inverse() * point.position;
    count += 1.0;
  }
  return sum / count;
}

/// For an error: the name in the file, or the rows.
std::string label(const Sweep& sweep) {
  return sweep.name.empty() ? fmt::format("rows {} to {}", sweep.rows.front(), sweep.rows.back()) : sweep.name;
}

/// The normal of the fitted circle, about which the joint turns with growing joint positions, in whatever order these
/// were visited.
Vec3 signed_axis(const CircleFit& fit, const std::vector<Vec3>& points, const VectorXd& positions) {
  double turned = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    turned += (positions[row] - positions[row - 1]) *
              fit.normal.dot((points[i - 1] - fit.center).cross(points[i] - fit.center));
  }
  return turned < 0.0 ? Vec3(-fit.normal) : fit.normal;
}

void estimate_tool(FrameEstimate& found, const PoseSet& data, const std::vector<Sweep>& sweeps) {
  const int wanted = static_cast<int>(data.joints.rows()) - 2;
  found.chain.tool.xyz = mean_tool_point(found.chain, data);
  found.tool_length = found.chain.tool.xyz.z();
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    if (sweeps[i].q_index != wanted) continue;
    const auto length = tool_length(found.chain, data, sweeps[i], found.sweeps[i].radius);
    found.tool_joint = found.sweeps[i].joint;
    found.tool_length_source = length ? ToolLengthSource::sweep_radius : ToolLengthSource::radius_without_fit;
    if (length) found.tool_length = *length;
    return;
  }
}

void compare_with_start(FrameEstimate& found, const Chain& nominal, const PoseSet& data) {
  const Result<Chain> start = with_estimated_frames(nominal, data);
  if (!start) return;
  const Pose a = found.chain.base.pose(), b = start->base.pose();
  found.base_differs = (a.position - b.position).norm();
  found.base_turned = angle_between(a.rotation, b.rotation);
  found.tool_differs = (found.chain.tool.xyz - start->tool.xyz).norm();
}

}  // namespace

Result<std::vector<Sweep>> find_sweeps(const PoseSet& data) {
  if (!data.sweeps.empty()) return read_marked_sweeps(data);
  return find_single_joint_runs(data);
}

SweepCircle fit_sweep(const Chain& nominal, const PoseSet& data, const Sweep& sweep) {
  const auto all = tool_points(data);
  std::vector<Vec3> points;
  for (const int row : sweep.rows) points.push_back(*all[row]);
  const CircleFit fit = fit_circle(points);
  SweepCircle circle;
  circle.name = sweep.name;
  circle.first_row = sweep.rows.front(), circle.last_row = sweep.rows.back();
  circle.q_index = sweep.q_index;
  circle.joint = nominal.joints[active_joints(nominal)[sweep.q_index]].name;
  circle.rows = static_cast<int>(points.size());
  circle.swept = range(data, sweep.rows, sweep.q_index);
  circle.axis = signed_axis(fit, points, data.joints(sweep.q_index, sweep.rows));
  circle.centre = fit.center;
  circle.radius = fit.radius;
  circle.rms = fit.rms;
  estimate_uncertainty(circle, points);
  return circle;
}

Result<FrameEstimate> estimate_frames_from_circles(const Chain& nominal, const PoseSet& data) {
  KINFER_TRY(sweeps, find_sweeps(data));
  FrameEstimate found;
  found.chain = nominal;
  for (const Sweep& sweep : sweeps) {
    if (!rotates(nominal.joints[active_joints(nominal)[sweep.q_index]].type))
      return error("sweep {} moves a prismatic joint; circles need revolute ones", label(sweep));
    found.sweeps.push_back(fit_sweep(nominal, data, sweep));
  }
  const auto pair = select_base_pair(found.sweeps);
  if (!pair)
    return error(
        "{} sweeps of a single joint were found; the base needs two whose axes are not parallel (joint 1 and joint 2)",
        sweeps.size());
  const SweepCircle &first = found.sweeps[pair->first], &second = found.sweeps[pair->second];
  Chain in_base = nominal;
  in_base.base = Frame{};
  const Pose world_T_pair = frame_from_axes(line_of(first), line_of(second));
  const Pose base_T_pair = frame_from_axes(predicted_axis(in_base, data, sweeps[pair->first]),
                                           predicted_axis(in_base, data, sweeps[pair->second]));
  found.chain.base = Frame::from_pose(world_T_pair * base_T_pair.inverse());
  found.base_joints = {first.joint, second.joint};
  estimate_tool(found, data, sweeps);
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    const Line axis = predicted_axis(found.chain, data, sweeps[i]);
    found.sweeps[i].off_by = distance(axis, found.sweeps[i].centre);
    found.sweeps[i].axis_angle = angle_between(axis.direction, found.sweeps[i].axis);
  }
  compare_with_start(found, nominal, data);
  return found;
}

}  // namespace kinfer::calibrate

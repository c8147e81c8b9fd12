// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/loops/loop_search.hpp"

#include <algorithm>
#include <limits>

#include "kinfer/identify/loops/thresholds.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

constexpr Index sampled_times = 1000;          // evenly spaced; of them, different positions are selected
constexpr std::size_t most_positions = 200;    // in which a pair is compared
constexpr std::size_t shortest_loop_path = 3;  // joints: with two, the axes may merely coincide or intersect

/// A step of the path between two bodies: over the joint of `body`, outwards or back towards the root.
struct PathStep {
  std::size_t body = 0;
  bool outwards = true;
};

std::vector<PathStep> path_of(const InsBodies& bodies, std::size_t first, std::size_t second) {
  std::vector<PathStep> inwards, outwards;
  const auto parent = [&](std::size_t b) { return static_cast<std::size_t>(bodies[b].parent); };
  while (first != second)  // parents have smaller indices
    if (first > second)
      inwards.push_back({first, false}), first = parent(first);
    else
      outwards.push_back({second, true}), second = parent(second);
  inwards.insert(inwards.end(), outwards.rbegin(), outwards.rend());
  return inwards;
}

/// parent_T_body of a revolute or fixed body at a joint position.
Pose step_pose(const InsBody& body, double position) {
  const Mat3 rotation = body.parent_R_axis * rot_z(position) * body.child_R_axis.transpose();
  return {rotation, body.point_in_parent - rotation * body.point_in_child};
}

/// Joint positions [rad] at evenly spaced times: times x bodies; 0 for bodies that are not revolute.
MatrixXd sampled_positions(const InsProblem& problem, const InsFit& fit) {
  const SplineGrid& grid = problem.grid;
  const InsBodies& bodies = fit.unknowns.bodies;
  MatrixXd positions = MatrixXd::Zero(sampled_times, static_cast<Index>(bodies.size()));
  for (Index i = 0; i < sampled_times; ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(sampled_times);
    const VectorXd all =
        spline_value(grid, fit.unknowns.spline_coefficients, grid.begin + share * (grid.end() - grid.begin));
    for (std::size_t b = 1; b < bodies.size(); ++b)
      if (bodies[b].motion == JointMotion::revolute)
        positions(i, static_cast<Index>(b)) = all[fit.layout.spline_dimension[b]];
  }
  return positions;
}

std::vector<Index> columns_of(const std::vector<std::size_t>& bodies) {
  return {bodies.begin(), bodies.end()};
}

/// Rows of the positions, no two of which are alike.
MatrixXd different_rows(const MatrixXd& positions) {
  std::vector<Index> kept;
  for (Index i = 0; i < positions.rows() && kept.size() < most_positions; ++i)
    if (std::ranges::all_of(kept, [&](Index k) {
          return (positions.row(i) - positions.row(k)).cwiseAbs().maxCoeff() > min_position_difference;
        }))
      kept.push_back(i);
  return positions(kept, Eigen::all);
}

/// first_T_second for each row of the positions of `moving`, the revolute joints of the path.
std::vector<Pose> relative_poses(const InsBodies& bodies, const std::vector<PathStep>& path,
                                 const MatrixXd& positions) {
  std::vector<Pose> poses;
  for (Index i = 0; i < positions.rows(); ++i) {
    Pose pose;
    Index column = 0;
    for (const PathStep& step : path) {
      const InsBody& body = bodies[step.body];
      const Pose over = step_pose(body, body.motion == JointMotion::revolute ? positions(i, column++) : 0.0);
      pose = pose * (step.outwards ? over : over.inverse());
    }
    poses.push_back(pose);
  }
  return poses;
}

/// The closing joint of the same movements with one joint mirrored about its mean: the best of all joints.
ClosingJoint best_mirrored(const InsBodies& bodies, const std::vector<PathStep>& path, const MatrixXd& positions) {
  ClosingJoint best{.gap = std::numeric_limits<double>::infinity()};
  for (Index j = 0; j < positions.cols(); ++j) {
    MatrixXd mirrored = positions;
    mirrored.col(j) = 2.0 * positions.col(j).mean() - positions.col(j).array();
    ClosingJoint closing = fit_closing_joint(relative_poses(bodies, path, mirrored));
    if (closing.gap < best.gap) best = std::move(closing);
  }
  return best;
}

/// Length of the chain between the first and the last joint of a path.
double length_of(const InsBodies& bodies, const std::vector<PathStep>& path) {
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const InsBody &a = bodies[path[i].body], &b = bodies[path[i + 1].body];
    const Vec3 &leave = path[i].outwards ? a.point_in_child : a.point_in_parent,
               &arrive = path[i + 1].outwards ? b.point_in_parent : b.point_in_child;
    length += (arrive - leave).norm();
  }
  return length;
}

}  // namespace

std::vector<FoundLoop> loop_candidates(const InsProblem& problem, const InsFit& fit) {
  const InsBodies& bodies = fit.unknowns.bodies;
  const MatrixXd positions = sampled_positions(problem, fit);
  std::vector<bool> moves(bodies.size(), false);
  for (std::size_t b = 1; b < bodies.size(); ++b) {
    const auto column = positions.col(static_cast<Index>(b));
    moves[b] = column.maxCoeff() - column.minCoeff() > min_loop_joint_range;
  }
  std::vector<FoundLoop> found;
  for (std::size_t second = 1; second < bodies.size(); ++second)
    for (std::size_t first = 0; first < second; ++first) {
      if (bodies[first].sensor < 0 || bodies[second].sensor < 0) continue;
      const std::vector<PathStep> path = path_of(bodies, first, second);
      FoundLoop loop{.first = first, .second = second};
      for (const PathStep& step : path)
        if (bodies[step.body].motion != JointMotion::fixed) loop.joints.push_back(step.body);
      if (loop.joints.size() < shortest_loop_path ||
          !std::ranges::all_of(loop.joints, [&](std::size_t b) { return moves[b]; }))
        continue;
      const MatrixXd different = different_rows(positions(Eigen::all, columns_of(loop.joints)));
      loop.evidence = {.closing = fit_closing_joint(relative_poses(bodies, path, different)),
                       .mirrored = best_mirrored(bodies, path, different),
                       .positions = static_cast<double>(different.rows()),
                       .lever = length_of(bodies, path)};
      loop.log_odds = log_odds(loop.evidence);
      found.push_back(std::move(loop));
    }
  std::ranges::stable_sort(found, std::greater<>{}, &FoundLoop::log_odds);
  return found;
}

std::vector<FoundLoop> find_loops(const InsProblem& problem, const InsFit& fit) {
  std::vector<FoundLoop> loops = loop_candidates(problem, fit), kept;
  std::erase_if(loops, [](const FoundLoop& loop) { return loop.log_odds < min_loop_log_odds; });
  // Pairs that differ by rigidly joined bodies have the same moving joints between them.
  for (FoundLoop& loop : loops)
    if (std::ranges::none_of(kept, [&](const FoundLoop& other) { return other.joints == loop.joints; }))
      kept.push_back(std::move(loop));
  return kept;
}

}  // namespace kinfer::identify

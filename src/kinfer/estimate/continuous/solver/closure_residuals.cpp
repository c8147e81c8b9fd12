// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/solver/closure_residuals.hpp"

#include "kinfer/estimate/continuous/solver/body_kinematics.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;
using Vec5 = Eigen::Matrix<double, 5, 1>;

/// Both halves of the closing joint in the root's frame at one time.
struct ClosurePlacement {
  Mat3 first, second;  // root_R_joint
  Vec3 first_point, second_point;
};

ClosurePlacement place(const InsClosure& closure, const InsBody& joint, const MachineSnapshot& s) {
  const Pose first = s.body[static_cast<std::size_t>(closure.first)].pose(),
             second = s.body[static_cast<std::size_t>(closure.second)].pose();
  return {first.rotation * joint.parent_R_axis, second.rotation * joint.child_R_axis, first * joint.point_in_parent,
          second * joint.point_in_child};
}

/// Predicted minus ideal, in standard deviations.
Vec5 gap_of(const InsClosure& closure, const ClosurePlacement& p) {
  Vec5 gap;
  gap << (p.second_point - p.first_point) / closure.point_sd, p.first.col(0).dot(p.second.col(2)) / closure.axis_sd,
      p.first.col(1).dot(p.second.col(2)) / closure.axis_sd;
  return gap;
}

}  // namespace

void append_closure_rows(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, std::size_t index,
                         std::vector<InsFactRows>& rows) {
  const InsClosure& closure = problem.facts.closures[index];
  const InsBody& joint = x.facts.closures[index];
  // The joint's own unknowns, in the order of InsBody: rotations of both frames about x and y, then the points.
  const Index own = first_global(layout) + layout.closures + closure_unknowns * static_cast<Index>(index);
  for (const double time : closure.at) {
    const MachineSnapshot s = machine_snapshot(problem, layout, x, time);
    const ClosurePlacement p = place(closure, joint, s);
    const auto a = static_cast<std::size_t>(closure.first), b = static_cast<std::size_t>(closure.second);
    PointJacobian first = jacobian_at(layout, x, s, a, joint.point_in_parent),
                  second = jacobian_at(layout, x, s, b, joint.point_in_child);
    first.by_rotation.middleCols<2>(own) = p.first.leftCols<2>();
    second.by_rotation.middleCols<2>(own + 2) = p.second.leftCols<2>();
    first.by_position.middleCols<3>(own + 4) = s.body[a].rotation;
    second.by_position.middleCols<3>(own + 7) = s.body[b].rotation;
    MatrixXd derivative(5, first.by_position.cols());
    derivative.topRows<3>() = (second.by_position - first.by_position) / closure.point_sd;
    const Rows3 turn = (first.by_rotation - second.by_rotation) / closure.axis_sd;
    for (int k = 0; k < 2; ++k) derivative.row(3 + k) = p.first.col(k).cross(p.second.col(2)).transpose() * turn;
    rows.push_back({s.interval, -gap_of(closure, p), std::move(derivative)});
  }
}

double closure_cost(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, std::size_t index) {
  const InsClosure& closure = problem.facts.closures[index];
  double sum = 0.0;
  for (const double time : closure.at)
    sum += gap_of(closure, place(closure, x.facts.closures[index], machine_snapshot(problem, layout, x, time)))
               .squaredNorm();
  return sum;
}

}  // namespace kinfer

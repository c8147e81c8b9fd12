// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/model/retraction.hpp"

#include "kinfer/estimate/continuous/model/azimuth.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

/// Whether the sub-tree's rotation is one of the child's own unknowns, but for a constant of its joint's positions.
bool is_rotated_by(const InsBody& child) {
  return child.free_parent_rotation[0] && child.free_parent_rotation[1] && child.free_point_in_parent;
}

/// `before`, `after`: the body that carries the child. The rest of the step is applied to the machine as it was, which
/// is then rotated about the body's axis. The child's positions take what the rotation contains of one about its axis.
InsBody retract_with_azimuth(const InsBody& before, const InsBody& after, const InsBody& child, VectorXd step,
                             double angle) {
  const Vec3 axis = before.child_R_axis.col(2), turned = child.parent_R_axis.transpose() * axis,
             arm = child.point_in_parent - before.point_in_child;
  step.head<2>() -= angle * turned.head<2>();
  step.segment<3>(child.turns()) -= angle * axis.cross(arm) + (after.point_in_child - before.point_in_child);
  InsBody result = retract(child, step);
  const Mat3 turn = exp_so3(angle * after.child_R_axis.col(2));
  result.parent_R_axis = turn * result.parent_R_axis * rot_z(-angle * turned.z());
  result.point_in_parent = after.point_in_child + turn * (result.point_in_parent - before.point_in_child);
  return result;
}

InsBodies retract(const InsLayout& layout, const InsBodies& bodies, ConstVectorRef border) {
  InsBodies result;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    result.push_back(retract(bodies[b], border.segment(layout.body[b], bodies[b].unknowns())));
  for (const InsAzimuth& azimuth : azimuths_of(bodies)) {
    const InsBody& child = bodies[azimuth.child];
    if (is_rotated_by(child))
      result[azimuth.child] = retract_with_azimuth(bodies[azimuth.body], result[azimuth.body], child,
                                                   border.segment(layout.body[azimuth.child], child.unknowns()),
                                                   azimuth_gradient(layout, bodies, azimuth).dot(border));
  }
  return result;
}

/// `step`: 3 per unknown point, 3 per touched point, 10 per closure, then the surveyor's frame: translation and
/// rotation.
void change_facts(InsFactUnknowns& facts, ConstVectorRef step) {
  Index at = 0;
  for (auto* points : {&facts.places, &facts.touched})
    for (Vec3& point : *points) point += step.segment<3>(at), at += 3;
  for (InsBody& joint : facts.closures) {
    joint = retract(joint, step.segment<closure_unknowns>(at));
    at += closure_unknowns;
  }
  if (at == step.size()) return;
  facts.surveyor.position += step.segment<3>(at);
  facts.surveyor.rotation = facts.surveyor.rotation * exp_so3(step.segment<3>(at + 3));
}

}  // namespace

InsUnknowns retract(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, const InsStep& step) {
  const VectorXd& border = step.border;
  InsUnknowns result = x;
  result.spline_coefficients += step.spline_coefficients;
  if (layout.bias_process > 0) result.bias_process += step.bias_process;
  if (layout.root_force >= 0) result.root_force += border.segment<3>(layout.root_force);
  result.bodies = retract(layout, x.bodies, border);
  for (std::size_t s = 0; s < x.errors.size(); ++s)
    each_error(problem, layout, result.errors, s, [&](Index at, Index size, double* value, double) {
      for (Index i = 0; i < size; ++i) value[i] += border[at + i];
    });
  change_facts(result.facts, border.tail(layout.global_parameters - layout.facts));
  return result;
}

}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/readout/tool_spread.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer::track {

ToolSpread::ToolSpread(const FilterModel& model, const TrackingTool& tool)
    : carried_(tool),
      leads_to_tool_(model.bodies.size(), false),
      bodies_(model.bodies.size()),
      parent_sides_(model.bodies.size()) {
  for (int b = tool.body; b > 0; b = model.bodies[static_cast<std::size_t>(b)].parent)
    leads_to_tool_[static_cast<std::size_t>(b)] = true;
  index_.reserve(static_cast<std::size_t>(model.layout.size));
  derivative_.resize(6, model.layout.size);
}

void ToolSpread::set_pose(const FilterModel& model, const ChainState& state, std::size_t b) {
  const InsBody& body = model.bodies[b];
  const Index at = position_states * model.layout.position[b];
  const auto& [parent_R_axis, point_in_parent, turned] = parent_sides_[b] = parent_side(model, state, b);
  Pose step{parent_R_axis * body.child_R_axis.transpose(), point_in_parent};
  if (body.motion == JointMotion::revolute)
    step.rotation = parent_R_axis * rot_z(state.joints[at]) * body.child_R_axis.transpose();
  if (body.motion == JointMotion::spherical)
    step.rotation = parent_R_axis * state.spherical[b] * body.child_R_axis.transpose();
  if (body.motion == JointMotion::prismatic) step.position += state.joints[at] * parent_R_axis.col(2);
  step.position -= step.rotation * body.point_in_child;
  bodies_[b] = bodies_[static_cast<std::size_t>(body.parent)] * step;
}

void ToolSpread::add_column(Index state, const Vec3& shift, const Vec3& turn) {
  derivative_.col(static_cast<Index>(index_.size())) << shift, turn;
  index_.push_back(state);
}

/// Rotations are about the joint's point, in base axes: those of the parent's frame about where a slide begins, since
/// they turn its direction, those of the child's about where it is.
void ToolSpread::add_body(const FilterModel& model, std::size_t b) {
  const InsBody& body = model.bodies[b];
  const ParentSide& side = parent_sides_[b];
  const Pose& before = bodies_[static_cast<std::size_t>(body.parent)];
  const Mat3 &parent = before.rotation, &child = bodies_[b].rotation;
  const Vec3 arm = tool_.position - bodies_[b] * body.point_in_child,
             parent_arm = tool_.position - before * side.point_in_parent;
  const auto turn = [&](Index state, const Vec3& axis) { add_column(state, axis.cross(arm), axis); };
  const Mat3 axes = child * body.child_R_axis;
  if (body.motion == JointMotion::revolute) turn(model.layout.joint_state(model.layout.position[b]), axes.col(2));
  if (body.motion == JointMotion::prismatic)
    add_column(model.layout.joint_state(model.layout.position[b]), parent * side.parent_R_axis.col(2), Vec3::Zero());
  if (body.motion == JointMotion::spherical)
    for (Index i = 0; i < 3; ++i) turn(model.layout.joint_state(model.layout.position[b] + i), axes.col(i));
  const Mat3 point_axes = parent * side.turn;
  if (const UnknownPoint* point = model.unknown_point(b))
    for (Index i = 0; i < 3; ++i) add_column(point->state + i, point_axes.col(i), Vec3::Zero());
  if (const UnknownTurn* turned = model.unknown_turn(b)) {
    const InsBody& segment = model.bodies[turned->segment];
    const Vec3 axis = parent * segment.child_R_axis.col(2);
    add_column(turned->state, axis.cross(tool_.position - before * segment.point_in_child), axis);
  }
  const auto turn_in_parent = [&](Index state, Index i) {
    const Vec3 axis = parent * side.parent_R_axis.col(i);
    add_column(state, axis.cross(parent_arm), axis);
  };
  if (const UnknownAxis* tilted = model.unknown_axis(b))
    for (Index i = 0; i < 2; ++i) turn_in_parent(tilted->state + i, i);
  Index state = model.layout.first_geometry + model.layout.geometry[b];
  for (Index i = 0; i < 3; ++i)
    if (body.free_parent_rotation[static_cast<std::size_t>(i)]) turn_in_parent(state++, i);
  for (Index i = 0; i < 3; ++i)
    if (body.free_child_rotation[static_cast<std::size_t>(i)]) turn(state++, -axes.col(i));
  if (body.free_point_in_parent)
    for (Index i = 0; i < 3; ++i) add_column(state++, point_axes.col(i), Vec3::Zero());
  if (body.free_point_in_child)
    for (Index i = 0; i < 3; ++i) add_column(state++, -child.col(i), Vec3::Zero());
}

/// How the tool moves with a joint's position, or with a ball's heading.
Eigen::Matrix<double, 6, 1> ToolSpread::by_unknown_position(const FilterModel& model, const ChainState& state,
                                                            std::size_t b) const {
  const InsBody& body = model.bodies[b];
  const Vec3 axis = body.motion == JointMotion::spherical ? Vec3(state.world_R_base.transpose() * Vec3::UnitZ())
                                                          : Vec3(bodies_[b].rotation * body.child_R_axis.col(2));
  Eigen::Matrix<double, 6, 1> turn;
  turn << axis.cross(tool_.position - bodies_[b] * body.point_in_child), axis;
  return turn;
}

void ToolSpread::place(const FilterModel& model, const ChainState& state) {
  for (std::size_t b = 1; b < bodies_.size(); ++b) set_pose(model, state, b);
  tool_ = bodies_[static_cast<std::size_t>(carried_.body)] * carried_.body_T_tool;
}

void ToolSpread::spread(const FilterModel& model, const ChainState& state, const MatrixXd& covariance,
                        std::span<const double> unknown) {
  place(model, state);
  const Pose& carrier = bodies_[static_cast<std::size_t>(carried_.body)];
  index_.clear();
  for (std::size_t b = 1; b < bodies_.size(); ++b)
    if (leads_to_tool_[b]) add_body(model, b);
  Eigen::Matrix<double, 6, 1> variance = Eigen::Matrix<double, 6, 1>::Zero();
  const auto count = static_cast<Index>(index_.size());
  for (Index j = 0; j < count; ++j) {
    Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
    for (Index i = 0; i < count; ++i)
      sum += covariance(index_[static_cast<std::size_t>(i)], index_[static_cast<std::size_t>(j)]) * derivative_.col(i);
    variance += sum.cwiseProduct(derivative_.col(j));
  }
  for (std::size_t b = 1; b < unknown.size(); ++b)
    if (leads_to_tool_[b] && unknown[b] > 0.0)
      variance += (unknown[b] * by_unknown_position(model, state, b)).cwiseAbs2();
  variance.head<3>() += (carrier.rotation * carried_.sd).cwiseAbs2();
  position_sd_ = variance.head<3>().cwiseMax(0.0).cwiseSqrt();
  rotation_sd_ = variance.tail<3>().cwiseMax(0.0).cwiseSqrt();
}

}  // namespace kinfer::track

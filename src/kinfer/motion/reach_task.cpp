// SPDX-License-Identifier: Apache-2.0
#include "kinfer/motion/reach_task.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/overloaded.hpp"

namespace kinfer::motion {
namespace {

/// Rotation vector that turns the unit vector `from` to `to` on the shortest way.
Vec3 turn_between(const Vec3& from, const Vec3& to) {
  const Vec3 cross = from.cross(to);
  const double sine = cross.norm(), cosine = from.dot(to);
  if (sine > 1e-12) return std::atan2(sine, cosine) / sine * cross;
  return cosine > 0.0 ? cross : Vec3(std::atan2(0.0, -1.0) * any_perpendicular(from));
}

double elevation(const Vec3& axis) {
  return std::asin(std::clamp(axis.z(), -1.0, 1.0));
}

}  // namespace

ReachTask::ReachTask(const ReachTarget& target, const Vec3& tool_axis, double length)
    : target_(target), tool_axis_(tool_axis), length_(length) {
  std::visit(
      Overloaded{[](const FreeOrientation&) {}, [&](const AxisGoal&) { rows_ = 6, freedoms_ = 5; },
                 [&](const PitchGoal&) { rows_ = freedoms_ = 4; }, [&](const FullGoal&) { rows_ = freedoms_ = 6; }},
      target.orientation);
}

ReachTask::Error ReachTask::error(const Pose& tool) const {
  Error error;
  const Vec3 left = target_.position - tool.position;
  error.position = left.norm();
  error.weighted.head<3>() = left / length_;
  const auto turn = [&](const Vec3& rotation) {
    error.angle = rotation.norm();
    error.weighted.tail<3>() = rotation;
  };
  std::visit(Overloaded{[](const FreeOrientation&) {},
                        [&](const AxisGoal& goal) { turn(turn_between(tool.rotation * tool_axis_, goal.direction)); },
                        [&](const PitchGoal& goal) {
                          error.weighted[3] = goal.angle - elevation(tool.rotation * tool_axis_);
                          error.angle = std::abs(error.weighted[3]);
                        },
                        [&](const FullGoal& goal) { turn(log_so3(goal.rotation * tool.rotation.transpose())); }},
             target_.orientation);
  return error;
}

void ReachTask::rows(const Pose& tool, const Twists& twists, MatrixXd& jacobian) const {
  jacobian.resize(rows_, twists.cols());
  jacobian.topRows<3>() = twists.topRows<3>() / length_;
  const auto turns = twists.bottomRows<3>();
  const Vec3 axis = tool.rotation * tool_axis_;
  std::visit(Overloaded{[](const FreeOrientation&) {},
                        [&](const AxisGoal&) {
                          for (Eigen::Index k = 0; k < twists.cols(); ++k)
                            jacobian.col(k).tail<3>() = turns.col(k) - axis.dot(turns.col(k)) * axis;
                        },
                        [&](const PitchGoal&) {
                          const Vec3 level = axis.cross(Vec3::UnitZ());
                          const double size = std::max(level.norm(), 1e-9);  // vertical: no rotation changes it
                          for (Eigen::Index k = 0; k < twists.cols(); ++k)
                            jacobian(3, k) = level.dot(turns.col(k)) / size;
                        },
                        [&](const FullGoal&) { jacobian.bottomRows<3>() = turns; }},
             target_.orientation);
}

}  // namespace kinfer::motion

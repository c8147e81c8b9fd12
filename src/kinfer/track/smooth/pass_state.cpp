// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/smooth/pass_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/square.hpp"
#include "kinfer/evidence/tracking/body_poses.hpp"
#include "kinfer/geometry/cardan_angles.hpp"

namespace kinfer::track {
namespace {

using Index = Eigen::Index;

bool is_known(const PassState& pass, const TrackingJoint& joint) {
  return pass.started && pass.q.segment(joint.first_position, joint.positions).array().isFinite().all();
}

/// Where only one pass knows a position, or what it counts from, that one; −1: both do. What the backward pass counts
/// from is its own start, the recording's end.
double forced_share(const PassState& forward, const PassState& backward, const TrackingModel& model, std::size_t j) {
  const TrackingJoint& joint = model.joints[j];
  const bool has_forward = is_known(forward, joint), has_backward = is_known(backward, joint);
  if (!has_backward || backward.joints[j].reference == JointReference::start) return 0.0;
  if (!has_forward) return 1.0;
  return forward.joints[j].reference == JointReference::start ? 1.0 : -1.0;
}

void take_joint(const PassState& from, const TrackingJoint& joint, std::size_t j, TrackState& to) {
  const auto copy = [&](const VectorXd& source, VectorXd& target) {
    target.segment(joint.first_position, joint.positions) = source.segment(joint.first_position, joint.positions);
  };
  copy(from.q, to.q);
  copy(from.qd, to.qd);
  copy(from.sd_q, to.sd_q);
  copy(from.sd_qd, to.sd_qd);
  to.joints[j] = from.joints[j];
}

SharedSd position_sd(const PassState& pass, Index at) {
  return {pass.sd_q[at], pass.shared_q[at]};
}

/// Of several positions the root mean square.
SharedSd mean_sd(const PassState& pass, const TrackingJoint& joint) {
  const auto n = static_cast<double>(joint.positions);
  return {pass.sd_q.segment(joint.first_position, joint.positions).norm() / std::sqrt(n),
          pass.shared_q.segment(joint.first_position, joint.positions).norm() / std::sqrt(n)};
}

/// A rotation of three degrees of freedom, or of a loose joint: along the arc between both.
void combine_rotation(const TrackingModel& model, const PassState& backward, std::size_t j, double share,
                      TrackState& to) {
  const TrackingJoint& joint = model.joints[j];
  Quat& rotation = to.joints[j].parent_q_child;
  rotation = rotation.slerp(share, backward.joints[j].parent_q_child);
  if (joint.positions != 3) return;
  const auto of_joint = [j](const TrackingBody& body) { return body.joint == static_cast<int>(j); };
  const TrackingBody& body = *std::ranges::find_if(model.bodies, of_joint);
  const Mat3 turned = body.parent_R_axis.transpose() * rotation.toRotationMatrix() * body.child_R_axis;
  to.q.segment<3>(joint.first_position) = cardan_angles(turned, Vec3(to.q.segment<3>(joint.first_position)));
}

void combine_joint(const TrackingModel& model, const PassState& forward, const PassState& backward, std::size_t j,
                   TrackState& to) {
  const TrackingJoint& joint = model.joints[j];
  if (joint.positions == 0) return;
  if (const double share = forced_share(forward, backward, model, j); share >= 0.0) {
    if (share > 0.0) take_joint(backward, joint, j, to);
    return;
  }
  const bool slides = joint.type == EstimatedJointType::prismatic;
  for (int i = 0; i < joint.positions; ++i) {
    const Index at = joint.first_position + i;
    const Blend position = blend(position_sd(forward, at), position_sd(backward, at)),
                velocity = blend({forward.sd_qd[at], 0.0}, {backward.sd_qd[at], 0.0});
    const double difference = backward.q[at] - forward.q[at];
    to.q[at] += position.share * (slides ? difference : wrap_to_pi(difference));
    to.sd_q[at] = position.sd;
    to.qd[at] += velocity.share * (backward.qd[at] - forward.qd[at]);
    to.sd_qd[at] = velocity.sd;
  }
  const double share = blend(mean_sd(forward, joint), mean_sd(backward, joint)).share;
  combine_rotation(model, backward, j, share, to);
  if (share > 0.5) to.joints[j].source = backward.joints[j].source;
}

/// Tilt alone: the backward pass counts its heading from the end.
void combine_base(const PassState& forward, const PassState& backward, TrackState& to) {
  if (!forward.started || !backward.started) return;
  const Mat3 turn = (backward.world_q_base * forward.world_q_base.conjugate()).toRotationMatrix();
  const double heading = std::atan2(turn(1, 0) - turn(0, 1), turn(0, 0) + turn(1, 1));
  Vec3 tilt = log_so3(rot_z(-heading) * turn);
  for (Index k = 0; k < 2; ++k) {
    const Blend mean =
        blend({forward.sd_base[k], forward.shared_base[k]}, {backward.sd_base[k], backward.shared_base[k]});
    tilt[k] *= mean.share;
    to.sd_base[k] = mean.sd;
  }
  tilt.z() = 0.0;
  to.world_q_base = Quat(exp_so3(tilt)) * forward.world_q_base;
}

/// Of a body whose joint is its own; universal joints are two bodies, whose rotation is that of both.
Pose step_of(const TrackingModel& model, const TrackState& state, const TrackingBody& body) {
  const auto j = static_cast<std::size_t>(body.joint);
  const TrackingJoint& joint = model.joints[j];
  if (joint.positions == 2) {
    const bool is_second = model.bodies[static_cast<std::size_t>(body.parent)].joint == body.joint;
    return body_pose(body, state.q.segment(joint.first_position + (is_second ? 1 : 0), 1));
  }
  Pose step{state.joints[j].parent_q_child.toRotationMatrix(), body.point_in_parent};
  if (body.motion == TrackingMotion::fixed || body.motion == TrackingMotion::prismatic)
    step.rotation = body.parent_R_axis * body.child_R_axis.transpose();
  if (body.motion == TrackingMotion::prismatic)
    step.position += state.q[joint.first_position] * body.parent_R_axis.col(2);
  step.position -= step.rotation * body.point_in_child;
  return step;
}

bool leads_over_known_joints(const TrackingModel& model, const TrackState& state) {
  for (int b = model.tool.body; b > 0; b = model.bodies[static_cast<std::size_t>(b)].parent) {
    const TrackingJoint& joint =
        model.joints[static_cast<std::size_t>(model.bodies[static_cast<std::size_t>(b)].joint)];
    if (!state.q.segment(joint.first_position, joint.positions).array().isFinite().all()) return false;
  }
  return true;
}

void place_tool(const TrackingModel& model, TrackState& to) {
  Pose tool = model.tool.body_T_tool;
  for (int b = model.tool.body; b > 0; b = model.bodies[static_cast<std::size_t>(b)].parent)
    tool = step_of(model, to, model.bodies[static_cast<std::size_t>(b)]) * tool;
  to.base_T_tool = tool;
  if (!leads_over_known_joints(model, to))
    to.base_T_tool.position.setConstant(std::numeric_limits<double>::quiet_NaN());
}

void combine_tool_sd(const PassState& forward, const PassState& backward, TrackState& to) {
  for (Index k = 0; k < 3; ++k) {
    to.sd_tool_position[k] = blend({forward.sd_tool_position[k], forward.shared_tool_position[k]},
                                   {backward.sd_tool_position[k], backward.shared_tool_position[k]})
                                 .sd;
    to.sd_tool_rotation[k] = blend({forward.sd_tool_rotation[k], forward.shared_tool_rotation[k]},
                                   {backward.sd_tool_rotation[k], backward.shared_tool_rotation[k]})
                                 .sd;
  }
}

}  // namespace

Blend blend(SharedSd a, SharedSd b) {
  const double own_a = square(a.sd) - square(std::min(a.shared, a.sd)),
               own_b = square(b.sd) - square(std::min(b.shared, b.sd)), apart = a.shared - b.shared,
               sum = own_a + own_b + square(apart);
  const double w = sum > 0.0 ? std::clamp((own_a + a.shared * apart) / sum, 0.0, 1.0) : 0.5;
  const double shared = (1.0 - w) * std::min(a.shared, a.sd) + w * std::min(b.shared, b.sd);
  return {w, std::sqrt(square(1.0 - w) * own_a + square(w) * own_b + square(shared))};
}

void combine(const TrackingModel& model, const PassState& forward, const PassState& backward, TrackState& to) {
  if (!backward.started) return;
  for (std::size_t j = 0; j < model.joints.size(); ++j) combine_joint(model, forward, backward, j, to);
  combine_base(forward, backward, to);
  to.started = true;
  if (!forward.started) {
    to.world_q_base = backward.world_q_base;
    to.sd_base = backward.sd_base;
    to.sd_tool_position = backward.sd_tool_position;
    to.sd_tool_rotation = backward.sd_tool_rotation;
  } else {
    combine_tool_sd(forward, backward, to);
  }
  place_tool(model, to);
}

}  // namespace kinfer::track

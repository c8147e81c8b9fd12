// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/readout/readout.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/base/angle.hpp"
#include "kinfer/geometry/cardan_angles.hpp"

namespace kinfer::track {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

double unwrapped(double angle, double before) {
  return std::isnan(before) ? angle : before + wrap_to_pi(angle - before);
}

double sd_at(const MatrixXd& covariance, Index at) {
  return std::sqrt(std::max(0.0, covariance(at, at)));
}

/// Of a single position, from the start if its zero is unknown.
double variance_since_start(const FilterModel& model, Index position, const MatrixXd& covariance) {
  const Index row = model.layout.joint_state(position);
  const UnknownZero* zero = model.unknown_zero(position);
  if (!zero) return covariance(row, row);
  return covariance(row, row) + covariance(zero->state, zero->state) - 2.0 * covariance(row, zero->state);
}

Mat3 spherical_covariance(const FilterLayout& layout, Index first, Index derivative, const MatrixXd& covariance) {
  Mat3 p;
  for (Index i = 0; i < 3; ++i)
    for (Index j = 0; j < 3; ++j)
      p(i, j) = covariance(layout.joint_state(first + i) + derivative, layout.joint_state(first + j) + derivative);
  return p;
}

void read_ball(const FilterModel& model, std::size_t b, const ChainState& state, const MatrixXd& covariance, Index at,
               TrackState& to) {
  const Vec3 before = to.q.segment<3>(at);
  const Vec3 q = cardan_angles(state.spherical[b], before.hasNaN() ? Vec3(Vec3::Zero()) : before);
  const Mat3 back = cardan_rates(q);
  const Index first = model.layout.position[b];
  Vec3 rate;
  for (Index i = 0; i < 3; ++i) rate[i] = state.joints[position_states * (first + i) + 1];
  to.q.segment<3>(at) = q;
  to.qd.segment<3>(at) = back * rate;
  const Mat3 of_q = back * spherical_covariance(model.layout, first, 0, covariance) * back.transpose(),
             of_qd = back * spherical_covariance(model.layout, first, 1, covariance) * back.transpose();
  to.sd_q.segment<3>(at) = of_q.diagonal().cwiseMax(0.0).cwiseSqrt();
  to.sd_qd.segment<3>(at) = of_qd.diagonal().cwiseMax(0.0).cwiseSqrt();
}

/// The rotation of a loose revolute joint about its mean axis, the third of its spherical joint.
void read_loose_joint(const FilterModel& model, std::size_t b, const ChainState& state, const MatrixXd& covariance,
                      Index at, TrackState& to) {
  const Mat3& r = state.spherical[b];
  to.q[at] = unwrapped(std::atan2(r(1, 0) - r(0, 1), r(0, 0) + r(1, 1)), to.q[at]);
  const Index third = model.layout.position[b] + 2;
  to.qd[at] = state.joints[position_states * third + 1];
  to.sd_q[at] = sd_at(covariance, model.layout.joint_state(third));
  to.sd_qd[at] = sd_at(covariance, model.layout.joint_state(third) + 1);
}

Mat3 parent_R_child(const FilterModel& model, std::size_t b, const ChainState& state) {
  const InsBody& body = model.bodies[b];
  Mat3 turn = state.spherical[b];
  if (body.motion == JointMotion::revolute) turn = rot_z(state.joints[position_states * model.layout.position[b]]);
  return parent_side(model, state, b).parent_R_axis * turn * body.child_R_axis.transpose();
}

/// A universal joint's two bodies follow each other.
void read_rotations(const TrackingModel& tracking, const FilterModel& model, const ChainState& state, TrackState& to) {
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    const TrackingBody& body = tracking.bodies[b];
    Quat& rotation = to.joints[static_cast<std::size_t>(body.joint)].parent_q_child;
    const bool is_second = tracking.bodies[static_cast<std::size_t>(body.parent)].joint == body.joint;
    const Quat own(parent_R_child(model, b, state));
    rotation = is_second ? rotation * own : own;
  }
}

}  // namespace

Mat3 cardan_rates(const Vec3& q) {
  const Mat3 turning = (rot_y(q.y()) * rot_z(q.z())).transpose();
  Mat3 rates;  // of the angles to that of the child in its axes
  rates.col(0) = turning.col(0);
  rates.col(1) = rot_z(q.z()).transpose().col(1);
  rates.col(2) = Vec3::UnitZ();
  if (std::abs(rates.determinant()) < 1e-3) rates += 1e-3 * Mat3::Identity();  // gimbal lock: only sd is affected much
  return rates.inverse();
}

TrackState unknown_state(const TrackingModel& model) {
  const Index n = model.positions();
  TrackState state;
  state.q = state.qd = state.sd_q = state.sd_qd = VectorXd::Constant(n, unknown);
  state.sd_base = state.sd_tool_position = state.sd_tool_rotation = Vec3::Constant(unknown);
  state.base_T_tool.position.setConstant(unknown);
  state.joints.resize(model.joints.size());
  state.innovation.assign(model.sensors.size(), unknown);
  return state;
}

void read_out(const TrackingModel& tracking, const FilterModel& model, const ChainState& state,
              const MatrixXd& covariance, TrackState& to) {
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    const TrackingBody& body = tracking.bodies[b];
    const Index dof = degrees_of_freedom(model.bodies[b].motion);
    if (dof == 0) continue;
    const TrackingJoint& joint = tracking.joints[static_cast<std::size_t>(body.joint)];
    const bool is_second =
        joint.positions == 2 && tracking.bodies[static_cast<std::size_t>(body.parent)].joint == body.joint;
    const Index at = joint.first_position + (is_second ? 1 : 0);
    if (dof == 3 && body.motion == TrackingMotion::spherical) {
      read_ball(model, b, state, covariance, at, to);
    } else if (dof == 3) {
      read_loose_joint(model, b, state, covariance, at, to);
    } else {
      const Index first = model.layout.position[b], row = model.layout.joint_state(first);
      to.q[at] = state.joints[position_states * first] - state.start[first];
      to.qd[at] = state.joints[position_states * first + 1];
      to.sd_q[at] = std::sqrt(std::max(0.0, variance_since_start(model, first, covariance)));
      to.sd_qd[at] = sd_at(covariance, row + 1);
    }
  }
  read_rotations(tracking, model, state, to);
  to.world_q_base = Quat(state.world_R_base);
  const Mat3 attitude = state.world_R_base * covariance.topLeftCorner<3, 3>() * state.world_R_base.transpose();
  to.sd_base = attitude.diagonal().cwiseMax(0.0).cwiseSqrt();
}

void take_estimates(const TrackState& from, TrackState& to) {
  to.q = from.q, to.qd = from.qd, to.sd_q = from.sd_q, to.sd_qd = from.sd_qd;
  to.joints = from.joints;
  to.world_q_base = from.world_q_base, to.sd_base = from.sd_base;
  to.base_T_tool = from.base_T_tool;
  to.sd_tool_position = from.sd_tool_position, to.sd_tool_rotation = from.sd_tool_rotation;
}

}  // namespace kinfer::track

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/model/chain_measurement.hpp"

#include "kinfer/geometry/rotation_vector_motion.hpp"

namespace kinfer::track {
namespace {

/// The body in this state: the rotation of a spherical joint is part of its parent_R_axis, so that its joint position
/// is zero.
void set_parent_side(const ParentSide& side, const Mat3& spherical, InsBody& body) {
  body.parent_R_axis = side.parent_R_axis;
  body.point_in_parent = side.point_in_parent;
  if (body.motion == JointMotion::spherical) body.parent_R_axis *= spherical;
}

/// Of a segment's ω, ω̇ and f, in the frame of what hangs on it, by its turn: that frame turns the other way, about a
/// point of the axis.
Eigen::Matrix<double, 9, 1> by_turn(const InsBody& segment, const InsState& at) {
  const Vec3 axis = segment.child_R_axis.col(2), moved = -axis.cross(segment.point_in_child);
  Eigen::Matrix<double, 9, 1> derivative;
  derivative << -axis.cross(at.angular_velocity), -axis.cross(at.angular_acceleration),
      -axis.cross(at.force) + at.angular_acceleration.cross(moved) +
          at.angular_velocity.cross(at.angular_velocity.cross(moved));
  return derivative;
}

JointKinematicState joint_state_of(const FilterModel& model, const ChainState& state, std::size_t b) {
  JointKinematicState q{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  const Index dof = degrees_of_freedom(model.bodies[b].motion);
  for (Index i = 0; i < dof; ++i)
    for (Index k = 0; k < position_states; ++k)
      q[static_cast<std::size_t>(k)][i] = state.joints[position_states * (model.layout.position[b] + i) + k];
  return q;
}

/// Columns by φ at constant φ̇ and φ̈ become columns at constant angular velocity and acceleration, which are the states
/// of a spherical joint.
void keep_angular_velocity(const JointKinematicState& q, StateJacobian& columns) {
  const RotationVectorMotion r = rotation_vector_motion(q[0], q[1], q[2]);
  const Mat3 velocity = -r.velocity_by_vector,
             acceleration = -(r.acceleration_by_vector + r.acceleration_by_velocity * velocity);
  for (Index i = 0; i < 3; ++i)
    for (Index k = 0; k < 3; ++k)
      columns.col(3 * i) += velocity(k, i) * columns.col(3 * k + 1) + acceleration(k, i) * columns.col(3 * k + 2);
}

Mat3 scaled(const Mat3& scale) {
  return Mat3::Identity() + scale;
}

}  // namespace

ChainEvaluator::ChainEvaluator(const FilterModel& model) : bodies_(model.bodies), states_(model.bodies.size()) {
  const FilterLayout& layout = model.layout;
  const Index geometry = layout.size - layout.first_unseen;
  by_fast_.assign(bodies_.size(), MatrixXd::Zero(9, layout.fast));
  by_geometry_.assign(bodies_.size(), MatrixXd::Zero(9, geometry));
  result_.value = VectorXd::Zero(layout.rows());
  result_.by_fast = MatrixXd::Zero(layout.rows(), layout.fast);
  result_.by_geometry = MatrixXd::Zero(layout.rows(), geometry);
  result_.angular_velocity.assign(model.sensors.size(), Vec3::Zero());
  result_.force.assign(model.sensors.size(), Vec3::Zero());
  for (const SensorSettings& sensor : model.sensors) {
    result_.fast_end.push_back(layout.fast_end[static_cast<std::size_t>(sensor.body)]);
    result_.geometry_end.push_back(layout.unseen() + layout.geometry_end[static_cast<std::size_t>(sensor.body)]);
  }
  derivatives_.resize(bodies_.size());
  for (std::size_t b = 1; b < bodies_.size(); ++b)
    derivatives_[b].by_own.resize(state_size, 3 * degrees_of_freedom(bodies_[b].motion) + bodies_[b].unknowns());
}

void ChainEvaluator::propagate_body(const FilterModel& model, const ChainState& state, std::size_t b) {
  const FilterLayout& layout = model.layout;
  const ParentSide side = parent_side(model, state, b);
  set_parent_side(side, state.spherical[b], bodies_[b]);
  const auto parent = static_cast<std::size_t>(bodies_[b].parent);
  const JointKinematicState q = joint_state_of(model, state, b);
  PropagatedDerivative& derivative = derivatives_[b];
  propagate(bodies_[b], q, states_[parent], derivative);
  if (bodies_[b].motion == JointMotion::spherical) keep_angular_velocity(q, derivative.by_own);
  states_[b] = derivative.state;
  const Eigen::Matrix<double, 9, 9>& by_parent = derivative.by_parent;
  const Index fast = layout.fast_end[parent], geometry = layout.unseen() + layout.geometry_end[parent];
  for (Index j = 0; j < fast; ++j)
    by_fast_[b].col(j).head<9>().noalias() = by_parent * by_fast_[parent].col(j).head<9>();
  for (Index j = 0; j < geometry; ++j)
    by_geometry_[b].col(j).head<9>().noalias() = by_parent * by_geometry_[parent].col(j).head<9>();
  if (const UnknownTurn* turn = model.unknown_turn(b))
    by_geometry_[b].col(turn->state - layout.first_unseen).head<9>() =
        by_parent * by_turn(bodies_[parent], states_[parent]);
  const Index own = 3 * degrees_of_freedom(bodies_[b].motion);
  if (own > 0)
    for (Index j = 0; j < own; ++j)
      by_fast_[b].col(layout.joint_state(layout.position[b]) + j) = derivative.by_own.col(j);
  for (Index j = 0; j < bodies_[b].unknowns(); ++j)
    by_geometry_[b].col(layout.unseen() + layout.geometry[b] + j) = derivative.by_own.col(own + j);
  if (const UnknownAxis* axis = model.unknown_axis(b))
    by_geometry_[b].block<9, 2>(0, axis->state - layout.first_unseen) =
        by_geometry_[b].block<9, 2>(0, layout.unseen() + layout.geometry[b]);
  if (!bodies_[b].free_point_in_parent) return;
  auto by_point = by_geometry_[b].block<9, 3>(0, layout.unseen() + layout.geometry[b] + bodies_[b].turns());
  by_point *= side.turn;
  if (const UnknownPoint* point = model.unknown_point(b))
    by_geometry_[b].block<9, 3>(0, point->state - layout.first_unseen) = by_point;
}

void ChainEvaluator::measure(const FilterModel& model, const ChainState& state, std::size_t s) {
  const auto b = static_cast<std::size_t>(model.sensors[s].body);
  const SensorErrors& e = state.sensors[s];
  const Index row = sensor_rows * static_cast<Index>(s);
  const Mat3 gyroscope = scaled(e.gyroscope_scale), accelerometer = scaled(e.accelerometer_scale);
  result_.angular_velocity[s] = states_[b].angular_velocity;
  result_.force[s] = states_[b].force;
  result_.value.segment<3>(row) = gyroscope * states_[b].angular_velocity + e.gyroscope_bias;
  result_.value.segment<3>(row + 3) = accelerometer * states_[b].force + e.accelerometer_bias;
  for (Index j = 0; j < result_.fast_end[s]; ++j) {
    result_.by_fast.col(j).segment<3>(row).noalias() = gyroscope * by_fast_[b].col(j).head<3>();
    result_.by_fast.col(j).segment<3>(row + 3).noalias() = accelerometer * by_fast_[b].col(j).tail<3>();
  }
  for (Index j = 0; j < result_.geometry_end[s]; ++j) {
    result_.by_geometry.col(j).segment<3>(row).noalias() = gyroscope * by_geometry_[b].col(j).head<3>();
    result_.by_geometry.col(j).segment<3>(row + 3).noalias() = accelerometer * by_geometry_[b].col(j).tail<3>();
  }
}

void ChainEvaluator::evaluate(const FilterModel& model, const ChainState& state) {
  states_[0] = state.base_state(model.gravity);
  MatrixXd& base = by_fast_[0];
  base.block<3, 3>(0, BaseIndex::rate) = Mat3::Identity();
  base.block<3, 3>(3, BaseIndex::angular_acceleration) = Mat3::Identity();
  base.block<3, 3>(6, BaseIndex::attitude) = skew(states_[0].force);
  base.block<3, 3>(6, BaseIndex::acceleration) = state.world_R_base.transpose();
  for (std::size_t b = 1; b < bodies_.size(); ++b) propagate_body(model, state, b);
  for (std::size_t s = 0; s < model.sensors.size(); ++s) measure(model, state, s);
}

VectorXd predicted_measurement(const FilterModel& model, const ChainState& state) {
  std::vector<InsState> states{state.base_state(model.gravity)};
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    InsBody body = model.bodies[b];
    set_parent_side(parent_side(model, state, b), state.spherical[b], body);
    states.push_back(propagated(body, joint_state_of(model, state, b), states[static_cast<std::size_t>(body.parent)]));
  }
  VectorXd value(model.layout.rows());
  for (std::size_t s = 0; s < model.sensors.size(); ++s) {
    const InsState& at = states[static_cast<std::size_t>(model.sensors[s].body)];
    const SensorErrors& e = state.sensors[s];
    value.segment<3>(sensor_rows * static_cast<Index>(s)) =
        scaled(e.gyroscope_scale) * at.angular_velocity + e.gyroscope_bias;
    value.segment<3>(sensor_rows * static_cast<Index>(s) + 3) =
        scaled(e.accelerometer_scale) * at.force + e.accelerometer_bias;
  }
  return value;
}

}  // namespace kinfer::track

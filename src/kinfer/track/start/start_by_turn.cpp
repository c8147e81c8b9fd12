// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/start/start_by_turn.hpp"

#include "kinfer/base/angle.hpp"

namespace kinfer::track {
namespace {

/// Of the fast states of a start: to minus from.
VectorXd difference(const FilterModel& model, const ChainState& from, const ChainState& to) {
  VectorXd d = VectorXd::Zero(model.layout.fast);
  d.segment<3>(BaseIndex::attitude) = log_so3(Mat3(from.world_R_base.transpose() * to.world_R_base));
  d.segment<3>(BaseIndex::rate) = to.rate - from.rate;
  d.tail(from.joints.size()) = to.joints - from.joints;
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    const Index at = model.layout.position[b];
    if (model.bodies[b].motion == JointMotion::revolute) {
      double& turned = d[model.layout.joint_state(at)];
      turned = wrap_to_pi(turned);
    }
    if (model.bodies[b].motion != JointMotion::spherical) continue;
    const Vec3 turn = log_so3(Mat3(from.spherical[b].transpose() * to.spherical[b]));
    for (Index i = 0; i < 3; ++i) d[model.layout.joint_state(at + i)] = turn[i];
  }
  return d;
}

}  // namespace

void follow_turns(const InitialPosture& posture, const BlockMeasurement& block, const std::vector<PositionGuess>& guess,
                  ChainFilter& filter) {
  constexpr double step = 1e-4;  // [rad]
  const FilterModel model = turned_model(filter.model(), filter.state());
  const ChainState plain = initial_posture(model, block, guess, posture.state.base).state;
  MatrixXd& by_fault = filter.constant_faults().by_fault();
  for (std::size_t s = 0; s < model.sensors.size(); ++s)
    for (Index axis = 0; axis < 3; ++axis) {
      BlockMeasurement turned = block;
      const Mat3 turn = exp_so3(step * Vec3::Unit(axis));
      BlockSample& sample = turned.sensors[s];
      sample.rate = turn * sample.rate, sample.force = turn * sample.force;
      const ChainState state = initial_posture(model, turned, guess, posture.state.base).state;
      by_fault.row(3 * static_cast<Index>(s) + axis).head(model.layout.fast) =
          difference(model, plain, state).transpose() / step;
    }
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    const Index at = model.layout.position[b];
    if (at < 0 || model.bodies[b].motion != JointMotion::revolute) continue;
    const StartPosition& start = posture.positions[static_cast<std::size_t>(at)];
    if (!start.is_known && !start.is_unseen) by_fault.col(model.layout.joint_state(at)).setZero();
  }
}

}  // namespace kinfer::track

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/joint_choice.hpp"

#include <algorithm>

#include "kinfer/track/faults/thresholds.hpp"

namespace kinfer::track {

JointChoice::JointChoice(const TrackingModel& model) : joints_(model.joints.size()) {
  for (const TrackingBody& body : model.bodies) {
    if (body.joint < 0) continue;
    Joint& joint = joints_[static_cast<std::size_t>(body.joint)];
    const TrackingBody& parent = model.bodies[static_cast<std::size_t>(body.parent)];
    if (parent.joint != body.joint) joint.parent_sensor = parent.sensor;
    if (body.sensor >= 0) joint.child_sensor = body.sensor;
  }
}

void JointChoice::update(const ChainFilter& filter) {
  for (Joint& joint : joints_) {
    double most = 1.0;
    for (const int sensor : {joint.parent_sensor, joint.child_sensor}) {
      if (sensor < 0) continue;
      const InsLevel inflation = filter.inflation(static_cast<std::size_t>(sensor));
      most = std::max({most, inflation.rate, inflation.force});
    }
    joint.misfits = most > (joint.misfits ? fitting_inflation : misfit_inflation);
  }
}

void JointChoice::apply(const TrackingModel& model, const TrackState& composed, TrackState& chain) {
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    Joint& joint = joints_[j];
    const TrackingJoint& of = model.joints[j];
    if (of.positions == 0) continue;
    const auto other = composed.q.segment(of.first_position, of.positions);
    const bool was = joint.is_composed;
    joint.is_composed = joint.misfits && other.array().isFinite().all() && joint.child_sensor >= 0;
    if (!joint.is_composed) continue;
    const bool is_relative =
        chain.joints[j].reference == JointReference::start || composed.joints[j].reference == JointReference::start;
    if (!was)
      for (int i = 0; i < of.positions; ++i)
        joint.offset[i] = is_relative ? chain.q[of.first_position + i] - other[i] : 0.0;
    for (int i = 0; i < of.positions; ++i) chain.q[of.first_position + i] = other[i] + joint.offset[i];
    chain.qd.segment(of.first_position, of.positions) = composed.qd.segment(of.first_position, of.positions);
    chain.sd_q.segment(of.first_position, of.positions) = composed.sd_q.segment(of.first_position, of.positions);
    chain.sd_qd.segment(of.first_position, of.positions) = composed.sd_qd.segment(of.first_position, of.positions);
    chain.joints[j].source = JointSource::composed;
  }
}

}  // namespace kinfer::track

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/joint_fusion.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/square.hpp"
#include "kinfer/geometry/cardan_angles.hpp"
#include "kinfer/track/model/thresholds.hpp"
#include "kinfer/track/readout/readout.hpp"

namespace kinfer::track {
namespace {

using Index = Eigen::Index;

/// Angle of the rotation's part about a unit axis.
double twist_about(const Vec3& axis, const Quat& rotation) {
  return wrap_to_pi(2.0 * std::atan2(rotation.vec().dot(axis), rotation.w()));
}

double middle_of(const Vec3& v) {
  return v.sum() - v.maxCoeff() - v.minCoeff();
}

}  // namespace

JointFusion::JointFusion(const TrackingModel& model) : joints_(model.joints.size()) {
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    const TrackingBody& body = model.bodies[b];
    Joint& joint = joints_[static_cast<std::size_t>(body.joint)];
    const TrackingBody& parent = model.bodies[static_cast<std::size_t>(body.parent)];
    if (parent.joint != body.joint) joint.parent_sensor = parent.sensor, joint.first_body = static_cast<int>(b);
    joint.last_body = static_cast<int>(b);
    if (body.sensor >= 0) joint.child_sensor = body.sensor;
  }
}

void JointFusion::reset() {
  for (Joint& joint : joints_) {
    joint.offset = {};
    joint.share = 0.0;
    joint.is_new = true;
  }
}

double JointFusion::largest_share() const {
  double most = 0.0;
  for (const Joint& joint : joints_) most = std::max(most, joint.share);
  return most;
}

/// An offset from a chain whose position is uncertain takes its error over, and is as good as the chain was at its
/// best: it goes along as the chain learns.
void JointFusion::begin_or_improve(Offset& offset, double measured, double chain_variance, double drift) {
  if (!offset.is_set) {
    offset = {.is_set = true, .value = measured, .common = chain_variance, .drift = drift};
  } else if (chain_variance < offset.common) {
    offset.value += (1.0 - chain_variance / offset.common) * wrap_to_pi(measured - offset.value);
    offset.common = chain_variance;
  }
}

/// The composed heading drifts, the chain's wanders: a random walk, measured with noise of the correlation time
/// `wander_time`, longer where it wanders far. Returns the variance of the chain's heading: at least as much as it
/// wanders about the other beyond what that drifts, because gyroscopes alone are right over seconds.
double JointFusion::follow(Offset& offset, double measured, double chain_variance, double just_started, double drift,
                           double dt) {
  const double difference = wrap_to_pi(measured - offset.value);
  offset.variance += std::max(0.0, drift - offset.drift);
  offset.drift = drift;
  offset.age += dt;
  const double memory = std::max(std::min(offset.age, wander_memory), 1e-4);
  const double share = offset.age > 0.0 ? dt / memory : 1.0;
  offset.wander += share * (square(difference) - offset.wander);
  const double honest = std::max({chain_variance, offset.wander - offset.variance, 1e-12}) +
                        just_started * std::exp(-offset.age / wander_time),
               farther = std::max(1.0, honest / square(wander_sd)),
               noise = honest * farther * 2.0 * wander_time / std::max(dt, 1e-4),
               gain = offset.variance / (offset.variance + noise);
  offset.value += gain * difference;
  offset.variance *= 1.0 - gain;
  return honest;
}

/// Slowly, so that the position does not jump, unless there was none before; a small share of either is none.
void JointFusion::approach(Joint& joint, double chain_variance, double composed_variance, double dt) {
  const double w = chain_variance / std::max(chain_variance + composed_variance, 1e-30),
               wanted = std::clamp((w - least_share) / (1.0 - 2.0 * least_share), 0.0, 1.0);
  joint.share += (wanted - joint.share) * (joint.is_new ? 1.0 : 1.0 - std::exp(-dt / share_time));
  joint.is_new = false;
  if (wanted <= 0.0 && joint.share < least_share) joint.share = 0.0;
}

/// Of a heading that is so much less certain [rad²] than the chain states.
void JointFusion::widen_heading(const TrackingModel& model, std::size_t j, const Vec3& up, double variance,
                                TrackState& chain) const {
  const Index at = model.joints[j].first_position;
  const TrackingBody& body = model.bodies[static_cast<std::size_t>(joints_[j].first_body)];
  const Vec3 up_in_ball = body.child_R_axis.transpose() * (chain.joints[j].parent_q_child.conjugate() * up),
             by_heading = cardan_rates(chain.q.segment<3>(at)) * up_in_ball;
  auto sd = chain.sd_q.segment<3>(at);
  sd = (sd.cwiseAbs2() + variance * by_heading.cwiseAbs2()).cwiseSqrt().eval();
}

/// Gravity shows a spherical joint but for its heading. That of the chain, where motion shows it, is followed by the
/// composed one, which begins where the chain's is known to a few degrees, and may still be far off. Elsewhere both
/// count from their starts: what a start is off by is no error of the composed heading.
void JointFusion::fuse_ball(const TrackingModel& model, const ComposedFilters& composed, double dt, std::size_t j,
                            std::optional<double> heading_sd, TrackState& chain) {
  Joint& joint = joints_[j];
  const Index at = model.joints[j].first_position;
  JointStatus& status = chain.joints[j];
  const JointStatus& other = composed.state().joints[j];
  const Vec3 up = composed.vertical(j);
  const double chain_variance = heading_sd ? square(*heading_sd) : square(middle_of(chain.sd_q.segment<3>(at))),
               apart = twist_about(up, status.parent_q_child * other.parent_q_child.conjugate());
  if (!joint.offset.is_set) {
    if (heading_sd && *heading_sd > start_offset_sd) {
      joint.is_new = false;
      return;
    }
    joint.offset = {.is_set = true,
                    .value = heading_sd ? apart : 0.0,
                    .variance = heading_sd ? square(first_heading_sd) : 0.0,
                    .drift = composed.drift(j)};
  }
  const double honest =
      follow(joint.offset, apart, chain_variance, heading_sd ? 0.0 : square(start_offset_sd), composed.drift(j), dt);
  approach(joint, honest, composed.tilt_variance(j) + joint.offset.variance, dt);
  if (heading_sd) {
    const double mean_sd = (1.0 - joint.share) * std::sqrt(honest) + joint.share * std::sqrt(joint.offset.variance);
    widen_heading(model, j, up, std::max(0.0, square(mean_sd) - chain_variance), chain);
  }
  if (joint.share <= 0.0) return;
  const Quat aligned = Quat(exp_so3(joint.offset.value * up)) * other.parent_q_child;
  status.parent_q_child = status.parent_q_child.slerp(joint.share, aligned);
  const TrackingBody& body = model.bodies[static_cast<std::size_t>(joint.first_body)];
  const Mat3 turned = body.parent_R_axis.transpose() * status.parent_q_child.toRotationMatrix() * body.child_R_axis;
  chain.q.segment<3>(at) = cardan_angles(turned, Vec3(chain.q.segment<3>(at)));
}

void JointFusion::fuse(const TrackingModel& model, const ComposedFilters& composed, double dt, std::size_t j,
                       TrackState& chain) {
  Joint& joint = joints_[j];
  const TrackingJoint& of = model.joints[j];
  JointStatus& status = chain.joints[j];
  const JointStatus& other = composed.state().joints[j];
  const Index first = of.first_position;
  const bool is_relative = status.reference == JointReference::start || other.reference == JointReference::start;
  if (is_relative) {
    const double difference = chain.q[first] - composed.state().q[first];
    begin_or_improve(joint.offset, difference,
                     status.reference == JointReference::start ? 0.0 : square(chain.sd_q[first]), composed.drift(j));
    follow(joint.offset, difference, square(chain.sd_q[first]), square(start_offset_sd), composed.drift(j), dt);
  } else {
    joint.offset = {};
  }
  double chain_variance = 0.0, composed_variance = joint.offset.variance;
  for (Index i = 0; i < of.positions; ++i) {
    chain_variance += square(chain.sd_q[first + i]) / of.positions;
    const double sd = is_relative ? std::sqrt(composed.tilt_variance(j)) : composed.state().sd_q[first + i];
    composed_variance += square(sd) / of.positions;
  }
  // What both have in common tells nothing for either.
  const double own_variance = std::max(0.0, chain_variance - joint.offset.common / of.positions);
  approach(joint, own_variance, composed_variance, dt);
  if (joint.share <= 0.0) return;
  double turned = 0.0;  // [rad] the last position
  for (Index i = 0; i < of.positions; ++i) {
    const double offset = i == 0 ? joint.offset.value : 0.0, q = composed.state().q[first + i] + offset;
    turned = joint.share * wrap_to_pi(q - chain.q[first + i]);
    chain.q[first + i] += turned;
    if (std::isfinite(composed.state().qd[first + i]))
      chain.qd[first + i] += joint.share * (composed.state().qd[first + i] - chain.qd[first + i]);
  }
  if (of.stray > min_stray || joint.first_body != joint.last_body) {
    status.parent_q_child = status.parent_q_child.slerp(joint.share, other.parent_q_child);
    return;
  }
  const Vec3 axis = model.bodies[static_cast<std::size_t>(joint.first_body)].parent_R_axis.col(2);
  status.parent_q_child = Quat(exp_so3(turned * axis)) * status.parent_q_child;
}

void JointFusion::apply(const TrackingModel& model, const ComposedFilters& composed, const Usable& usable,
                        TrackState& chain) {
  const double dt = has_begun_ ? std::max(0.0, chain.time - time_) : 0.0;
  time_ = chain.time;
  has_begun_ = true;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    Joint& joint = joints_[j];
    const TrackingJoint& of = model.joints[j];
    const auto position = composed.state().q.segment(of.first_position, of.positions);
    const auto sound = [&](int sensor) { return sensor >= 0 && usable.is_sound[static_cast<std::size_t>(sensor)]; };
    if (of.positions == 0 || !usable.is_settled[j] || !sound(joint.parent_sensor) || !sound(joint.child_sensor) ||
        !position.array().isFinite().all()) {
      joint.share = 0.0;
      joint.is_new = false;
      joint.offset = {};
      continue;
    }
    if (of.positions == 3)
      fuse_ball(model, composed, dt, j, usable.heading_sd[j], chain);
    else
      fuse(model, composed, dt, j, chain);
    if (joint.share > 0.5) chain.joints[j].source = JointSource::composed;
  }
}

}  // namespace kinfer::track

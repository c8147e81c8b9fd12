// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/composed.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/square.hpp"
#include "kinfer/evidence/tracking/body_poses.hpp"
#include "kinfer/geometry/cardan_angles.hpp"
#include "kinfer/track/model/thresholds.hpp"

namespace kinfer::track {
namespace {

using Index = Eigen::Index;

constexpr double unknown_position = std::numeric_limits<double>::quiet_NaN();
constexpr double heading_walk = 1e-3;            // [rad/√s] of the difference of two headings
constexpr double axis_error = 0.01;              // [rad] of an axis' horizontal parts as two filters see them
constexpr double axis_error_time = 2.0;          // [s] over which that error stays alike
constexpr double known_bias_sd = 1e-3;           // [rad/s] by which a gyroscope's bias changed since the identification
constexpr double largest_error_distance = 32.9;  // χ² of 12 errors of an accelerometer, one in a thousand is beyond
constexpr double axis_memory = 10.0;             // [s] over which its error is averaged
constexpr double least_turn = 1e-2;        // 1 − |mean of exp(iq)|²: a joint that has turned less tells nothing
constexpr double least_inclination = 0.1;  // sine, below which an axis does not determine the heading

/// Without magnetometer, from the gyroscope's errors as the identification found them.
KinferFilter filter_of(const TrackingSensor& sensor) {
  KinferFilterOptions options;
  options.magnetometer = MagnetometerUse::off;
  options.rate_sample = RateSample::at_its_time;
  options.bias_sd = known_bias_sd;
  KinferFilter filter(options);
  KinferEstimate estimate;
  estimate.bias = sensor.gyroscope_bias;
  filter.set_estimate(estimate);
  return filter;
}

/// [rad²] per direction by which gravity seems tilted: δ = S f + b, the mean over all directions of f. The filter does
/// not know these errors. What the prior hardly allows is not the accelerometer's, but what the chain does not explain.
double accelerometer_tilt(const TrackingSensor& sensor, const TrackingModel& model) {
  const double bias = sensor.accelerometer_bias.squaredNorm(), scale = sensor.accelerometer_scale.squaredNorm();
  const auto distance = [](double square_sum, double sd) { return square_sum > 0.0 ? square_sum / square(sd) : 0.0; };
  if (!(distance(bias, model.prior.bias.force) + distance(scale, model.prior.scale.force) < largest_error_distance))
    return 0.0;
  return bias / (3.0 * square(model.gravity)) + scale / 9.0;
}

double about_z(const Mat3& r) {
  return std::atan2(r(1, 0) - r(0, 1), r(0, 0) + r(1, 1));
}

double unwrapped_angle(double angle, double before) {
  return std::isfinite(before) ? before + wrap_to_pi(angle - before) : angle;
}

/// The bodies of a joint: first and last index.
std::pair<std::size_t, std::size_t> bodies_of(const TrackingModel& model, int joint) {
  std::size_t first = 0, last = 0;
  for (std::size_t b = 1; b < model.bodies.size(); ++b)
    if (model.bodies[b].joint == joint) first = first == 0 ? b : first, last = b;
  return {first, last};
}

/// Of the rotation between both sensors, as far as its heading; none for joints that leave every heading free.
struct HeadingMeasurement {
  double angle = 0.0;        // [rad] by which the child's world turns against the parent's
  double inclination = 0.0;  // sine of the angle between the axis and the vertical
};

}  // namespace

void AxisSpread::add(const Eigen::Vector2d& across, double position, double expected, double dt) {
  watched_ = std::min(watched_ + dt, axis_memory);
  const double time_share = watched_ > 0.0 ? dt / watched_ : 0.0;
  weight_ += time_share * (1.0 / expected - weight_);
  const double share = weight_ > 0.0 ? time_share / (expected * weight_) : 0.0;
  const std::complex<double> y(across.x(), across.y()), turn = std::polar(1.0, position);
  across_ += share * (y - across_);
  turn_ += share * (turn - turn_);
  product_ += share * (y * std::conj(turn) - product_);
  square_ += share * (std::norm(y) - square_);
}

double AxisSpread::excess() const {
  const double turned = 1.0 - std::norm(turn_);
  double variance = square_ - std::norm(across_);
  if (turned >= least_turn) variance -= std::norm(product_ - across_ * std::conj(turn_)) / turned;
  return std::max(1.0, 0.5 * variance * weight_);
}

ComposedFilters::ComposedFilters(const TrackingModel& model, const TrackOptions& options)
    : model_(model), options_(options), rate_(model.sensors.size(), Vec3::Zero()) {
  for (const TrackingSensor& sensor : model.sensors) {
    filters_.push_back(filter_of(sensor));
    accelerometer_tilt_.push_back(accelerometer_tilt(sensor, model));
  }
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const auto [first, last] = bodies_of(model, j);
    const int parent = model.bodies[first].parent;
    joints_.push_back({.index = j,
                       .parent_sensor = model.bodies[static_cast<std::size_t>(parent)].sensor,
                       .child_sensor = model.bodies[last].sensor});
  }
  const Index positions = model.positions();
  state_.q = state_.qd = state_.sd_q = state_.sd_qd = VectorXd::Constant(positions, unknown_position);
  state_.joints.resize(model.joints.size());
}

void ComposedFilters::add(const InsRow& row) {
  const double dt = state_.started ? row.time - state_.time : 0.0;
  state_.time = row.time;
  for (std::size_t s = 0; s < filters_.size(); ++s) {
    filters_[s].add(row.sensors[s]);
    if (row.sensors[s].has_angular_velocity) rate_[s] = row.sensors[s].angular_velocity - filters_[s].estimate().bias;
  }
  state_.started = std::ranges::all_of(filters_, &KinferFilter::started);
  for (Joint& joint : joints_) update_joint(joint, dt);
  const KinferFilter& base = filters_[static_cast<std::size_t>(model_.bodies.front().sensor)];
  state_.world_q_base = base.orientation();
  state_.sd_base = base.covariance().diagonal().head<3>().cwiseSqrt();
  state_.sd_base.z() = 0.0;  // relative to the start
  read_tool();
}

Mat3 ComposedFilters::relative_rotation(const Joint& joint) const {
  const Quat &parent = filters_[static_cast<std::size_t>(joint.parent_sensor)].orientation(),
             &child = filters_[static_cast<std::size_t>(joint.child_sensor)].orientation();
  return parent.toRotationMatrix().transpose() * rot_z(joint.heading) * child.toRotationMatrix();
}

void ComposedFilters::update_joint(Joint& joint, double dt) {
  if (!filters_[static_cast<std::size_t>(joint.parent_sensor)].started() ||
      !filters_[static_cast<std::size_t>(joint.child_sensor)].started())
    return;
  if (!joint.started) start_heading(joint);
  let_heading_drift(joint, dt);
  measure_heading(joint, dt);
  watch_axis(joint, dt);
  read_positions(joint);
}

/// As their filters state it: biases that no rest has shown yet make headings drift.
void ComposedFilters::let_heading_drift(Joint& joint, double dt) {
  const double variance = filters_[static_cast<std::size_t>(joint.parent_sensor)].covariance()(2, 2) +
                          filters_[static_cast<std::size_t>(joint.child_sensor)].covariance()(2, 2);
  const double walk = std::max(square(heading_walk) * dt, variance - joint.filters_variance);
  joint.filters_variance = variance;
  if (dt <= 0.0) return;
  joint.heading_variance += walk;
  joint.drift += walk;
}

/// Of the rotation between a joint's sensors, in the world, as their filters and the joint's heading state it.
Mat3 ComposedFilters::rotation_covariance(const Joint& joint) const {
  Mat3 covariance = filters_[static_cast<std::size_t>(joint.parent_sensor)].covariance().topLeftCorner<3, 3>() +
                    filters_[static_cast<std::size_t>(joint.child_sensor)].covariance().topLeftCorner<3, 3>();
  covariance.row(2).setZero();
  covariance.col(2).setZero();
  covariance.diagonal().head<2>().array() += accelerometer_tilt_[static_cast<std::size_t>(joint.parent_sensor)] +
                                             accelerometer_tilt_[static_cast<std::size_t>(joint.child_sensor)];
  covariance(2, 2) = joint.heading_variance;
  return covariance;
}

/// [rad²] per direction across a revolute joint's axis.
double ComposedFilters::across_variance(const Joint& joint) const {
  const Vec3 axis = filters_[static_cast<std::size_t>(joint.parent_sensor)].orientation() *
                    model_.bodies[bodies_of(model_, joint.index).first].parent_R_axis.col(2);
  const Mat3 covariance = rotation_covariance(joint);
  return 0.5 * (covariance.trace() - axis.dot(covariance * axis));
}

/// What both sensors see of one axis differs by the errors of their orientations and by the axis' own stray. Which of
/// both exceeds what is known of it does not show: both do alike.
void ComposedFilters::watch_axis(Joint& joint, double dt) {
  const auto [first, last] = bodies_of(model_, joint.index);
  const TrackingBody& body = model_.bodies[first];
  if (first != last || body.motion != TrackingMotion::revolute) return;
  const Mat3 between = body.parent_R_axis.transpose() * relative_rotation(joint) * body.child_R_axis;
  const double expected = across_variance(joint) + square(model_.joints[static_cast<std::size_t>(joint.index)].stray);
  joint.axis.add(between.col(2).head<2>(), about_z(between), expected, dt);
}

double ComposedFilters::tilt_variance(std::size_t joint) const {
  const Joint& of = joints_[joint];
  return of.axis.excess() * 0.5 * rotation_covariance(of).topLeftCorner<2, 2>().trace();
}

Vec3 ComposedFilters::vertical(std::size_t joint) const {
  return filters_[static_cast<std::size_t>(joints_[joint].parent_sensor)].orientation().conjugate() * Vec3::UnitZ();
}

void ComposedFilters::start_heading(Joint& joint) {
  const auto [first, last] = bodies_of(model_, joint.index);
  const TrackingJoint& about = model_.joints[static_cast<std::size_t>(joint.index)];
  VectorXd start = VectorXd::Zero(about.positions);
  const bool is_given = options_.start && options_.start->segment(about.first_position, about.positions).allFinite();
  if (is_given) start = options_.start->segment(about.first_position, about.positions);
  Mat3 relative = Mat3::Identity();
  Index next = 0;
  for (std::size_t b = first; b <= last; ++b) {
    const int count = degrees_of_freedom(model_.bodies[b].motion);
    relative = relative * body_pose(model_.bodies[b], start.segment(next, count)).rotation;
    next += count;
  }
  joint.heading = 0.0;
  // parentᵀ Rz(δ) child = relative: the heading that agrees best.
  const Mat3 parent = filters_[static_cast<std::size_t>(joint.parent_sensor)].orientation().toRotationMatrix(),
             child = filters_[static_cast<std::size_t>(joint.child_sensor)].orientation().toRotationMatrix();
  joint.heading = about_z(parent * relative * child.transpose());
  joint.heading_variance = is_given ? 0.0 : square(1.0);
  joint.started = true;
  JointStatus& status = state_.joints[static_cast<std::size_t>(joint.index)];
  status.source = JointSource::composed;
  status.reference = is_given ? JointReference::chain : JointReference::start;
}

void ComposedFilters::measure_heading(Joint& joint, double dt) {
  const auto [first, last] = bodies_of(model_, joint.index);
  const TrackingBody& body = model_.bodies[first];
  if (first != last || body.motion == TrackingMotion::spherical) return;
  const Mat3 parent = filters_[static_cast<std::size_t>(joint.parent_sensor)].orientation().toRotationMatrix(),
             child = filters_[static_cast<std::size_t>(joint.child_sensor)].orientation().toRotationMatrix();
  double angle = 0.0, inclination = 1.0;
  if (body.motion == TrackingMotion::revolute) {
    const Vec3 a = parent * body.parent_R_axis.col(2), b = child * body.child_R_axis.col(2);
    inclination = std::sqrt(std::hypot(a.x(), a.y()) * std::hypot(b.x(), b.y()));
    if (inclination < least_inclination) return;
    angle = std::atan2(b.x() * a.y() - b.y() * a.x(), a.x() * b.x() + a.y() * b.y());
  } else {
    angle = about_z(parent * body.parent_R_axis * body.child_R_axis.transpose() * child.transpose());
  }
  const double stray = std::hypot(axis_error, model_.joints[static_cast<std::size_t>(joint.index)].stray),
               tilt = tilt_variance(static_cast<std::size_t>(joint.index));
  const double noise = (square(stray) + tilt) / square(inclination);
  // Errors of measurements last, but the heading is never less certain than one of them makes it.
  const double variance = joint.heading_variance > noise ? noise : noise * axis_error_time / std::max(dt, 1e-4);
  const double gain = joint.heading_variance / (joint.heading_variance + variance);
  joint.heading += gain * wrap_to_pi(angle - joint.heading);
  joint.heading_variance *= 1.0 - gain;
  state_.joints[static_cast<std::size_t>(joint.index)].reference = JointReference::chain;
}

void ComposedFilters::read_positions(const Joint& joint) {
  const auto [first, last] = bodies_of(model_, joint.index);
  const TrackingBody& near = model_.bodies[first];
  const TrackingBody& far = model_.bodies[last];
  const Index at = model_.joints[static_cast<std::size_t>(joint.index)].first_position;
  const Mat3 relative = relative_rotation(joint);
  const Mat3 m = near.parent_R_axis.transpose() * relative * far.child_R_axis;
  const Mat3 parent = filters_[static_cast<std::size_t>(joint.parent_sensor)].orientation().toRotationMatrix();
  const Mat3 covariance = joint.axis.excess() * rotation_covariance(joint);
  const auto sd_about = [&](const Vec3& axis_in_parent) {
    const Vec3 axis = parent * axis_in_parent;
    return std::sqrt(std::max(0.0, axis.dot(covariance * axis)));
  };
  const Vec3 rate = relative * rate_[static_cast<std::size_t>(joint.child_sensor)] -
                    rate_[static_cast<std::size_t>(joint.parent_sensor)];
  if (near.motion == TrackingMotion::spherical) {
    const Vec3 before = state_.q.segment<3>(at).allFinite() ? Vec3(state_.q.segment<3>(at)) : Vec3::Zero();
    state_.q.segment<3>(at) = cardan_angles(m, before);
    for (Index k = 0; k < 3; ++k) state_.sd_q[at + k] = sd_about(near.parent_R_axis.col(k));
  } else if (first != last) {
    // Rz(q₁) C Rz(q₂) with C = Bᵀ A between both axes
    const Mat3 between = near.child_R_axis.transpose() * far.parent_R_axis;
    const double q1 = std::atan2(m(1, 2), m(0, 2)) - std::atan2(between(1, 2), between(0, 2));
    state_.q[at] = unwrapped_angle(q1, state_.q[at]);
    state_.q[at + 1] = unwrapped_angle(about_z(between.transpose() * rot_z(-q1) * m), state_.q[at + 1]);
    state_.sd_q[at] = sd_about(near.parent_R_axis.col(2));
    state_.sd_q[at + 1] = sd_about(relative * far.child_R_axis.col(2));
  } else if (near.motion == TrackingMotion::revolute) {
    state_.q[at] = unwrapped_angle(about_z(m), state_.q[at]);
    state_.qd[at] = near.parent_R_axis.col(2).dot(rate);
    state_.sd_q[at] = sd_about(near.parent_R_axis.col(2));
  }
  read_rotation(joint, relative);
}

/// A loose joint's axis strays by so much, and the orientations are off by so much.
Mat3 ComposedFilters::shrunk(const Joint& joint, const Mat3& relative) const {
  const TrackingBody& body = model_.bodies[bodies_of(model_, joint.index).first];
  const double stray = square(model_.joints[static_cast<std::size_t>(joint.index)].stray);
  const Mat3 between = body.parent_R_axis.transpose() * relative * body.child_R_axis, turn = rot_z(about_z(between));
  const double believed = stray / (stray + square(axis_error) + across_variance(joint));
  const Vec3 tilt = log_so3(between * turn.transpose());
  return body.parent_R_axis * exp_so3(believed * tilt) * turn * body.child_R_axis.transpose();
}

/// The joint knows more than the headings do, unless it leaves every rotation free.
void ComposedFilters::read_rotation(const Joint& joint, const Mat3& relative) {
  const TrackingJoint& of = model_.joints[static_cast<std::size_t>(joint.index)];
  Quat& rotation = state_.joints[static_cast<std::size_t>(joint.index)].parent_q_child;
  if (of.positions == 3) rotation = Quat(relative);
  if (of.stray > min_stray) rotation = Quat(shrunk(joint, relative));
  if (of.positions == 3 || of.stray > min_stray) return;
  const auto [first, last] = bodies_of(model_, joint.index);
  Index next = of.first_position;
  rotation = Quat::Identity();
  for (std::size_t b = first; b <= last; ++b) {
    const int count = degrees_of_freedom(model_.bodies[b].motion);
    rotation = rotation * Quat(body_pose(model_.bodies[b], state_.q.segment(next, count)).rotation);
    next += count;
  }
}

void ComposedFilters::read_tool() {
  if (!state_.q.allFinite()) return;
  // From the tool back to the base, without the list of all bodies' poses: nothing is allocated for a row.
  Pose pose = model_.tool.body_T_tool;
  for (int b = model_.tool.body; b > 0; b = model_.bodies[static_cast<std::size_t>(b)].parent) {
    const TrackingBody& body = model_.bodies[static_cast<std::size_t>(b)];
    const TrackingBody& parent = model_.bodies[static_cast<std::size_t>(body.parent)];
    const int count = degrees_of_freedom(body.motion), second = parent.joint == body.joint ? 1 : 0;
    const int first = count > 0 ? model_.joints[static_cast<std::size_t>(body.joint)].first_position + second : 0;
    pose = body_pose(body, state_.q.segment(first, count)) * pose;
  }
  state_.base_T_tool = pose;
}

}  // namespace kinfer::track

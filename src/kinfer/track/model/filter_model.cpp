// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/model/filter_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinfer/base/square.hpp"
#include "kinfer/track/model/thresholds.hpp"

namespace kinfer::track {
namespace {

InsBody filter_body(const TrackingModel& model, const TrackingBody& body) {
  InsBody made{.parent = body.parent, .sensor = body.sensor};
  made.parent_R_axis = body.parent_R_axis;
  made.child_R_axis = body.child_R_axis;
  made.point_in_parent = body.point_in_parent;
  made.point_in_child = body.point_in_child;
  const bool is_loose = body.joint >= 0 && model.joints[static_cast<std::size_t>(body.joint)].stray > min_stray;
  if (body.motion == TrackingMotion::revolute) made.motion = is_loose ? JointMotion::spherical : JointMotion::revolute;
  if (body.motion == TrackingMotion::prismatic) made.motion = JointMotion::prismatic;
  if (body.motion == TrackingMotion::spherical) made.motion = JointMotion::spherical;
  return made;
}

/// The rotations of a spherical joint have no geometry of their own: they are its position.
void free_parameter(InsBody& body, const TrackingParameter& parameter) {
  const auto component = static_cast<std::size_t>(parameter.component);
  const bool turns = body.motion != JointMotion::spherical;
  switch (parameter.kind) {
    case TrackingParameterKind::parent_rotation:
      body.free_parent_rotation[component] = turns;
      break;
    case TrackingParameterKind::child_rotation:
      body.free_child_rotation[component] = turns;
      break;
    case TrackingParameterKind::point_in_parent:
      body.free_point_in_parent = true;
      break;
    case TrackingParameterKind::point_in_child:
      body.free_point_in_child = true;
      break;
    default:
      break;
  }
}

Index count_before(const std::array<bool, 3>& is_free, std::size_t end) {
  return std::count(is_free.begin(), is_free.begin() + static_cast<std::ptrdiff_t>(end), true);
}

/// Index of a parameter among the slow states (sensors, then geometry); −1: it is none of them.
Index slow_state(const FilterModel& filter, const TrackingParameter& p) {
  const Index component = p.component, sensor = sensor_states * p.index;
  const Index by_row = 3 * (component % 3) + component / 3;  // the covariance's matrices are column by column
  if (p.kind == TrackingParameterKind::gyroscope_bias) return sensor + SensorIndex::gyroscope_bias + component;
  if (p.kind == TrackingParameterKind::accelerometer_bias) return sensor + SensorIndex::accelerometer_bias + component;
  if (p.kind == TrackingParameterKind::gyroscope_scale) return sensor + SensorIndex::gyroscope_scale + by_row;
  if (p.kind == TrackingParameterKind::accelerometer_scale) return sensor + SensorIndex::accelerometer_scale + by_row;
  const auto b = static_cast<std::size_t>(p.index);
  const auto at = static_cast<std::size_t>(p.component);
  const InsBody& body = filter.bodies[b];
  if (b == 0) return -1;
  const Index first = sensor_states * filter.layout.sensors + filter.layout.geometry[b];
  const Index parent_turns = count_before(body.free_parent_rotation, 3);
  if (p.kind == TrackingParameterKind::parent_rotation)
    return body.free_parent_rotation[at] ? first + count_before(body.free_parent_rotation, at) : -1;
  if (p.kind == TrackingParameterKind::child_rotation)
    return body.free_child_rotation[at] ? first + parent_turns + count_before(body.free_child_rotation, at) : -1;
  const Index points = first + body.turns();
  if (p.kind == TrackingParameterKind::point_in_parent) return points + component;
  return points + (body.free_point_in_parent ? 3 : 0) + component;
}

MatrixXd slow_covariance(const FilterModel& filter, const TrackingModel& model) {
  const Index size = filter.layout.size - filter.layout.fast;
  MatrixXd covariance = MatrixXd::Zero(size, size);
  std::vector<Index> at;
  for (const TrackingParameter& parameter : model.parameters) at.push_back(slow_state(filter, parameter));
  for (std::size_t i = 0; i < at.size(); ++i)
    for (std::size_t j = 0; j < at.size(); ++j)
      if (at[i] >= 0 && at[j] >= 0)
        covariance(at[i], at[j]) = model.covariance(static_cast<Index>(i), static_cast<Index>(j));
  return covariance;
}

void widen_biases(MatrixXd& covariance, Index sensor, const InsLevel& variance) {
  const Index first = sensor_states * sensor;
  covariance.diagonal().segment<3>(first + SensorIndex::gyroscope_bias).array() += variance.rate;
  covariance.diagonal().segment<3>(first + SensorIndex::accelerometer_bias).array() += variance.force;
}

/// Biases moved since the chain was identified, by their instability and from one power-up to the next.
void set_bias_changes(FilterModel& filter, const TrackingPrior& prior) {
  const InsLevel drift{std::max(min_bias_change.rate, bias_change * prior.bias_instability.rate),
                       std::max(min_bias_change.force, bias_change * prior.bias_instability.force)};
  filter.power_up = {square(power_up_part * prior.bias.rate), square(power_up_part * prior.bias.force)};
  for (Index i = 0; i < filter.layout.sensors; ++i)
    widen_biases(filter.parameters, i,
                 {square(drift.rate) + filter.power_up.rate, square(drift.force) + filter.power_up.force});
}

/// Root mean square over the directions of the axes on each sensor's segment, of its own joint and those of the next
/// segments. A turn about the axis itself is a zero of the position, and turns no axis.
void set_axis_sds(FilterModel& filter) {
  const Index geometry = filter.layout.first_geometry - filter.layout.fast;
  std::vector<double> squares(filter.bodies.size(), 0.0);
  std::vector<int> counts(filter.bodies.size(), 0);
  for (std::size_t b = 1; b < filter.bodies.size(); ++b) {
    const InsBody& body = filter.bodies[b];
    Index at = geometry + filter.layout.geometry[b];
    const auto gather = [&](std::size_t of, const std::array<bool, 3>& is_free) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (!is_free[k]) continue;
        if (k < 2) squares[of] += filter.parameters(at, at), ++counts[of];
        ++at;
      }
    };
    gather(static_cast<std::size_t>(body.parent), body.free_parent_rotation);
    gather(b, body.free_child_rotation);
  }
  for (SensorSettings& sensor : filter.sensors) {
    const auto b = static_cast<std::size_t>(sensor.body);
    if (counts[b] > 0) sensor.axis_sd = std::sqrt(squares[b] / counts[b]);
  }
}

/// What else is uncertain together with a zero is so no longer once that is exact by definition.
void find_unknown_zeros(FilterModel& filter) {
  const FilterLayout& layout = filter.layout;
  for (std::size_t b = 1; b < filter.bodies.size(); ++b) {
    const InsBody& body = filter.bodies[b];
    const bool is_between_sensors =
        body.sensor >= 0 && filter.bodies[static_cast<std::size_t>(body.parent)].sensor >= 0;
    if (body.motion != JointMotion::revolute || !body.free_child_rotation[2] || !is_between_sensors) continue;
    const Index slow = layout.first_geometry - layout.fast + layout.geometry[b] + body.turns() - 1;
    if (!(filter.parameters(slow, slow) > square(unknown_zero_sd))) continue;
    const VectorXd with_zero = filter.parameters.col(slow);
    filter.parameters -= with_zero * with_zero.transpose() / with_zero[slow];
    filter.parameters.row(slow).setZero();
    filter.parameters.col(slow).setZero();
    filter.unknown_zeros.push_back({.position = layout.position[b]});
  }
}

/// Of a body's rotations in its parent, among the slow states.
Index parent_rotation_state(const FilterModel& filter, std::size_t body) {
  return filter.layout.first_geometry - filter.layout.fast + filter.layout.geometry[body];
}

/// [rad] Of an axis in the base against gravity as the identification saw it on a base that stood still.
double cone_of(const InsBody& body, const TrackingBase& base) {
  const Vec3 axis = body.parent_R_axis.col(2);
  return std::atan2(axis.cross(base.force).norm(), std::abs(axis.dot(base.force)));
}

/// Of axes on the base. As the model has it the axis is on the circle that it may be anywhere on.
void find_unknown_axes(FilterModel& filter, const TrackingBase& base) {
  if (base.moved || base.force.isZero()) return;
  for (std::size_t b = 1; b < filter.bodies.size(); ++b) {
    const InsBody& body = filter.bodies[b];
    if (body.parent != 0 || !filter.unknown_zero(filter.layout.position[b])) continue;
    if (!body.free_parent_rotation[0] || !body.free_parent_rotation[1]) continue;
    const double cone = cone_of(body, base);
    if (cone > max_cone) continue;
    const bool is_estimated = cone > considered_cone;
    const double sd = (is_estimated ? estimated_cone_sds : considered_cone_sds) * cone;
    filter.parameters.diagonal().segment<2>(parent_rotation_state(filter, b)).array() += sd * sd;
    filter.cone_sd = std::max(filter.cone_sd, sd);
    if (is_estimated) filter.unknown_axes.push_back({.body = b});
  }
}

/// The turn θ = wᵀx of a limb that its first axis shows, among the slow states.
VectorXd turn_of_axis(const FilterModel& filter, std::size_t body) {
  const FilterLayout& layout = filter.layout;
  const InsBody& first = filter.bodies[body];
  const Vec3 axis = filter.bodies[static_cast<std::size_t>(first.parent)].child_R_axis.col(2),
             in_axes = first.parent_R_axis.transpose() * axis;
  VectorXd w = VectorXd::Zero(filter.parameters.rows());
  Index at = layout.first_geometry - layout.fast + layout.geometry[body];
  for (std::size_t k = 0; k < 3; ++k)
    if (first.free_parent_rotation[k]) w[at++] = in_axes[static_cast<Index>(k)];
  return w / std::max(w.squaredNorm(), 1e-12);
}

/// Of limbs on segments on the base, whose tilt is the base's. The rest of the covariance is what it is if the turn is
/// known.
void find_unknown_turns(FilterModel& filter) {
  for (std::size_t b = 1; b < filter.bodies.size(); ++b) {
    const auto segment = static_cast<std::size_t>(filter.bodies[b].parent);
    if (filter.bodies[segment].parent != 0 || !filter.unknown_zero(filter.layout.position[segment])) continue;
    const VectorXd turn = turn_of_axis(filter, b), with_turn = filter.parameters * turn;
    const double variance = turn.dot(with_turn);
    if (!(variance > square(unknown_zero_sd))) continue;
    filter.parameters -= with_turn * with_turn.transpose() / variance;
    filter.unknown_turns.push_back({.body = b, .segment = segment});
  }
}

/// Of a body's point in its parent, among the slow states.
Index point_state(const FilterModel& filter, std::size_t body) {
  const FilterLayout& layout = filter.layout;
  return layout.first_geometry - layout.fast + layout.geometry[body] + filter.bodies[body].turns();
}

void find_unknown_points(FilterModel& filter) {
  for (std::size_t b = 1; b < filter.bodies.size(); ++b)
    if (filter.bodies[b].free_point_in_parent &&
        filter.parameters.diagonal().segment<3>(point_state(filter, b)).maxCoeff() > square(unknown_point_sd))
      filter.unknown_points.push_back({.body = b});
}

/// From a body outward.
std::vector<std::size_t> sensors_beyond(const FilterModel& filter, std::size_t body) {
  std::vector<std::size_t> sensors;
  std::vector<bool> is_beyond(filter.bodies.size(), false);
  for (std::size_t b = body; b < filter.bodies.size(); ++b) {
    is_beyond[b] = b == body || is_beyond[static_cast<std::size_t>(filter.bodies[b].parent)];
    if (is_beyond[b] && filter.bodies[b].sensor >= 0)
      sensors.push_back(static_cast<std::size_t>(filter.bodies[b].sensor));
  }
  return sensors;
}

/// What the identification could not see becomes states: zeros and turns of which nothing is known before the first
/// row, and axes and points that are as uncertain as they were.
void separate_unseen(FilterModel& filter, const TrackingBase& base) {
  find_unknown_zeros(filter);
  find_unknown_axes(filter, base);
  find_unknown_turns(filter);
  find_unknown_points(filter);
  const auto single = static_cast<Index>(filter.unknown_zeros.size() + filter.unknown_turns.size()),
             angles = single + 2 * static_cast<Index>(filter.unknown_axes.size()),
             points = 3 * static_cast<Index>(filter.unknown_points.size());
  const Index sensors = filter.layout.first_unseen - filter.layout.fast, before = filter.parameters.rows();
  std::vector<Index> to;
  for (Index i = 0; i < before; ++i) to.push_back(i < sensors ? i : i + angles + points);
  for (std::size_t k = 0; k < filter.unknown_axes.size(); ++k)
    for (Index i = 0; i < 2; ++i)
      to[static_cast<std::size_t>(parent_rotation_state(filter, filter.unknown_axes[k].body) + i)] =
          sensors + single + 2 * static_cast<Index>(k) + i;
  for (std::size_t k = 0; k < filter.unknown_points.size(); ++k)
    for (Index i = 0; i < 3; ++i)
      to[static_cast<std::size_t>(point_state(filter, filter.unknown_points[k].body) + i)] =
          sensors + angles + 3 * static_cast<Index>(k) + i;
  MatrixXd parameters = MatrixXd::Zero(before + angles + points, before + angles + points);
  parameters(to, to) = filter.parameters;
  filter.parameters = std::move(parameters);
  filter.layout = layout_of(filter.bodies, filter.layout.sensors, angles, points);
  Index state = filter.layout.first_unseen;
  for (UnknownZero& zero : filter.unknown_zeros) zero.state = state++;
  for (UnknownTurn& turn : filter.unknown_turns) {
    turn.state = state++;
    turn.sensors = sensors_beyond(filter, turn.body);
  }
  for (UnknownAxis& axis : filter.unknown_axes) axis.state = std::exchange(state, state + 2);
  for (UnknownPoint& point : filter.unknown_points) point.state = std::exchange(state, state + 3);
}

double excess(double level, double noise) {
  return std::sqrt(std::max(0.0, level * level - noise * noise));
}

SensorSettings settings_of(const TrackingSensor& sensor) {
  SensorSettings s{.body = sensor.body,
                   .gyroscope_bias = sensor.gyroscope_bias,
                   .accelerometer_bias = sensor.accelerometer_bias,
                   .gyroscope_scale = sensor.gyroscope_scale,
                   .accelerometer_scale = sensor.accelerometer_scale};
  s.white = {std::max(min_noise.rate, sensor.noise.rate), std::max(min_noise.force, sensor.noise.force)};
  s.persistent = {excess(sensor.residual.rate, sensor.noise.rate), excess(sensor.residual.force, sensor.noise.force)};
  s.slow = sensor.slow_residual;
  if (sensor.sample_period > 0.0) s.sample_period = sensor.sample_period;
  return s;
}

/// The acceleration that a joint showed, with room for a livelier drive; hands move faster than machines.
AccelerationProcess process_of(const TrackingJoint& joint, JointMotion motion, int position) {
  AccelerationProcess process = motion == JointMotion::prismatic ? prismatic_acceleration : machine_acceleration;
  if (static_cast<std::size_t>(position) >= joint.range.size()) return process;
  const double shown = acceleration_room * joint.range[static_cast<std::size_t>(position)].acceleration;
  if (shown > process.sd) {
    process.time = std::clamp(process.time * process.sd / shown, min_acceleration_time, process.time);
    process.sd = shown;
  }
  return process;
}

PrismaticRange prismatic_range(const TrackingJoint& joint, Index position) {
  PrismaticRange result{.position = position, .half = unseen_prismatic_half, .speed = prismatic_speed};
  if (joint.range.empty()) return result;
  const auto& seen = joint.range.front();
  result.middle = 0.5 * (seen.lower + seen.upper);
  result.half = 0.5 * (seen.upper - seen.lower) + prismatic_margin;
  result.speed = std::max(prismatic_speed, seen.speed);
  return result;
}

/// The largest that was seen; as an acceleration of the process makes it, where none was.
double revolute_speed(const TrackingJoint& joint) {
  return joint.range.empty() ? machine_acceleration.sd * machine_acceleration.time
                             : std::max(least_revolute_speed, joint.range.front().speed);
}

/// The last body of a joint is the first beyond it; parents come before their children.
JointBranch branch_beyond(const TrackingModel& model, int joint) {
  JointBranch branch;
  std::vector<bool> is_beyond(model.bodies.size(), false);
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    const TrackingBody& body = model.bodies[b];
    const auto parent = static_cast<std::size_t>(body.parent);
    const bool is_first = body.joint == joint && (body.sensor >= 0 || model.bodies[parent].joint == joint);
    is_beyond[b] = is_first || is_beyond[parent];
    if (is_beyond[b]) branch.bodies.push_back(b);
    if (is_beyond[b] && body.sensor >= 0) branch.sensors.push_back(static_cast<std::size_t>(body.sensor));
  }
  return branch;
}

void set_processes(FilterModel& filter, const TrackingModel& model) {
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    const TrackingBody& body = model.bodies[b];
    const Index dof = degrees_of_freedom(filter.bodies[b].motion);
    if (dof == 0) continue;
    const TrackingJoint& joint = model.joints[static_cast<std::size_t>(body.joint)];
    // Of a universal joint's two bodies the first carries no sensor and has the first position.
    const bool is_second = joint.positions == 2 && body.sensor >= 0;
    for (Index i = 0; i < dof; ++i)
      filter.positions.push_back(process_of(joint, filter.bodies[b].motion,
                                            joint.positions == 3 ? static_cast<int>(i)
                                            : is_second          ? 1
                                                                 : 0));
    if (body.motion == TrackingMotion::prismatic)
      filter.prismatic.push_back(prismatic_range(joint, filter.layout.position[b]));
    const int parent_sensor = model.bodies[static_cast<std::size_t>(body.parent)].sensor;
    if (body.motion == TrackingMotion::revolute && dof == 1 && parent_sensor >= 0 && body.sensor >= 0)
      filter.revolute.push_back({filter.layout.position[b], static_cast<std::size_t>(parent_sensor),
                                 static_cast<std::size_t>(body.sensor), revolute_speed(joint)});
    if (body.motion == TrackingMotion::revolute && dof == 3)
      filter.loose.push_back({b, joint.stray, std::max(joint.stray_time, min_stray_time)});
  }
  filter.base_rotation = base_rotation;
  filter.base_translation = base_translation;
  filter.base_rotation.sd = std::max(base_rotation.sd, acceleration_room * model.base.angular_acceleration);
  filter.base_translation.sd = std::max(base_translation.sd, acceleration_room * model.base.acceleration);
}

}  // namespace

bool FilterModel::is_loose(std::size_t body) const {
  return std::ranges::any_of(loose, [body](const LooseRevoluteJoint& joint) { return joint.body == body; });
}

const UnknownZero* FilterModel::unknown_zero(Index position) const {
  const auto at = std::ranges::find(unknown_zeros, position, &UnknownZero::position);
  return at == unknown_zeros.end() ? nullptr : &*at;
}

const UnknownTurn* FilterModel::unknown_turn(std::size_t body) const {
  const auto at = std::ranges::find(unknown_turns, body, &UnknownTurn::body);
  return at == unknown_turns.end() ? nullptr : &*at;
}

const UnknownAxis* FilterModel::unknown_axis(std::size_t body) const {
  const auto at = std::ranges::find(unknown_axes, body, &UnknownAxis::body);
  return at == unknown_axes.end() ? nullptr : &*at;
}

const UnknownPoint* FilterModel::unknown_point(std::size_t body) const {
  const auto at = std::ranges::find(unknown_points, body, &UnknownPoint::body);
  return at == unknown_points.end() ? nullptr : &*at;
}

FilterModel filter_model(const TrackingModel& model) {
  FilterModel filter;
  for (const TrackingBody& body : model.bodies) filter.bodies.push_back(filter_body(model, body));
  for (const TrackingParameter& parameter : model.parameters)
    if (parameter.kind <= TrackingParameterKind::point_in_child)
      free_parameter(filter.bodies[static_cast<std::size_t>(parameter.index)], parameter);
  filter.layout = layout_of(filter.bodies, static_cast<Index>(model.sensors.size()));
  for (const TrackingSensor& sensor : model.sensors) filter.sensors.push_back(settings_of(sensor));
  set_processes(filter, model);
  for (std::size_t j = 0; j < model.joints.size(); ++j)
    filter.joints.push_back(branch_beyond(model, static_cast<int>(j)));
  filter.gravity = model.gravity;
  const double time = std::max(1.0, model.prior.instability_time);
  const InsLevel drift{std::max(min_bias_instability.rate, model.prior.bias_instability.rate),
                       std::max(min_bias_instability.force, model.prior.bias_instability.force)};
  filter.bias_walk = {2.0 * drift.rate * drift.rate / time, 2.0 * drift.force * drift.force / time};
  filter.instability_time = time;
  filter.bias = model.prior.bias;
  filter.parameters = slow_covariance(filter, model);
  set_bias_changes(filter, model.prior);
  separate_unseen(filter, model.base);
  set_axis_sds(filter);
  return filter;
}

FilterModel with_power_up(FilterModel model, const InsLevel& variance) {
  const InsLevel before = model.power_up;
  for (Index i = 0; i < model.layout.sensors; ++i) {
    // What persists of segments that flex and axes that stray looks like a bias that has changed.
    const InsLevel& persistent = model.sensors[static_cast<std::size_t>(i)].persistent;
    widen_biases(model.parameters, i,
                 {std::max(variance.rate, std::min(before.rate, square(persistent.rate))) - before.rate,
                  std::max(variance.force, std::min(before.force, square(persistent.force))) - before.force});
  }
  model.power_up = variance;
  return model;
}

std::vector<ModelPosition> model_positions(const TrackingModel& tracking, const FilterModel& model) {
  std::vector<ModelPosition> positions;
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    const TrackingBody& body = tracking.bodies[b];
    const int dof = static_cast<int>(degrees_of_freedom(model.bodies[b].motion));
    if (dof == 0) continue;
    const TrackingJoint& joint = tracking.joints[static_cast<std::size_t>(body.joint)];
    const bool is_second = tracking.bodies[static_cast<std::size_t>(body.parent)].joint == body.joint;
    for (int i = 0; i < dof; ++i) {
      if (!model.is_loose(b))
        positions.push_back({joint.first_position + i + (is_second ? 1 : 0), body.joint});
      else
        positions.push_back(i == 2 ? ModelPosition{joint.first_position, body.joint} : ModelPosition{});
    }
  }
  return positions;
}

}  // namespace kinfer::track

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/handover/tracking_model.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/estimate/continuous/solver/noise_update.hpp"
#include "kinfer/identify/handover/joint_ranges.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;
using Kind = TrackingParameterKind;

InsLevel level(const InsNoise& noise) {
  return {noise.angular_velocity, noise.force};
}

InsLevel largest(const InsLevel& a, const InsLevel& b) {
  return {std::max(a.rate, b.rate), std::max(a.force, b.force)};
}

/// Constant biases plus the mean of their process.
Eigen::Matrix<double, 6, 1> mean_bias(const InsUnknowns& x, std::size_t sensor) {
  Eigen::Matrix<double, 6, 1> bias;
  bias << x.errors[sensor].gyroscope_bias, x.errors[sensor].accelerometer_bias;
  if (x.bias_process.size() > 0) bias += x.bias_process.middleRows<6>(6 * static_cast<Index>(sensor)).rowwise().mean();
  return bias;
}

/// The fit's sensors that are on bodies; not those behind the links that were searched.
std::vector<std::size_t> carried_sensors(const FittedMachine& machine) {
  std::vector<std::size_t> carried;
  for (std::size_t s = 0; s < machine.problem.sensors.size(); ++s)
    if (std::ranges::count(machine.fit.unknowns.bodies, static_cast<int>(s), &InsBody::sensor) > 0)
      carried.push_back(s);
  return carried;
}

/// Index into the model's sensors; −1 stays.
int renumbered(const std::vector<std::size_t>& carried, int sensor) {
  return sensor < 0 ? -1
                    : static_cast<int>(std::ranges::find(carried, static_cast<std::size_t>(sensor)) - carried.begin());
}

/// The matrix S of an instrument whose recording was divided by a factor before the fit.
Mat3 undivided(const Mat3& scale, const InsCommonScale& common) {
  return common.factor * (Mat3::Identity() + scale) - Mat3::Identity();
}

InsLevel undivided(const InsLevel& level, const InsCommonScales& common) {
  return {common.gyroscope.factor * level.rate, common.accelerometer.factor * level.force};
}

TrackingSensor tracking_sensor(const FittedMachine& machine, const std::vector<InsNoise>& slow, std::size_t s) {
  const InsErrors& errors = machine.fit.unknowns.errors[s];
  const auto bias = mean_bias(machine.fit.unknowns, s);
  const InsBodies& bodies = machine.fit.unknowns.bodies;
  const InsSensor& sensor = machine.recording.sensors[s];
  const auto body = std::ranges::find(bodies, static_cast<int>(s), &InsBody::sensor);
  const InsCommonScales& common = machine.problem.common;
  return {.name = sensor.name,
          .body = static_cast<int>(body - bodies.begin()),
          .gyroscope_bias = common.gyroscope.factor * bias.head<3>(),
          .accelerometer_bias = common.accelerometer.factor * bias.tail<3>(),
          .gyroscope_scale = undivided(errors.gyroscope_scale, common.gyroscope),
          .accelerometer_scale = undivided(errors.accelerometer_scale, common.accelerometer),
          .noise = undivided(level(machine.noise_floor[s]), common),
          .residual = undivided(largest(level(machine.noise[s]), level(machine.noise_floor[s])), common),
          .slow_residual = undivided(level(slow[s]), common),
          .sample_period = median_period(machine.recording.time(sensor)),
          .mount_compliance = errors.tilt,
          .mount_stray = machine.error.mount_deflection.empty() ? 0.0 : machine.error.mount_deflection[s]};
}

TrackingPrior tracking_prior(const InsProblem& problem) {
  return {.rotation = problem.rotation_sd,
          .point = problem.point_sd,
          .bias = {problem.prior.gyroscope_bias, problem.prior.accelerometer_bias},
          .scale = {problem.prior.gyroscope_scale, problem.prior.accelerometer_scale},
          .bias_instability = {problem.bias_process.rate_sd, problem.bias_process.force_sd},
          .instability_time = problem.bias_process.time};
}

int position_count(EstimatedJointType type) {
  switch (type) {
    case EstimatedJointType::rigid:
      return 0;
    case EstimatedJointType::universal:
      return 2;
    case EstimatedJointType::spherical:
      return 3;
    default:
      return 1;
  }
}

/// The parameters' rows so far, their Jacobian by the fit's global parameters, and blocks that replace what follows
/// from it.
struct Parameters {
  explicit Parameters(Index unknowns) : jacobian(0, unknowns) {}
  std::vector<TrackingParameter> list;
  MatrixXd jacobian;
  std::vector<std::pair<Index, MatrixXd>> replaced;  // first row, covariance
  std::vector<std::pair<Index, double>> added;       // row, variance beside that of the global parameters

  void add(const TrackingParameter& parameter) { list.push_back(parameter); }
  auto new_rows(Index count) {
    jacobian.conservativeResize(jacobian.rows() + count, Eigen::NoChange);
    jacobian.bottomRows(count).setZero();
    return jacobian.bottomRows(count);
  }
};

TrackedBodies bodies_of(const FittedJoint& joint, const InsBodies& all) {
  if (joint.mean) return tracked_bodies(joint.estimate.type, {&joint.mean->body, 1}, joint.zero, joint.geometry);
  const auto bodies = std::span(all).subspan(joint.bodies.first, joint.bodies.last - joint.bodies.first + 1);
  return tracked_bodies(joint.estimate.type, bodies, joint.zero, joint.geometry);
}

/// Rows of a joint. A relaxed joint's axes are no unknowns of the fit; its points are, the last six of the mean's.
void add_joint_rows(Parameters& parameters, const FittedMachine& machine, const FittedJoint& joint,
                    const TrackedBodies& tracked) {
  for (TrackingParameter parameter : tracked.parameters) {
    parameter.index += static_cast<int>(joint.bodies.first);
    parameters.add(parameter);
  }
  const Index first = first_unknown(machine.fit.layout, joint.bodies);
  const Index row = parameters.jacobian.rows();
  auto rows = parameters.new_rows(tracked.jacobian.rows());
  if (!joint.mean) {
    rows.middleCols(first, tracked.jacobian.cols()) = tracked.jacobian;
    return;
  }
  rows.middleCols<6>(first) = tracked.jacobian.rightCols<6>();
  parameters.replaced.emplace_back(row, propagated_covariance(tracked.jacobian, joint.mean->covariance));
}

/// The zero of a revolute joint's positions is a rotation of B about the axis. It was found in the same fit as geometry
/// and sensors, and shares their errors: with the same accelerometer biases gravity shows the same angle again.
void add_zero_rows(Parameters& parameters, const FittedMachine& machine, const FittedJoint& joint,
                   const TrackedBodies& tracked) {
  if (joint.mean) return;
  for (std::size_t i = 0; i < joint.at_zero.size(); ++i) {
    const std::size_t body = joint.bodies.first + i;
    const InsBody& fitted = machine.fit.unknowns.bodies[body];
    if (fitted.motion != JointMotion::revolute) continue;
    const Index spline = machine.fit.layout.spline_dimension[body];
    const double sense = tracked.bodies[i].child_R_axis.col(2).dot(fitted.child_R_axis.col(2)) < 0.0 ? 1.0 : -1.0;
    parameters.add({Kind::child_rotation, static_cast<int>(body), 2});
    parameters.added.emplace_back(parameters.jacobian.rows(), joint.at_zero[i].conditional(spline, spline));
    parameters.new_rows(1) = sense * joint.at_zero[i].by_global_parameters.row(spline);
  }
}

void add_joint(TrackingModel& model, Parameters& parameters, const FittedMachine& machine, const FittedJoint& joint,
               const std::vector<std::size_t>& carried) {
  const TrackedBodies tracked = bodies_of(joint, machine.fit.unknowns.bodies);
  for (std::size_t i = 0; i < tracked.bodies.size(); ++i) {
    const InsBody& fitted = machine.fit.unknowns.bodies[joint.bodies.first + i];
    TrackingBody body = tracked.bodies[i];
    body.parent = fitted.parent;
    body.sensor = renumbered(carried, fitted.sensor);
    body.joint = static_cast<int>(model.joints.size());
    model.bodies.push_back(body);
  }
  TrackingJoint made{.name = joint_name(joint.estimate), .type = joint.estimate.type};
  made.first_position = model.positions();
  made.positions = position_count(joint.estimate.type);
  made.range = joint_ranges(joint.estimate, machine.problem.grid, joint_splines(machine.fit, joint.bodies));
  if (joint.mean) {
    made.stray = joint.mean->axis_deviation / std::sqrt(2.0);
    made.stray_time = joint.mean->deviation_memory * machine.problem.grid.period;
  }
  model.joints.push_back(std::move(made));
  add_joint_rows(parameters, machine, joint, tracked);
  add_zero_rows(parameters, machine, joint, tracked);
}

void add_sensor_rows(Parameters& parameters, const FittedMachine& machine, std::size_t sensor, int number) {
  const auto add = [&](Kind kind, Index first, Index count, const InsCommonScale& common) {
    for (Index i = 0; i < count; ++i) parameters.add({kind, number, static_cast<int>(i)});
    parameters.new_rows(count).middleCols(first, count).diagonal().setConstant(common.factor);
  };
  const Index first = machine.fit.layout.error[sensor];
  const InsCommonScales& common = machine.problem.common;
  add(Kind::gyroscope_bias, first, 3, common.gyroscope);
  add(Kind::accelerometer_bias, first + 3, 3, common.accelerometer);
  if (!machine.fit.layout.has_matrices) return;
  add(Kind::gyroscope_scale, first + 6, 9, common.gyroscope);
  add(Kind::accelerometer_scale, first + 15, 9, common.accelerometer);
}

MatrixXd covariance_of(const Parameters& parameters, ConstMatrixRef covariance) {
  MatrixXd result = propagated_covariance(parameters.jacobian, covariance);
  for (const auto& [row, block] : parameters.replaced) result.block(row, row, block.rows(), block.cols()) = block;
  for (const auto& [row, variance] : parameters.added) result(row, row) += variance;
  return 0.5 * (result + result.transpose());
}

void set_gravity(TrackingModel& model, const FittedMachine& machine) {
  const InsProblem& problem = machine.problem;
  model.gravity = problem.gravity;
  model.gravity_sd = problem.gravity_sd;
  model.base = base_motion(problem, machine.fit);
  if (!problem.root_at_rest) return;
  model.gravity = model.base.force.norm();
  const Vec3 up = model.base.force / model.gravity;
  const Index at = machine.fit.layout.root_force;
  model.gravity_sd = std::sqrt(std::max(0.0, up.dot(machine.covariance.block<3, 3>(at, at) * up)));
}

}  // namespace

TrackingModel tracking_model(const FittedMachine& machine) {
  TrackingModel model;
  const InsFit& fit = machine.fit;
  const std::vector<InsNoise> slow = long_run_noise(machine.problem, fit.cost);
  const std::vector<std::size_t> carried = carried_sensors(machine);
  for (const std::size_t s : carried) model.sensors.push_back(tracking_sensor(machine, slow, s));
  model.prior = tracking_prior(machine.problem);
  set_gravity(model, machine);
  model.bodies.push_back({.sensor = renumbered(carried, fit.unknowns.bodies.front().sensor)});
  Parameters parameters(fit.layout.global_parameters);
  for (const FittedJoint& joint : machine.joints) add_joint(model, parameters, machine, joint, carried);
  for (std::size_t i = 0; i < carried.size(); ++i)
    add_sensor_rows(parameters, machine, carried[i], static_cast<int>(i));
  model.parameters = std::move(parameters.list);
  model.covariance = covariance_of(parameters, machine.covariance);
  model.tool.body = static_cast<int>(model.bodies.size()) - 1;
  expect_well_formed(model);
  return model;
}

}  // namespace kinfer::identify

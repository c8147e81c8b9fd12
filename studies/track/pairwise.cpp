// SPDX-License-Identifier: Apache-2.0
#include "studies/track/pairwise.hpp"

#include <cmath>
#include <limits>

#include "kinfer/base/square.hpp"
#include "kinfer/geometry/rotation.hpp"

namespace kinfer::study::track_study {
namespace {

constexpr double start_sd = 1.0;  // [rad] of headings, and of tilts in motion

/// Force of the joint's centre, in the sensor's frame.
template <class Sensor>
Vec3 force_at(const Sensor& sensor, const Vec3& arm) {
  return sensor.force + sensor.change.cross(arm) + sensor.rate.cross(sensor.rate.cross(arm));
}

template <class Sensor>
double variance_at(const Sensor& sensor, const Vec3& arm) {
  return square(sensor.force_sd) +
         arm.squaredNorm() * (square(sensor.change_sd) + square(2.0 * sensor.rate.norm() * sensor.rate_sd));
}

}  // namespace

PairwiseFilters::PairwiseFilters(const TrackingModel& model)
    : model_(model), sensors_(model.sensors.size()), pairs_(model.joints.size()) {
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    const TrackingBody& body = model.bodies[b];
    const TrackingBody& parent = model.bodies[static_cast<std::size_t>(body.parent)];
    const bool is_pair = body.sensor >= 0 && parent.sensor >= 0 && body.motion != TrackingMotion::prismatic;
    Pair& pair = pairs_[static_cast<std::size_t>(body.joint)];
    if (!is_pair) continue;
    pair = {.parent = static_cast<std::size_t>(parent.sensor),
            .child = static_cast<std::size_t>(body.sensor),
            .in_parent = body.point_in_parent,
            .in_child = body.point_in_child,
            .is_used = true};
  }
  for (std::size_t s = 0; s < sensors_.size(); ++s) {
    sensors_[s].rate_sd = std::max(1e-4, model.sensors[s].residual.rate);
    sensors_[s].force_sd = std::max(1e-3, model.sensors[s].residual.force);
  }
}

void PairwiseFilters::update(Pair& pair, double dt) const {
  const Sensor &parent = sensors_[pair.parent], &child = sensors_[pair.child];
  if (!pair.has_started) {
    pair.world_R_parent = Quat(kinfer::rotation_between(parent.force.normalized(), Vec3::UnitZ())).toRotationMatrix();
    pair.world_R_child = Quat(kinfer::rotation_between(child.force.normalized(), Vec3::UnitZ())).toRotationMatrix();
    pair.covariance = square(start_sd) * Eigen::Matrix<double, 6, 6>::Identity();
    pair.has_started = true;
  }
  pair.world_R_parent *= exp_so3(dt * parent.mean_rate);
  pair.world_R_child *= exp_so3(dt * child.mean_rate);
  pair.covariance.diagonal().head<3>().array() += square(dt * parent.rate_sd);
  pair.covariance.diagonal().tail<3>().array() += square(dt * child.rate_sd);
  const Vec3 of_parent = pair.world_R_parent * force_at(parent, pair.in_parent),
             of_child = pair.world_R_child * force_at(child, pair.in_child);
  Eigen::Matrix<double, 3, 6> by_error;
  by_error << -skew(of_parent), skew(of_child);
  const double noise = variance_at(parent, pair.in_parent) + variance_at(child, pair.in_child);
  const Mat3 spread = by_error * pair.covariance * by_error.transpose() + noise * Mat3::Identity();
  const Eigen::Matrix<double, 6, 3> gain = pair.covariance * by_error.transpose() * spread.inverse();
  const Eigen::Matrix<double, 6, 1> error = gain * (of_child - of_parent);
  pair.covariance -= (gain * spread * gain.transpose()).eval();
  pair.world_R_parent = Mat3(exp_so3(Vec3(error.head<3>())) * pair.world_R_parent);
  pair.world_R_child = Mat3(exp_so3(Vec3(error.tail<3>())) * pair.world_R_child);
}

/// A row is processed when the next one is there, for ω̇.
void PairwiseFilters::add(const InsRow& row) {
  if (rows_++ > 1) {
    const double dt = last_.time - before_.time, around = row.time - before_.time;
    for (std::size_t s = 0; s < sensors_.size(); ++s) {
      const InsSample &now = last_.sensors[s], &next = row.sensors[s], &past = before_.sensors[s];
      if (!now.has_angular_velocity || !now.has_acceleration || !next.has_angular_velocity ||
          !past.has_angular_velocity)
        continue;
      sensors_[s].rate = now.angular_velocity - model_.sensors[s].gyroscope_bias;
      sensors_[s].mean_rate = 0.5 * (past.angular_velocity + now.angular_velocity) - model_.sensors[s].gyroscope_bias;
      sensors_[s].force = now.acceleration - model_.sensors[s].accelerometer_bias;
      sensors_[s].change = (next.angular_velocity - past.angular_velocity) / around;
      sensors_[s].change_sd = std::sqrt(2.0) * sensors_[s].rate_sd / around;
    }
    for (Pair& pair : pairs_)
      if (pair.is_used) update(pair, dt);
  }
  before_ = last_;
  last_ = row;
}

Mat3 PairwiseFilters::rotation(std::size_t joint) const {
  const Pair& pair = pairs_[joint];
  if (!pair.has_started) return Mat3::Constant(std::numeric_limits<double>::quiet_NaN());
  return pair.world_R_parent.transpose() * pair.world_R_child;
}

}  // namespace kinfer::study::track_study

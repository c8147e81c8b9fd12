// SPDX-License-Identifier: Apache-2.0
// How well two INS agree with a joint between their segments: the relative motion left after fitting a common point.
//
// Two segments that share a joint share a point (its centre), on whose acceleration both INS must agree:
//   f_i + K_i r_i + R_i b_i = E (f_j + K_j r_j + R_j b_j),  K = (skew(ω̇) + skew(ω)²) R, in the world,
// with the specific force f. The lever arms r and the accelerometer biases b are linear in it. E, the rotation between
// the world frames of the two orientation estimates, is not: a heading ψ, linear in time, because magnetometers near
// steel are disturbed and a heading without one is arbitrary; and a tilt, because accelerometer biases tilt the
// estimated verticals. They are searched with the linear unknowns eliminated at each step (variable projection, Golub
// and Pereyra 1973).
//
// The pair's distance is the code length of a row of its relative motion, i.e. of one segment's motion given the
// other's: ½ log det of the covariance of the acceleration residual plus the same of the relative angular velocity, in
// nats. A joint's degrees of freedom are coded at the size of their motion, its constraints at the size of the noise.
// So a revolute joint is nearer than a spherical joint at the same point (a wrist), a prismatic joint costs only its
// one direction, and the minimum spanning tree of these distances is the most likely tree (Chow and Liu 1968).
#pragma once

#include <cmath>
#include <vector>

#include "kinfer/inertial/headings.hpp"

namespace kinfer::identify {

struct PairFit {
  std::size_t first = 0, second = 0;                                   ///< indices of segments, first < second
  LinearHeading heading{};                                             ///< of second's world frame in first's
  Eigen::Vector2d tilt{0.0, 0.0};                                      ///< [rad] likewise, about horizontal axes
  Vec3 point_in_first = Vec3::Zero(), point_in_second = Vec3::Zero();  ///< [m] the common point, as far as observable
  Vec3 bias_of_first = Vec3::Zero(), bias_of_second = Vec3::Zero();    ///< [m/s²] negative accelerometer biases
  Mat3 acceleration = Mat3::Zero();      ///< [(m/s²)²] mean square of the residual, in the first sensor
  Mat3 angular_velocity = Mat3::Zero();  ///< [(rad/s)²] mean square of the relative angular velocity, likewise
  double distance = 0.0;                 ///< [nats] code length per row

  double residual() const { return std::sqrt(acceleration.trace()); }  ///< [m/s²] rms, prismatic motion included
  double relative_rate() const { return std::sqrt(angular_velocity.trace()); }  ///< [rad/s] rms
  double off_axis_rate() const;  ///< [rad/s] rms across the principal direction
};

struct PairFitOptions {
  double lever_sd = 3.0;             ///< [m] prior sd of lever arms
  double bias_sd = 0.3;              ///< [m/s²] prior sd of an accelerometer bias: 30 mg
  double acceleration_floor = 0.01;  ///< [m/s²] residual of the best INS; smaller differences are not informative
  double rate_floor = 3e-3;          ///< [rad/s] likewise
  double heading_sd = 0.5;           ///< [rad] between two magnetometers' headings; see `headings_from_magnetometers`
  double drift_sd = 2e-3;            ///< [rad/s] of a heading without magnetometer
  double tilt_sd = 0.03;             ///< [rad] between two verticals: accelerometers of 20 mg
  bool headings_from_magnetometers = false;  ///< headings come from magnetometers
};

/// `rows` of the motion: usable, evenly spaced, at least 50.
PairFit fit_pair(const RecordedMotion& motion, std::size_t first, std::size_t second,
                 const std::vector<std::size_t>& rows, const PairFitOptions& options = {});

}  // namespace kinfer::identify

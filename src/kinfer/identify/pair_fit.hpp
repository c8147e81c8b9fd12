// How much two INS agree that their segments share a joint: what is left of the relative motion once a common point is
// fitted.
//
// Two segments that share a joint share a point (its centre), on whose acceleration both INS must agree:
//   f_i + K_i r_i + R_i b_i = E (f_j + K_j r_j + R_j b_j),  K = (skew(ω̇) + skew(ω)²) R, in the ground,
// with the specific force f. The lever arms r and the accelerometers' biases b are linear in it. E, what the two
// orientations' grounds differ by, is not: a heading ψ, because magnetometers near steel lie and a heading without one
// is arbitrary, a straight line of time; and a tilt, because the biases of cheap accelerometers lean the verticals.
// They are searched with the linear unknowns eliminated at each step (variable projection, Golub and Pereyra 1973).
//
// The pair's distance is the code length of a row of its relative motion, that is of what has to be told of the one
// segment when the other's motion is known: ½ log det of the covariance of the acceleration residual plus the same of
// the relative rate, in nats. A joint's freedoms are told at their size, everything it forbids at the size of noise. So
// a hinge is nearer than a spherical joint at the same point (the wrist), a slide costs its one direction only, and a
// minimum spanning tree of these distances is the most likely tree (Chow and Liu 1968).
#pragma once

#include <cmath>
#include <vector>

#include "kinfer/inertial/headings.hpp"

namespace kinfer {

struct PairFit {
  std::size_t first = 0, second = 0;                                   ///< indices of segments, first < second
  HeadingLine heading{};                                               ///< of second's ground against first's
  Eigen::Vector2d tilt{0.0, 0.0};                                      ///< [rad] likewise, about level axes
  Vec3 point_in_first = Vec3::Zero(), point_in_second = Vec3::Zero();  ///< [m] the common point, as far as it shows
  Vec3 bias_of_first = Vec3::Zero(), bias_of_second = Vec3::Zero();    ///< [m/s²] of the accelerometers, less sign
  Mat3 acceleration = Mat3::Zero();  ///< [(m/s²)²] mean square of the residual, in the first sensor
  Mat3 rate = Mat3::Zero();          ///< [(rad/s)²] mean square of the relative rate, in the first sensor
  double distance = 0.0;             ///< [nats] code length of a row

  double residual() const { return std::sqrt(acceleration.trace()); }  ///< [m/s²] rms, slide included
  double relative_rate() const { return std::sqrt(rate.trace()); }     ///< [rad/s] rms
  double off_axis_rate() const;                                        ///< [rad/s] rms across the principal direction
};

struct PairFitOptions {
  double longest_lever = 3.0;        ///< [m] sd of lever arms before any data
  double largest_bias = 0.3;         ///< [m/s²] sd of an accelerometer's bias: 30 mg
  double acceleration_floor = 0.01;  ///< [m/s²] differences below it tell nothing: what the best INS leave
  double rate_floor = 3e-3;          ///< [rad/s] likewise
  double heading_sd = 0.5;           ///< [rad] how far two magnetometers' headings may differ; see `headings_known`
  double drift_sd = 2e-3;            ///< [rad/s] of a heading without magnetometer
  double tilt_sd = 0.03;             ///< [rad] of two verticals: accelerometers of 20 mg
  bool headings_known = false;       ///< the orientations' headings come from magnetometers
};

/// `rows` of the motion: sound, evenly spread, at least 50.
PairFit fit_pair(const RecordedMotion& motion, std::size_t first, std::size_t second,
                 const std::vector<std::size_t>& rows, const PairFitOptions& options = {});

}  // namespace kinfer

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

#include "kinfer/identify/structure/pair_problem.hpp"

namespace kinfer::identify {

/// `rows` of the motion: usable, evenly spaced, at least 50.
PairFit fit_pair(const RecordedMotion& motion, std::size_t first, std::size_t second,
                 const std::vector<std::size_t>& rows, HeadingReference headings = HeadingReference::arbitrary);

}  // namespace kinfer::identify

// SPDX-License-Identifier: Apache-2.0
// Series of harmonics in a chain: the first harmonics of their joints, of orders 0, 1, 2, … without a gap; and a chain
// with its series detached, for fits that treat them apart.
#pragma once

#include <vector>

#include "kinfer/calibrate/functions/periodic_spline.hpp"
#include "kinfer/kinematics/parameters.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::calibrate {

/// The highest order of the joint's series; 0 where it has none.
int series_order(const Joint& joint);
bool has_series(const Chain& chain);
/// Whether a harmonic of that order is part of the joint's series.
bool is_in_series(const Joint& joint, double order);

/// The chain with the values of its series zero.
Chain without_series(Chain chain);

/// The chain with the series of another one with the same joints, in place of its own.
Chain with_series_of(Chain chain, const Chain& other);

/// A sine or cosine of a harmonic.
bool is_harmonic_field(Field field);

/// The series of one joint.
struct JointSeries {
  int joint = 0;
  Resolution resolution;
  VectorXd coefficients;  ///< [rad] of all knots
};

/// A chain without the entries of its series; parameters of other harmonics refer to it.
struct DetachedSeries {
  Chain plain;
  ParameterSet set;
  std::vector<JointSeries> series;
};

DetachedSeries detach(const Chain& chain, const ParameterSet& set);
Chain attach(Chain plain, const std::vector<JointSeries>& series);

/// The chain with its series moved by steps of their coefficients, all knots of one after those of the one before.
Chain with_series_moved(const Chain& chain, const VectorXd& step);

/// The joints moved by their series, which a chain without them then need not have: what other terms make of the small
/// difference is below a tenth of a micrometre.
PoseSet with_moved_joints(PoseSet rows, const Chain& plain, const std::vector<JointSeries>& series);

}  // namespace kinfer::calibrate

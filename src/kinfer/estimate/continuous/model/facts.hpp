// SPDX-License-Identifier: Apache-2.0
// What is known of a machine besides its recording (facts), in the terms of the continuous-time fit: touches, tape
// distances, surveyed points and loop closures, each a few residuals at one time.
#pragma once

#include <vector>

#include "kinfer/estimate/continuous/model/chain_propagation.hpp"
#include "kinfer/geometry/pose.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer {

/// A point or a joint axis fixed to a body.
struct InsPoint {
  enum class Kind { sensor, joint_centre, joint_axis, place };
  Kind kind = Kind::sensor;
  int body = 0;    ///< the body it is fixed to; for a joint: the joint's child body
  int place = -1;  ///< index into InsFacts::places
};

/// A point of a body with unknown coordinates in the frame of the body's sensor.
struct InsUnknownPoint {
  int body = 0;
  Vec3 start = Vec3::Zero();  ///< [m] prior mean
  double sd = 3.0;            ///< [m] per axis, of the prior
};

/// The point was at the same unknown position, fixed relative to the root, at all of these times.
struct InsRevisitedPoint {
  InsPoint point;
  std::vector<double> at;  ///< [s]
  double sd = 0.0;         ///< [m] per axis
};

/// The shortest distance between two points or lines.
struct InsTapeDistance {
  InsPoint from, to;
  double length = 0.0, sd = 0.0;  ///< [m]
  double at = 0.0;                ///< [s]
};

/// Measured position of the point in a surveyor's frame, which is fixed relative to the root.
struct InsSurveyedPoint {
  InsPoint point;
  double at = 0.0;          ///< [s]
  Vec3 xyz = Vec3::Zero();  ///< [m] in the surveyor's frame
  double sd = 0.0;          ///< [m] per axis
};

/// A rotation of the sub-tree behind the body `child` about the axis of its parent body, `body`.
struct InsAzimuth {
  std::size_t body = 0, child = 0;
};

/// Azimuths as the magnetometers tell them: each is 0 where its direction (azimuth_direction) is the one stated here.
struct InsAzimuthMeasurement {
  std::vector<InsAzimuth> azimuths;
  std::vector<Vec3> directions;  ///< one each, in the frame of the body
  MatrixXd whitening;            ///< W with information WᵀW of all azimuths together [1/rad]
};

/// A revolute joint between two bodies of the tree, which closes a kinematic loop. It is an unknown like the tree's
/// joints, but has no joint position: whenever it holds, its lines in both bodies coincide.
struct InsClosure {
  int first = 0, second = 0;             ///< bodies
  InsBody start{};                       ///< revolute, its parent is `first`, its child `second`
  std::vector<double> at{};              ///< [s]
  double point_sd = 0.0, axis_sd = 0.0;  ///< [m] per axis, [rad] per component: at one time
};
inline constexpr Eigen::Index closure_unknowns = 10;

struct InsFacts {
  std::vector<InsUnknownPoint> places;
  std::vector<InsRevisitedPoint> touches;
  std::vector<InsTapeDistance> tapes;
  std::vector<InsSurveyedPoint> surveyed;
  InsAzimuthMeasurement azimuth{};
  std::vector<InsClosure> closures{};
};

/// Whether a fact ends at the axis of the joint that carries the body.
bool is_measured_axis(const InsFacts& facts, std::size_t body);

/// Additional unknowns of the facts: 3 per unknown point, 3 per touch, 10 per closure, 6 for the surveyor's frame if
/// there is one.
struct InsFactUnknowns {
  std::vector<Vec3> places;         ///< [m] in the sensor's frame
  std::vector<Vec3> touched;        ///< [m] in the root's frame
  std::vector<InsBody> closures{};  ///< revolute joints, as InsClosure::start
  Pose surveyor;                    ///< root_T_surveyor
};

}  // namespace kinfer

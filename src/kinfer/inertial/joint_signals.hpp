// SPDX-License-Identifier: Apache-2.0
// Relative motion between the INS of two neighbouring segments: candidates for the joint variables of a chain.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kinfer/inertial/segment_motion.hpp"

namespace kinfer {

/// A candidate for a joint variable, one entry per row of the common clock.
struct JointSignal {
  std::string name;                          ///< "psi", "q"
  std::vector<double> angle;                 ///< [rad], continuous
  std::vector<double> angular_velocity;      ///< [rad/s], smoothed
  std::vector<double> angular_acceleration;  ///< [rad/s²], smoothed
};

enum class JointVariableKind {
  euler,  ///< eqs. (18), (19) of paper 1: differences of roll, pitch and yaw; these are joint angles only if the
          ///< sensors are aligned with the joint axes
  hinge   ///< angle of the relative rotation about the principal axis of the relative angular velocity
};

struct JointSignalOptions {
  JointVariableKind terminals = JointVariableKind::hinge;
  double smoothing = 0.02;       ///< [s] as for the accelerations
  double min_excitation = 0.05;  ///< fraction of the largest signal's standard deviation; weaker signals are dropped
  double min_rotation = 0.02;    ///< [rad] standard deviation below which a signal counts as no rotation
};

/// The excited signals between two segments; empty if the segments do not rotate relative to each other.
std::vector<JointSignal> find_joint_signals(const RecordedMotion& motion, std::size_t parent, std::size_t child,
                                            const JointSignalOptions& options = {});

/// Roll, pitch, yaw (ZYX) of world_R_sensor: phi = atan2(R32, R33), theta = -asin R31, psi = atan2(R21, R11). Eq. (23)
/// of paper 1 holds for the transposed matrix, and (23a) misprints R33.
Vec3 euler_angles(const Mat3& world_R_sensor);

/// The second Euler representation of a rotation: (phi, theta, psi) -> (phi + pi, pi - theta, psi + pi).
Vec3 alternative_euler_angles(const Vec3& angles);

}  // namespace kinfer

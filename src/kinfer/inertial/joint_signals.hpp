// Relative motion between the INS on two neighbouring segments: the terminals that a chain's variables may be.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kinfer/inertial/segment_motion.hpp"

namespace kinfer {

/// A candidate for a joint's variable, one entry a row of the common clock.
struct JointSignal {
  std::string name;                 ///< "psi", "q"
  std::vector<double> angle;        ///< [rad], continuous
  std::vector<double> rate;         ///< [rad/s], smoothed
  std::vector<double> rate_change;  ///< [rad/s²], smoothed
};

enum class Terminals {
  euler,  ///< eqs. (18), (19) of paper 1: differences of roll, pitch and yaw; joint angles only for sensors mounted
          ///< square
  hinge   ///< the turn of the relative rotation about the axis that the relative rate points along
};

struct JointSignalOptions {
  Terminals terminals = Terminals::hinge;
  double smoothing = 0.02;         ///< [s] as that of the accelerations
  double least_excitation = 0.05;  ///< of the largest signal's standard deviation: less excited signals are not offered
  double least_turn = 0.02;        ///< [rad] standard deviation: less is no turn at all
};

/// The signals between two segments that are excited; empty where they do not turn against each other.
std::vector<JointSignal> joint_signals(const RecordedMotion& motion, std::size_t parent, std::size_t child,
                                       const JointSignalOptions& options = {});

/// Roll, pitch, yaw (ZYX) of ground_R_sensor: phi = atan2(R32, R33), theta = -asin R31, psi = atan2(R21, R11). Eq. (23)
/// of paper 1 holds for the transposed matrix, and (23a) misprints R33.
Vec3 euler_angles(const Mat3& ground_R_sensor);

/// The two readings of one rotation in roll, pitch, yaw: (phi, theta, psi) and (phi + pi, pi - theta, psi + pi).
Vec3 other_euler_angles(const Vec3& angles);

/// Difference of two angles in (−pi, pi].
double wrapped(double angle);

}  // namespace kinfer

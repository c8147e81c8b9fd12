// SPDX-License-Identifier: Apache-2.0
// Excitation of the joints for identification: rest first, then joint by joint as paper 1 prescribes, then all
// together. Smooth trajectories with continuous derivatives up to every order that affects an accelerometer.
//
// A movement is w(t) Σ aₖ sin(2π fₖ (t − t₀) + φₖ): the window w rises from 0 to 1 and falls back, four times
// continuously differentiable.
#pragma once

#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/simulate/machine.hpp"

namespace kinfer {

struct Wave {
  double amplitude = 0.0;  ///< [rad] or [m]
  double frequency = 1.0;  ///< [Hz]
  double phase = 0.0;      ///< [rad]
};

struct Movement {
  double begin = 0.0, end = 0.0;  ///< [s]
  std::vector<Wave> waves{};
};

/// Position of a joint and its derivatives at one time.
struct JointState {
  double q = 0.0;    ///< [rad] or [m]
  double qd = 0.0;   ///< per second
  double qdd = 0.0;  ///< per second²
};

struct JointTrajectory {
  double home = 0.0;
  std::vector<Movement> movements{};
};
JointState state_at(const JointTrajectory& drive, double time);

/// A time segment in which one joint moves, or all.
struct Phase {
  std::string what;               ///< the joint's name, "all", or "rest"
  double begin = 0.0, end = 0.0;  ///< [s]
};

struct Drive {
  std::vector<JointTrajectory> joints{};  ///< in the order of the machine's joint positions
  std::vector<Phase> phases{};  ///< of the machine; a moving base moves in all of them but the first and last rest
  double duration = 0.0;        ///< [s]
};

enum class Script {
  standard,    ///< 4 s rest, 6 s per joint, 16 s all together
  sequential,  ///< 4 s rest, 6 s per joint
  together,    ///< 4 s rest, then all together for 30 s
  gentle,      ///< the standard drive at 45 % of its size
  vigorous,    ///< the standard drive at 180 % of its velocities, as far as the joint ranges allow
  quick        ///< the standard drive at four times the frequencies and the same velocities: an arm, not a machine
};

struct ExcitationOptions {
  Script script = Script::standard;
  double duration = 0.0;                  ///< [s]; 0: as the script; else the movements are scaled in time to fit
  double rest = 4.0;                      ///< [s] initial rest
  double max_angular_velocity = 0.8;      ///< [rad/s] largest angular velocity of a revolute joint
  double max_velocity = 0.5;              ///< [m/s] largest velocity of a prismatic joint
  double max_angular_acceleration = 2.2;  ///< [rad/s²] largest of a revolute joint
  double max_acceleration = 2.0;          ///< [m/s²] largest of a prismatic joint
  double together = 0.6;  ///< fraction of these while all joints move, since joint velocities add up along an arm
  Angle rocking = Angle::deg(1.5);  ///< largest roll and pitch of a rocking base
  Angle yawing = Angle::deg(15);    ///< largest yaw of a yawing base
  double heave = 0.02;              ///< [m] of a rocking base
};

/// Draws the movements of the joints at random. An error if the duration leaves less than 1 s for a movement.
Result<Drive> make_drive(const Machine& machine, const ExcitationOptions& options, Rng rng);

}  // namespace kinfer

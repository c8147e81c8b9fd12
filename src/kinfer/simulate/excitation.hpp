// How the joints are driven so that a machine shows what it is: rest first, joint after joint as paper 1 asks for, then
// all together. Smooth functions of time with derivatives of every order that an accelerometer can see.
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

/// Reading of a joint and its derivatives at one time.
struct JointState {
  double q = 0.0;    ///< [rad] or [m]
  double qd = 0.0;   ///< per second
  double qdd = 0.0;  ///< per second²
};

struct JointDrive {
  double home = 0.0;
  std::vector<Movement> movements{};
};
JointState state_at(const JointDrive& drive, double time);

/// A stretch of time in which one joint moves, or all.
struct Phase {
  std::string what;               ///< the joint's name, "all", or "rest"
  double begin = 0.0, end = 0.0;  ///< [s]
};

struct Drive {
  std::vector<JointDrive> joints{};  ///< in the order of the machine's readings
  std::vector<Phase> phases{};       ///< of the machine; a moving base moves through all of them but the first rest
  double duration = 0.0;             ///< [s]
};

enum class Script {
  standard,    ///< 4 s rest, 6 s a joint, 16 s all together
  sequential,  ///< 4 s rest, 6 s a joint
  together,    ///< 4 s rest, then all together for 30 s
  gentle,      ///< the standard drive at 45 % of its size
  vigorous,    ///< the standard drive at 180 % of its rates, as far as the joints' ranges let it
  quick        ///< the standard drive with waves four times as fast, of the same rates: an arm, not a machine
};

struct ExcitationOptions {
  Script script = Script::standard;
  double duration = 0.0;           ///< [s]; 0: the script's own; else all but the rests are stretched or squeezed to it
  double rest = 4.0;               ///< [s] of stillness first
  double turn_rate = 0.8;          ///< [rad/s] largest rate of a turning joint
  double slide_rate = 0.5;         ///< [m/s] largest rate of a sliding joint
  double turn_acceleration = 2.2;  ///< [rad/s²] largest of a turning joint
  double slide_acceleration = 2.0;  ///< [m/s²] largest of a sliding joint
  double together = 0.6;            ///< of these while all joints move: the rates of an arm's joints add up
  Angle rocking = Angle::deg(1.5);  ///< largest roll and pitch of a rocking base
  Angle yawing = Angle::deg(15);    ///< largest yaw of a yawing base
  double heave = 0.02;              ///< [m] of a rocking base
};

/// The joints' movements, drawn at random. An error where the duration leaves less than 1 s for a movement.
Result<Drive> make_drive(const Machine& machine, const ExcitationOptions& options, Rng rng);

}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
// A machine in a real physics engine (MuJoCo): masses, joint torques, accelerometer, gyro and magnetometer sites.
#pragma once

#include <memory>
#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/simulate/excitation.hpp"
#include "kinfer/simulate/machine_motion.hpp"

namespace kinfer {

/// How the joints track their drive.
enum class Servo {
  stiff,  ///< computed torque: follows the drive to rounding
  soft    ///< a damped spring of 2.5 Hz on each joint: the others oscillate when one moves
};

class MujocoWorld {
 public:
  /// An invalid file is an error with MuJoCo's own message.
  static Result<MujocoWorld> load(const std::string& mjcf);
  ~MujocoWorld();
  MujocoWorld(MujocoWorld&&) noexcept;
  MujocoWorld& operator=(MujocoWorld&&) noexcept;

  /// Joints, segments and sensors as the engine compiled them.
  const Machine& machine() const;

  /// Forward dynamics with the engine's sensor signals. The machine settles before t = 0. The torque is recomputed in
  /// each stage of the integrator; held over a step, it would make the accelerometers disagree with the derivative of
  /// the gyros. An error if the simulation becomes unstable.
  Result<MachineMotion> drive(const Drive& drive, double sampling_rate, Servo servo) const;

  /// Inverse dynamics: the joints have exactly the positions, velocities and accelerations of the drive.
  MachineMotion prescribe(const Drive& drive, double sampling_rate) const;

 private:
  struct Engine;
  explicit MujocoWorld(std::unique_ptr<Engine> engine);
  std::unique_ptr<Engine> engine_;
};

}  // namespace kinfer

// A machine in a real physics engine (MuJoCo): masses, joint torques, accelerometer, gyro and magnetometer sites.
#pragma once

#include <memory>
#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/simulate/excitation.hpp"
#include "kinfer/simulate/machine_motion.hpp"

namespace kinfer {

/// How the joints are held to their drive.
enum class Servo {
  stiff,  ///< computed torque: the drive is followed to rounding
  soft    ///< a damped spring of 2.5 Hz on each joint: others sway when one moves
};

class MujocoWorld {
 public:
  /// The engine's own words where it does not understand the file.
  static Result<MujocoWorld> load(const std::string& mjcf);
  ~MujocoWorld();
  MujocoWorld(MujocoWorld&&) noexcept;
  MujocoWorld& operator=(MujocoWorld&&) noexcept;

  /// Joints, segments and sensors as the engine compiled them.
  const Machine& machine() const;

  /// Forward dynamics: torques move masses, the sensors say what they say. The machine settles before t = 0. The torque
  /// is computed anew in each stage of the integrator; held over a step, it would make the accelerometers disagree with
  /// the derivative of the gyros. An error where the machine gets out of control.
  Result<MachineMotion> drive(const Drive& drive, double sampling_rate, Servo servo) const;

  /// Inverse dynamics: the joints are put where the drive wants them, with its rates and accelerations.
  MachineMotion prescribe(const Drive& drive, double sampling_rate) const;

 private:
  struct Engine;
  explicit MujocoWorld(std::unique_ptr<Engine> engine);
  std::unique_ptr<Engine> engine_;
};

}  // namespace kinfer

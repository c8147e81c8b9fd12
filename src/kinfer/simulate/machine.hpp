// The simulated machines: MJCF files of the project, with their sensors' mountings and the base that they stand on.
#pragma once

#include <string>
#include <vector>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/result.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer {

/// An INS stuck on a segment.
struct MountedSensor {
  std::string name;     ///< "ins0" is the platform's
  std::string segment;  ///< "house"
  int joint = 0;        ///< index into Machine::chain.joints: the frame that carries it
  int parent = -1;      ///< index into Machine::sensors of the sensor nearer the root; -1: the root
  Pose segment_T_sensor;
};

/// What the simulation knows about a machine: the truth that identification looks for.
struct Machine {
  Chain chain;                         ///< UrdfLinks; the first joints, up to the root sensor's, are the base
  std::vector<MountedSensor> sensors;  ///< parents before children
  int base_readings = 0;               ///< so many leading readings move the platform, not the machine
  VectorXd home;                       ///< readings at rest [rad] or [m]
};

enum class Mounting {
  as_built,  ///< as the machine's file has them: the paper's for the excavator
  arbitrary  ///< any orientation, shifted by the file's mounting_spread; joints a little off where they should be
};

enum class Base {
  still,
  rocking,  ///< rolls, pitches and heaves
  yawing    ///< rocks, and turns about the vertical on its tracks
};

struct MachineOptions {
  Mounting mounting = Mounting::as_built;
  Base base = Base::still;
  Angle slope{};                        ///< of the ground, towards a direction drawn from the seed
  Angle joint_error = Angle::deg(0.5);  ///< sd of the joint axes' directions, for Mounting::arbitrary
  double joint_shift = 0.01;            ///< [m] sd of the joints' places, for Mounting::arbitrary
};

/// "excavator", "excavator-general", "crane", "robot6", "tree".
std::vector<std::string> machine_names();

/// The machine's MJCF with sensors mounted and base placed. An unknown name is an error that lists the known ones.
/// "excavator-general" is the excavator with Mounting::arbitrary.
Result<std::string> machine_mjcf(const std::string& name, const MachineOptions& options, Rng rng);

}  // namespace kinfer

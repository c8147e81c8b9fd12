// SPDX-License-Identifier: Apache-2.0
// The simulated machines: MJCF files of the project, with sensor mountings and a fixed or moving base.
#pragma once

#include <string>
#include <vector>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/result.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer {

/// An INS mounted on a segment.
struct MountedSensor {
  std::string name;     ///< "ins0" is the platform's
  std::string segment;  ///< "house"
  int joint = 0;        ///< index into Machine::chain.joints: the frame that carries it
  int parent = -1;      ///< index into Machine::sensors of the sensor nearer the root; -1: the root
  Pose segment_T_sensor;
};

/// Ground truth of a simulated machine.
struct Machine {
  Chain chain;                         ///< UrdfLinks; the first joints, up to the root sensor's, are the base
  std::vector<MountedSensor> sensors;  ///< parents before children
  int base_dof = 0;                    ///< number of leading joint positions that move the platform
  VectorXd home;                       ///< joint positions at rest [rad] or [m]
};

enum class Mounting {
  as_built,  ///< as in the machine's file: those of the paper for the excavator
  arbitrary  ///< random orientation, shifted by the file's mounting_spread; joints slightly misplaced
};

enum class Base {
  still,
  rocking,  ///< rolls, pitches and heaves
  yawing    ///< rocks, and rotates about the vertical on its tracks
};

struct MachineOptions {
  Mounting mounting = Mounting::as_built;
  Base base = Base::still;
  Angle slope{};                        ///< of the terrain, in a direction drawn from the seed
  Angle joint_error = Angle::deg(0.5);  ///< sd of the joint axes' directions, for Mounting::arbitrary
  double joint_shift = 0.01;            ///< [m] sd of the joints' places, for Mounting::arbitrary
};

/// "excavator", "excavator-general", "crane", "robot6", "tree".
std::vector<std::string> machine_names();

/// The machine's MJCF with sensors, mountings and base. An unknown name is an error that lists the known ones.
/// "excavator-general" is the excavator with Mounting::arbitrary.
Result<std::string> machine_mjcf(const std::string& name, const MachineOptions& options, Rng rng);

}  // namespace kinfer

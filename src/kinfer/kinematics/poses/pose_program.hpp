// SPDX-License-Identifier: Apache-2.0
// A chain compiled to a list of steps from the world to the tool: constants folded, their sines computed once.
#pragma once

#include <vector>

#include "kinfer/kinematics/elementary_motions.hpp"

namespace kinfer::program {

/// Factor of a recorded screw: the joint position for a gain, the torque for a compliance, the sine or cosine of
/// a harmonic, the position of the other joint for a coupling.
enum class Scale { one, joint_position, torque, measured_torque, approach, sine, cosine, coupled };

struct Step {
  enum class Kind {
    rotate,           ///< about `axis`, by cosine a and sine b
    translate,        ///< along `axis`, by a
    transform,        ///< by constants[index]
    revolute_joint,   ///< about `axis`, by a + the displacement of joint `index`
    prismatic_joint,  ///< along `axis`, by a + the displacement of joint `index`
    record,           ///< column `index`: `axis` and origin here, times `scale` of joint `source`
    flange,           ///< the joints end here
  };
  Kind kind = Kind::rotate;
  int axis = 0;
  int index = 0;
  double a = 0.0, b = 0.0;
  Scale scale = Scale::one;
  int source = 0;
  int term = 0;                                              ///< which of the joint's couplings or harmonics
  elementary::Motion motion = elementary::Motion::rotation;  ///< of the recorded screw
};

/// One column of the derivative: the address of its parameter, and its index.
struct Column {
  ParameterAddress at;
  int index = 0;
};

struct StepList {
  std::vector<Step> steps;
  std::vector<Pose> constants;
};

/// Steps from the world to the tool. Each of `columns` that lies on the path to the tip is recorded where it acts.
StepList compile(const Chain& chain, const std::vector<Column>& columns);

}  // namespace kinfer::program

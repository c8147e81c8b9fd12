// A chain as a list of steps that a pose walks through from the world to the tool: constants folded, sines taken once.
#pragma once

#include <vector>

#include "kinfer/kinematics/elementary.hpp"

namespace kinfer::program {

/// What a recorded screw is multiplied by: a gain's screw by the reading, a compliance's by the torque, a harmonic's by
/// the sine or cosine of `a` times the reading, a coupling's by the reading that it follows.
enum class Scale { one, reading, torque, measured_torque, approach, sine, cosine, coupled };

struct Step {
  enum class Kind {
    turn,         ///< about `axis`, by cosine a and sine b
    shift,        ///< along `axis`, by a
    transform,    ///< by constants[index]
    turn_joint,   ///< about `axis`, by a + the movement of joint `index`
    shift_joint,  ///< along `axis`, by a + the movement of joint `index`
    record,       ///< column `index`: `axis` and origin here, times `scale` of joint `source`
    flange,       ///< the joints end here
  };
  Kind kind = Kind::turn;
  int axis = 0;
  int index = 0;
  double a = 0.0, b = 0.0;
  Scale scale = Scale::one;
  int source = 0;
  int term = 0;                                          ///< coupled: which of the joint's couplings
  elementary::Motion motion = elementary::Motion::turn;  ///< of what is recorded
};

/// One column of the derivative: whose number it is, and where it goes.
struct Column {
  Address at;
  int index = 0;
};

struct StepList {
  std::vector<Step> steps;
  std::vector<Pose> constants;
};

/// Steps from the world to the tool. Each of `columns` that lies on the way to the tip is recorded where it acts.
StepList compile(const Chain& chain, const std::vector<Column>& columns);

}  // namespace kinfer::program

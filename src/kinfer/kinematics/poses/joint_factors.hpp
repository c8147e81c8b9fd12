// SPDX-License-Identifier: Apache-2.0
// A joint's elementary motions with the constant ones multiplied once: before and after the one that moves.
#pragma once

#include <optional>

#include "kinfer/kinematics/elementary_motions.hpp"

namespace kinfer {

struct JointFactors {
  Pose before, after;
  std::optional<elementary::Factor> moving{};  ///< none of a fixed joint

  explicit JointFactors(const Joint& joint) { elementary::for_each_factor(joint, *this); }

  void operator()(const Mat3& rotation) { constant().rotation *= rotation; }
  void operator()(const elementary::Factor& factor) {
    if (factor.moves)
      moving = factor;
    else
      elementary::apply(constant(), factor.motion, factor.axis, factor.value);
  }

 private:
  Pose& constant() { return moving ? after : before; }
};

}  // namespace kinfer

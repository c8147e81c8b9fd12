// SPDX-License-Identifier: Apache-2.0
// Poses of any chain at many rows, one row per lane: interface of that kernel, in plain structs like the others'.
//
// An item holds the numbers of one row: joint positions and whatever else moves or loads the joints. Each joint's
// displacement is a sum of such numbers, each by a factor, and of harmonics of one of them.
#pragma once

#include <cstddef>
#include <cstdint>

namespace kinfer::batch {

/// A step of the walk from the world to the tool.
struct PoseStep {
  enum class Kind : std::uint8_t {
    rotate,           ///< about `axis`, by cosine a and sine b
    translate,        ///< along `axis`, by a
    transform,        ///< by constant `index`
    revolute_joint,   ///< about `axis`, by a + the displacement of joint `index`
    prismatic_joint,  ///< along `axis`, by a + the displacement of joint `index`
    record_rotation,  ///< column `index`: a rotation about `axis`, times the number `scale`
    record_translation,
    flange,  ///< the joints end here
  };
  Kind kind = Kind::rotate;
  int axis = 0;
  int index = 0;
  double a = 0.0, b = 0.0;
  int scale = -1;  ///< number of an item that a recorded column is multiplied by; −1: none
};

/// What a column does beside its screw when the lengths of the robot grow with temperature.
enum class Stretch : std::uint8_t {
  none,
  joint,            ///< lies within the lengths that grow
  tool,             ///< moves with the flange
  is_the_expansion  ///< the coefficient of expansion itself
};

struct PoseColumn {
  bool rotates = false, acts = false;  ///< acts: a step records it
  Stretch stretch = Stretch::none;
};

/// factor · number of an item.
struct DisplacementTerm {
  double factor = 0.0;
  int number = 0;
};

/// Displacement of a joint: terms first .. end − 1, and Σ sine_k sin(k q) + cosine_k cos(k q), q the number `angle`.
struct JointDisplacement {
  int first = 0, end = 0;
  int harmonics = 0;  ///< orders 0, 1, …, harmonics − 1
  const double *sines = nullptr, *cosines = nullptr;
  int angle = 0;
};

/// Sine and cosine of order · (number `angle`), written to the numbers `slot` and `slot` + 1.
struct Wave {
  double order = 1.0;
  int angle = 0, slot = 0;
};

/// A joint of the undeflected chain, for the torques of gravity. Constant transforms are rows of 3 x 4.
struct LoadedJoint {
  int parent = -1;
  double before[12] = {}, after[12] = {};
  enum class Move : std::uint8_t { none, rotation, translation } move = Move::none;
  int axis = 2;
  double offset = 0.0;
  int first = 0, end = 0;  ///< terms of its displacement without loads
};
struct CarriedMass {
  int joint = 0;
  double at[3] = {};
  double mass = 0.0;
  int number = -1;  ///< number of an item that is the mass; −1: `mass`
};
struct GravityPlan {
  const LoadedJoint* joints = nullptr;
  int joint_count = 0;  ///< 0: the torques are given
  const CarriedMass* masses = nullptr;
  int mass_count = 0;
  double base[12] = {}, gravity[3] = {};  ///< [m/s²] in the world
  int torques = 0;                        ///< first of the numbers that they are written to, one per joint
};

struct PoseJob {
  const PoseStep* steps = nullptr;
  int step_count = 0;
  const double* constants = nullptr;  ///< 3 x 4, row by row, each
  const DisplacementTerm* terms = nullptr;
  const JointDisplacement* joints = nullptr;
  const Wave* waves = nullptr;
  int wave_count = 0;
  GravityPlan gravity;
  double* items = nullptr;  ///< block by block, number by number, lane by lane
  int stride = 0;           ///< numbers of an item
  int blocks = 0;
  double expansion = 0.0, base[3] = {};
  int rise = -1;  ///< number that is the rise of temperature; −1: lengths are constant
  const PoseColumn* columns = nullptr;
  int column_count = 0;
  double* poses = nullptr;      ///< rotation column by column, then position: 12 x lanes a block
  double* twists = nullptr;     ///< 6 x columns x lanes a block, each column at the tool; null: poses only
  double* workspace = nullptr;  ///< pose_workspace(gravity.joint_count, lanes) doubles
};

/// Placements of the joints and what they carry.
[[gnu::always_inline]] constexpr std::size_t pose_workspace(int loaded_joints, int lanes) {
  return static_cast<std::size_t>(22 * loaded_joints * lanes);
}

}  // namespace kinfer::batch

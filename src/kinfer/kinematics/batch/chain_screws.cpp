// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "kinfer/kinematics/batch/chain_segments.hpp"

namespace kinfer::batch {
namespace {

using elementary::Motion;

/// Merges a rotation and a translation along the same axis that follow each other into one screw, which moves with one
/// joint at most.
struct ScrewWriter {
  ScrewPlan& plan;
  const std::vector<JointMotion>& joint_motions;
  std::vector<char> is_idle;                 // of each parameter: no screw writes its column
  bool has_turn = false, has_shift = false;  // of the last screw
  bool is_open = false;

  void rotate(const Mat3& rotation) {
    Screw screw{.is_rotation = true};
    for (int i = 0; i < 9; ++i) screw.rotation[i] = rotation(i / 3, i % 3);
    plan.screws.push_back(screw);
    is_open = false;
  }

  void move(const elementary::Factor& factor, const Value& value, int joint) {
    if (value.parameter < 0 && value.constant == 0.0 && !factor.moves) return;
    const bool turns = factor.motion == Motion::rotation;
    Screw& screw = screw_about(factor, turns);
    (turns ? screw.angle : screw.length) = value;
    (turns ? has_turn : has_shift) = true;
    written(value);
    if (!factor.moves) return;
    const JointMotion& joint_motion = *std::find_if(joint_motions.begin(), joint_motions.end(),
                                                    [&](const JointMotion& m) { return m.joint == joint; });
    screw.move = joint_motion.move, screw.gain = joint_motion.gain, screw.slot = joint_motion.slot;
    written(joint_motion.gain);
  }

 private:
  Screw& screw_about(const elementary::Factor& factor, bool turns) {
    const bool fits = is_open && plan.screws.back().axis == factor.axis && !(turns ? has_turn : has_shift) &&
                      !(factor.moves && plan.screws.back().move != MotionKind::none);
    if (!fits) {
      plan.screws.push_back({.axis = factor.axis});
      has_turn = has_shift = false, is_open = true;
    }
    return plan.screws.back();
  }
  void written(const Value& value) {
    if (value.parameter >= 0) is_idle[value.parameter] = false;
  }
};

}  // namespace

ScrewPlan screws_of(const Chain& nominal, const ParameterSet& set, const ParameterLookup& lookup,
                    const std::vector<JointMotion>& joint_motions) {
  ScrewPlan plan;
  ScrewWriter writer{plan, joint_motions, std::vector<char>(set.free_count(), true)};
  walk(nominal.base, SetupFrame::base, lookup, writer);
  walk_joints_and_tool(nominal, lookup, writer);
  for (std::size_t k = 0; k < writer.is_idle.size(); ++k)
    if (writer.is_idle[k]) plan.idle.push_back(static_cast<int>(k));
  return plan;
}

}  // namespace kinfer::batch

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/batch/chain_plan.hpp"

#include <algorithm>

#include "kinfer/base/expect.hpp"
#include "kinfer/kinematics/batch/chain_segments.hpp"
#include "kinfer/kinematics/batch/parameter_lookup.hpp"

namespace kinfer {
namespace {

bool is_geometry_or_gain(const ParameterAddress& at) {
  return batch::place_in_chain(at) && field_of(at) <= Field::gain;
}

}  // namespace

bool has_batch_form(const Chain& chain, const ParameterSet& set) {
  const auto free = set.free();
  return !has_non_geometric_terms(chain) && chain.mountings.empty() &&
         std::all_of(free.begin(), free.end(), [](const Parameter* p) { return is_geometry_or_gain(p->at); });
}

namespace batch {
namespace {

using elementary::Motion;

std::vector<JointMotion> joint_motions_of(const Chain& chain, const ParameterLookup& lookup) {
  const std::vector<int> q_index = active_joint_indices(chain);
  std::vector<JointMotion> list;
  for (const int j : path_to(chain, chain.tip_joint())) {
    const Joint& joint = chain.joints[j];
    if (!has_position(joint.type)) continue;
    const bool turns = rotates(joint.type);
    JointMotion joint_motion{.joint = j,
                             .move = turns ? MotionKind::revolute : MotionKind::prismatic,
                             .gain = lookup.value(2 + j, Field::gain, joint.gain, Motion::translation),
                             .q_index = q_index[j]};
    for (const Coupling& c : joint.couplings) joint_motion.couplings.push_back({q_index[c.joint], c.factor});
    KINFER_EXPECT(joint_motion.gain.parameter < 0 || joint_motion.q_index >= 0,
                  "gain of joint {}, which has no joint position", j);
    if (joint_motion.gain.parameter >= 0)
      joint_motion.move = turns ? MotionKind::revolute_with_gain : MotionKind::prismatic_with_gain;
    list.push_back(std::move(joint_motion));
  }
  int slot = 0;
  for (auto motion = list.rbegin(); motion != list.rend(); ++motion) motion->slot = slot, slot += motion->slots();
  return list;
}

}  // namespace

int slots_of(const std::vector<JointMotion>& joint_motions) {
  return joint_motions.empty() ? 0 : joint_motions.front().slot + joint_motions.front().slots();
}

MatrixXd items_of(const std::vector<JointMotion>& joint_motions, const PointTable& points, const Pose& measured_from,
                  const Kernels& kernels) {
  const int slots = slots_of(joint_motions);
  MatrixXd items = MatrixXd::Zero(points.measured.cols(), slots + 3);
  VectorXd displacement(items.rows());
  for (const JointMotion& m : joint_motions) {
    displacement.setZero();
    if (m.q_index >= 0) displacement = m.gain.constant * points.joints.row(m.q_index);
    for (const Coupling& c : m.couplings) displacement += c.factor * points.joints.row(c.joint);
    if (m.move == MotionKind::revolute || m.move == MotionKind::revolute_with_gain) {
      kernels.sines(displacement.data(), static_cast<int>(displacement.size()), items.col(m.slot).data(),
                    items.col(m.slot + 1).data());
    } else {
      items.col(m.slot) = displacement;
    }
    if (m.slots() > 2) items.col(m.slot + 2) = points.joints.row(m.q_index);
  }
  const Mat3 rotated = measured_from.rotation.transpose();
  items.rightCols<3>() = (rotated * (points.measured.colwise() - measured_from.position)).transpose();
  return items;
}

std::vector<PointsAtTarget> points_by_target(const Chain& chain, const PointTable& points) {
  std::vector<PointsAtTarget> list(chain.targets.size() + 1);
  for (int i = 0; i < points.measured.cols(); ++i) {
    const int target = points.target.empty() ? -1 : points.target[i];
    list[target + 1].target = target;
    list[target + 1].points.push_back(i);
  }
  std::erase_if(list, [](const PointsAtTarget& at) { return at.points.empty(); });
  return list;
}

ChainPlan plan_of(const Chain& nominal, const ParameterSet& set, BaseSide side) {
  const ParameterLookup lookup(set);
  ChainPlan plan{.joint_motions = joint_motions_of(nominal, lookup), .list = {}, .screws = {}};
  plan.list = segments_of(nominal, set, lookup, plan.joint_motions, side);
  if (side == BaseSide::chain) plan.screws = screws_of(nominal, set, lookup, plan.joint_motions);
  return plan;
}

Group group_at(const SegmentList& list, const Chain& nominal, int target) {
  Group group;
  const Vec3 on_tool = target < 0 ? Vec3::Zero().eval() : nominal.targets[target].xyz;
  for (int row = 0; row < 3; ++row) group.on_tool[row] = on_tool[row];
  if (list.segments.size() < 2) return group;
  const MotionKind last = list.segments[list.segments.size() - 2].move;
  const bool turns = last == MotionKind::revolute || last == MotionKind::revolute_with_gain;
  const auto is_along_axis = [](const Factor& f) { return f.kind != Factor::Kind::constant_rotation && f.axis == 2; };
  group.on_last_axis = turns && on_tool.x() == 0.0 && on_tool.y() == 0.0 &&
                       std::all_of(list.factors.back().begin(), list.factors.back().end(), is_along_axis);
  return group;
}

}  // namespace batch
}  // namespace kinfer

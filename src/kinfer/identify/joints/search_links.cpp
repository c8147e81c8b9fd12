// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/joints/search_links.hpp"

#include <algorithm>

#include "kinfer/identify/joints/pair_joint.hpp"
#include "kinfer/identify/joints/searched_joint.hpp"
#include "kinfer/identify/joints/thresholds.hpp"

namespace kinfer::identify {
namespace {

Observer with_detail(const Observer& observer, const std::string& detail) {
  return [&observer, detail](Progress progress) {
    progress.detail = detail;
    return notify(observer, progress);
  };
}

Result<JointResult> find_joint(const OrderedMotion& ordered, std::size_t child, const JointTypeEvidence& evidence,
                               const std::vector<FrameState>& chain_states, const LinkSearchOptions& options,
                               const Rng& rng, const Observer& observer) {
  const RecordedMotion& motion = ordered.motion;
  const std::size_t parent = *ordered.tree.parent[child];
  if (evidence.type == EstimatedJointType::prismatic) return prismatic_joint(motion, parent, child, evidence);
  const JointVariableKind terminals = terminals_of(options.engine);
  const auto signals =
      find_joint_signals(motion, parent, child, {.terminals = terminals, .smoothing = options.smoothing});
  if (evidence.type == EstimatedJointType::rigid) return rigid_joint(motion, parent, child);
  if (evidence.type != EstimatedJointType::revolute || signals.empty())
    return joint_about_point(motion, ordered.tree, parent, child, evidence);
  const std::string& name = motion.segments[child].name;
  const auto rows = informative_rows(motion, parent, child, terminals);
  if (rows.size() < min_informative_rows) return joint_about_point(motion, ordered.tree, parent, child, evidence);
  return search_joint({motion.segments[parent], motion.segments[child], signals, rows}, chain_states, options.engine,
                      options.threads, rng, with_detail(observer, name));
}

}  // namespace

Result<std::vector<JointResult>> search_links(const OrderedMotion& ordered, const std::vector<JointTypeEvidence>& types,
                                              const LinkSearchOptions& options, const Rng& rng,
                                              const Observer& observer) {
  const SegmentTree& tree = ordered.tree;
  const std::size_t links = options.links > 0 ? static_cast<std::size_t>(options.links) : tree.order.size();
  std::vector<std::vector<FrameState>> states(ordered.motion.segments.size());  // empty where not reached yet
  states[tree.root] = measured_states(ordered.motion.segments[tree.root]);
  std::vector<JointResult> joints;
  for (std::size_t i = 1; i < tree.order.size() && i <= links; ++i) {
    const std::size_t child = tree.order[i];
    KINFER_TRY(joint,
               find_joint(ordered, child, types[i - 1], states[*tree.parent[child]], options, rng.stream(i), observer));
    joint.joint.type_probabilities = types[i - 1].probabilities;
    states[child] = std::move(joint.states);
    joints.push_back(std::move(joint));
  }
  return joints;
}

}  // namespace kinfer::identify

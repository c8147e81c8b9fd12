// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/loops/loop_estimate.hpp"

#include <set>

namespace kinfer::identify {

std::vector<LoopEstimate> loop_estimates(const std::vector<FoundLoop>& loops, const InsBodies& bodies,
                                         std::vector<JointEstimate> joints, const std::vector<std::string>& names) {
  std::vector<LoopEstimate> estimates;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const FoundLoop& loop = loops[i];
    std::set<int> sensors;
    for (const std::size_t body : loop.joints)
      for (const int sensor : {bodies[body].sensor, bodies[static_cast<std::size_t>(bodies[body].parent)].sensor})
        if (sensor >= 0) sensors.insert(sensor);
    LoopEstimate estimate{.joint = std::move(joints[i])};
    estimate.joint.parent = names[static_cast<std::size_t>(bodies[loop.first].sensor)];
    estimate.joint.child = names[static_cast<std::size_t>(bodies[loop.second].sensor)];
    for (const int sensor : sensors) estimate.segments.push_back(names[static_cast<std::size_t>(sensor)]);
    estimate.gap = loop.evidence.closing.gap;
    estimate.misalignment = loop.evidence.closing.misalignment;
    estimate.mirrored_gap = loop.evidence.mirrored.gap;
    estimate.log_odds = loop.log_odds;
    estimates.push_back(std::move(estimate));
  }
  return estimates;
}

std::vector<Finding> loop_findings(const std::vector<LoopEstimate>& loops) {
  std::vector<Finding> findings;
  for (const LoopEstimate& loop : loops)
    findings.push_back({.kind = FindingKind::loop,
                        .severity = Severity::note,
                        .values = {{"segments", loop.segments},
                                   {"first", loop.joint.parent},
                                   {"second", loop.joint.child},
                                   {"gap", loop.gap},
                                   {"mirrored_gap", loop.mirrored_gap},
                                   {"log_odds", loop.log_odds}},
                        .applied = true});
  return findings;
}

}  // namespace kinfer::identify

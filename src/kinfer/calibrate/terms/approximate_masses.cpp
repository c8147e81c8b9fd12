// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/approximate_masses.hpp"

#include <algorithm>

#include "kinfer/calibrate/terms/thresholds.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer::calibrate {

Chain with_approximate_masses(Chain chain) {
  const std::vector<Pose> frames = joint_frames(chain, VectorXd::Zero(dof(chain)));
  for (std::size_t j = 0; j < chain.joints.size(); ++j) {
    // The link after joint j ends at the next joint's frame; for a DH row it ends at the row's own frame.
    const bool ends_here = std::holds_alternative<DhLink>(chain.joints[j].link);
    std::size_t child = j;
    while (++child < chain.joints.size() && chain.joints[child].parent != static_cast<int>(j)) {
    }
    const Pose& frame = frames[j];
    Vec3 far = Vec3::Zero();
    if (ends_here)
      far =
          frame.inverse() * (chain.joints[j].parent >= 0 ? frames[chain.joints[j].parent] : chain.base.pose()).position;
    else if (child < chain.joints.size())
      far = frame.inverse() * frames[child].position;
    chain.masses.push_back(
        {static_cast<int>(j), 0.5 * far, std::max(thresholds::min_link_mass, thresholds::mass_per_metre * far.norm())});
  }
  if (chain.tip_joint() >= 0) chain.masses.push_back({chain.tip_joint(), chain.tool.xyz, thresholds::tool_mass});
  return chain;
}

}  // namespace kinfer::calibrate

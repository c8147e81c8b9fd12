// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/poses/joint_excitation.hpp"

#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
std::vector<JointExcitation> measure_joint_excitation(const Chain& chain, const PoseSet& set) {
  std::vector<JointExcitation> joints;
  if (set.rows() == 0) return joints;
  const std::vector<int> moving = active_joints(chain);
  for (std::size_t k = 0; k < moving.size(); ++k) {
    const auto values = set.joints.row(static_cast<Eigen::Index>(k));
    const std::vector<double> list(values.begin(), values.end());
    const std::string& name = k < set.joint_names.size() ? set.joint_names[k] : chain.joints[moving[k]].name;
    joints.push_back(
        {name, rotates(chain.joints[moving[k]].type), values.minCoeff(), values.maxCoeff(), standard_deviation(list)});
  }
  return joints;
}

}  // namespace kinfer

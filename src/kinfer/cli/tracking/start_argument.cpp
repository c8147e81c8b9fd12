// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/tracking/start_argument.hpp"

#include "kinfer/base/angle.hpp"
#include "kinfer/cli/options/posture_argument.hpp"

namespace kinfer::cli {

Result<VectorXd> parse_start(const std::string& text, const Chain& chain) {
  KINFER_TRY(start, parse_posture("--start", text, chain, UnknownPosition::allowed));
  const std::vector<int> joints = active_joints(chain);
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const Joint& joint = chain.joints[static_cast<std::size_t>(joints[k])];
    const double q = start[static_cast<Eigen::Index>(k)], unit = rotates(joint.type) ? degree : 1e-3;
    if (q < joint.lower || q > joint.upper)
      return error("--start: {} is {:.6g} {}, outside its limits {:.6g} to {:.6g}", joint.name, q / unit,
                   rotates(joint.type) ? "deg" : "mm", joint.lower / unit, joint.upper / unit);
  }
  return start;
}

}  // namespace kinfer::cli

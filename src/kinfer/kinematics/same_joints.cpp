// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/same_joints.hpp"

namespace kinfer {

bool have_same_joints(const Chain& a, const Chain& b) {
  if (a.joints.size() != b.joints.size()) return false;
  for (std::size_t j = 0; j < a.joints.size(); ++j)
    if (a.joints[j].type != b.joints[j].type || a.joints[j].link.index() != b.joints[j].link.index()) return false;
  return true;
}

}  // namespace kinfer

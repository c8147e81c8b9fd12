// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/chain.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

constexpr double unit_length_slack = 1e-9;  // axes read from a file and normalised are within this

bool is_active(const Joint& joint) {
  return joint.is_active && has_position(joint.type);
}

}  // namespace

std::vector<int> active_joints(const Chain& chain) {
  std::vector<int> joints;
  for (int j = 0; j < static_cast<int>(chain.joints.size()); ++j) {
    if (is_active(chain.joints[j])) joints.push_back(j);
  }
  return joints;
}

int dof(const Chain& chain) {
  return static_cast<int>(std::count_if(chain.joints.begin(), chain.joints.end(), is_active));
}

Chain with_mounting(const Chain& chain, int index) {
  Chain result = chain;
  if (index < 0) return result;
  const RobotMounting& mounting = chain.mountings[index];
  if (mounting.base) result.base = *mounting.base;
  result.tool = mounting.tool;
  if (mounting.tip >= 0) result.tip = mounting.tip;
  return result;
}

std::vector<int> path_to(const Chain& chain, int tip) {
  std::vector<int> path;
  for (int j = tip; j >= 0; j = chain.joints[j].parent) path.push_back(j);
  std::reverse(path.begin(), path.end());
  return path;
}

std::vector<std::string> active_joint_names(const Chain& chain) {
  std::vector<std::string> names;
  for (const int j : active_joints(chain)) names.push_back(chain.joints[j].name);
  return names;
}

VectorXd JointLimits::clamped(const VectorXd& q) const {
  return q.cwiseMax(lower).cwiseMin(upper);
}

JointLimits joint_limits(const Chain& chain) {
  const std::vector<int> joints = active_joints(chain);
  JointLimits limits{VectorXd(joints.size()), VectorXd(joints.size())};
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    limits.lower[at] = chain.joints[joints[k]].lower;
    limits.upper[at] = chain.joints[joints[k]].upper;
  }
  return limits;
}

bool has_non_geometric_terms(const Joint& joint) {
  return joint.compliance != 0.0 || joint.torque_compliance != 0.0 || joint.backlash != 0.0 || !joint.harmonics.empty();
}

bool has_non_geometric_terms(const Chain& chain) {
  const auto of_joint = [](const Joint& joint) { return has_non_geometric_terms(joint); };
  return chain.expansion != 0.0 || !chain.field.empty() ||
         std::any_of(chain.joints.begin(), chain.joints.end(), of_joint);
}

void expect_well_formed(const Chain& chain) {
  const int n = static_cast<int>(chain.joints.size());
  KINFER_EXPECT(chain.tip >= -1 && chain.tip < n, "tip {} of {} joints", chain.tip, n);
  for (int j = 0; j < n; ++j) {
    const Joint& joint = chain.joints[j];
    KINFER_EXPECT(joint.parent >= -1 && joint.parent < j, "parent {} of joint {}", joint.parent, j);
    for (const Coupling& c : joint.couplings) {
      KINFER_EXPECT(c.joint >= 0 && c.joint < n && is_active(chain.joints[c.joint]), "joint {} coupled to {}", j,
                    c.joint);
    }
    if (const auto* link = std::get_if<UrdfLink>(&joint.link)) {
      KINFER_EXPECT(std::abs(link->axis.norm() - 1.0) < unit_length_slack, "axis of joint {} has length {}", j,
                    link->axis.norm());
    }
  }
  const DisplacementField& field = chain.field;
  KINFER_EXPECT(field.empty() || (field.points.rows() == dof(chain) && field.length.size() == field.points.rows() &&
                                  field.coefficients.cols() == field.points.cols()),
                "a field of {} joints, {} lengths and {} coefficients for {} points", field.points.rows(),
                field.length.size(), field.coefficients.cols(), field.points.cols());
  for (const RobotMounting& mounting : chain.mountings)
    KINFER_EXPECT(mounting.tip >= -1 && mounting.tip < n, "tip {} of {} joints", mounting.tip, n);
  for (const LoopClosure& closure : chain.closures)
    KINFER_EXPECT(std::min(closure.first, closure.second) >= -1 && std::max(closure.first, closure.second) < n,
                  "closure {} joins {} and {} of {} joints", closure.name, closure.first, closure.second, n);
  for (const PointMass& mass : chain.masses) {
    KINFER_EXPECT(mass.joint >= 0 && mass.joint < n, "mass on joint {} of {}", mass.joint, n);
  }
}

Chain with_small_rotations_folded(Chain chain) {
  fold(chain.base);
  fold(chain.tool);
  for (Joint& joint : chain.joints) {
    if (auto* link = std::get_if<UrdfLink>(&joint.link)) fold(link->origin);
  }
  for (RobotMounting& mounting : chain.mountings) {
    if (mounting.base) fold(*mounting.base);
    fold(mounting.tool);
  }
  for_each_fixture_list(chain.fixtures, [](const auto&, auto& list) {
    for (auto& fixture : list) fold(fixture);
  });
  return chain;
}

}  // namespace kinfer

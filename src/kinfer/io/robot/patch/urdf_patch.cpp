// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/patch/urdf_patch.hpp"

#include <cmath>
#include <numbers>

#include "kinfer/io/robot/patch/urdf_joints.hpp"

namespace kinfer {
namespace {

constexpr double rounding = 1e-15;  // [m], [rad] a smaller change is none

class UrdfPatcher {
 public:
  explicit UrdfPatcher(std::string_view text) : edits_(text) {}

  void change(const UrdfJointPosition& joint, const CalibratedOrigin& calibrated) {
    const Pose before = joint.pose(), after = calibrated.replacement(before);
    OriginChange change{.joint = joint.name,
                        .line = joint.line,
                        .translation = after.position - before.position,
                        .rotation_vector = log_so3(before.rotation.transpose() * after.rotation),
                        .offset = calibrated.offset,
                        .translates = calibrated.translates,
                        .inserted = !joint.origin};
    const bool moved = change.translation.cwiseAbs().maxCoeff() > rounding;
    const bool turned = change.rotation_vector.cwiseAbs().maxCoeff() > rounding;
    if (!moved && !turned && change.offset == 0.0) return;
    const Vec3 rpy = rpy_near(after.rotation, joint.rpy);
    if (joint.origin) {
      if (moved) edits_.set_attribute(*joint.origin, "xyz", plain_list(after.position));
      if (turned) edits_.set_attribute(*joint.origin, "rpy", plain_list(rpy));
    } else if (moved || turned) {
      edits_.insert_before(joint.first_child, "origin",
                           {{"xyz", plain_list(after.position)}, {"rpy", plain_list(rpy)}});
    }
    changes_.push_back(std::move(change));
  }

  PatchedText finish() { return {.text = edits_.apply(), .changes = std::move(changes_)}; }

 private:
  XmlEdits edits_;
  std::vector<OriginChange> changes_;
};

}  // namespace

Vec3 rpy_near(const Mat3& rotation, const Vec3& like) {
  using std::numbers::pi;
  const Vec3 first = to_rpy(rotation), second(first.x() + pi, pi - first.y(), first.z() + pi);
  const auto unwound = [&](Vec3 angles) {
    for (int k = 0; k < 3; ++k) angles[k] -= 2.0 * pi * std::round((angles[k] - like[k]) / (2.0 * pi));
    return angles;
  };
  const Vec3 a = unwound(first), b = unwound(second);
  return (a - like).norm() <= (b - like).norm() ? a : b;
}

Result<PatchedText> patch_urdf(std::string_view text, const std::string& name,
                               const std::vector<CalibratedOrigin>& origins) {
  KINFER_TRY(joints, locate_urdf_joints(text, name));
  UrdfPatcher patcher(text);
  for (const UrdfJointPosition& joint : joints.joints)
    for (const CalibratedOrigin& origin : origins)
      if (origin.joint == joint.name) patcher.change(joint, origin);
  return patcher.finish();
}

}  // namespace kinfer

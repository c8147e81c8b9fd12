// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/patch/calibrated_origins.hpp"

#include "kinfer/io/robot/model/possible_chain.hpp"

namespace kinfer {
namespace {

constexpr double same_origin = 1e-15;  // [m], [1] differences of rounding only
constexpr double same_axis = 1e-9;     // [1] an axis that was written and read again is within this

/// Motion of a joint about or along its axis.
Pose motion_of(const Joint& joint, double amount) {
  const Vec3& axis = std::get<UrdfLink>(joint.link).axis;
  if (translates(joint.type)) return {Mat3::Identity(), amount * axis};
  return {exp_so3(amount * axis), Vec3::Zero()};
}

/// The same machine: URDF joints of the same names, parents, types and axes.
Result<void> expect_same_machine(const Chain& in_file, const Chain& corrected) {
  if (in_file.joints.size() != corrected.joints.size())
    return error("the calibrated chain has {} joints, the robot file {}", corrected.joints.size(),
                 in_file.joints.size());
  for (std::size_t j = 0; j < in_file.joints.size(); ++j) {
    const Joint &a = in_file.joints[j], &b = corrected.joints[j];
    const auto *before = std::get_if<UrdfLink>(&a.link), *after = std::get_if<UrdfLink>(&b.link);
    if (!before || !after || a.name != b.name || a.parent != b.parent || a.type != b.type)
      return error("joint {} of the calibrated chain, \"{}\", is not joint \"{}\" of the robot file", j + 1, b.name,
                   a.name);
    if (has_position(a.type) && (before->axis - after->axis).norm() > same_axis)
      return error("joint \"{}\": the calibrated chain has another axis than the robot file", a.name);
  }
  return {};
}

}  // namespace

Pose CalibratedOrigin::replacement(const Pose& in_file) const {
  const bool is_same = (in_file.position - before.position).cwiseAbs().maxCoeff() < same_origin &&
                       (in_file.rotation - before.rotation).cwiseAbs().maxCoeff() < same_origin;
  return is_same ? after : after * before.inverse() * in_file;
}

double zero_offset(const Joint& before, const Joint& after) {
  const auto &old_link = std::get<UrdfLink>(before.link), &new_link = std::get<UrdfLink>(after.link);
  const Pose change = old_link.origin.pose().inverse() * new_link.origin.pose();
  return old_link.axis.dot(translates(before.type) ? change.position : log_so3(change.rotation));
}

Result<std::vector<CalibratedOrigin>> calibrated_origins(const Chain& in_file, const Chain& corrected,
                                                         EncoderOffsets offsets) {
  if (auto same = expect_same_machine(in_file, corrected); !same) return forward_error(same.error());
  std::vector<double> offset(in_file.joints.size(), 0.0);  // of the joint positions
  if (offsets == EncoderOffsets::separate)
    for (const int j : active_joints(in_file)) offset[j] = zero_offset(in_file.joints[j], corrected.joints[j]);
  std::vector<CalibratedOrigin> origins;
  for (std::size_t j = 0; j < in_file.joints.size(); ++j) {
    const Joint &before = in_file.joints[j], &after = corrected.joints[j];
    if (!has_position(before.type)) continue;
    if (const auto what = impossible_number(after)) return error("joint \"{}\": {}", before.name, *what);
    double shift = before.is_active ? before.gain * offset[j] : 0.0;  // of the joint variable, by all offsets
    for (const Coupling& coupling : before.couplings) shift += coupling.factor * offset[coupling.joint];
    Pose origin = std::get<UrdfLink>(after.link).origin.pose();
    if (shift != 0.0) origin = origin * motion_of(before, -shift);
    origins.push_back(
        {before.name, translates(before.type), std::get<UrdfLink>(before.link).origin.pose(), origin, offset[j]});
  }
  return origins;
}

}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/handover/named_zero.hpp"

#include <fmt/ranges.h>

namespace kinfer::identify {
namespace {

std::size_t zero_count(EstimatedJointType type) {
  if (type == EstimatedJointType::rigid || type == EstimatedJointType::spherical) return 0;
  return type == EstimatedJointType::universal ? 2 : 1;
}

std::string position_name(const JointBodies& joint, std::size_t index, const std::vector<std::string>& names) {
  const std::string name = names[joint.parent] + "-" + names[joint.child];
  return zero_count(joint.type) == 1 ? name : fmt::format("{} {}", name, index + 1);
}

bool is_of(const NamedZero& zero, const JointBodies& joint, std::size_t index, const std::vector<std::string>& names) {
  return zero.joint == position_name(joint, index, names) ||
         (zero_count(joint.type) == 1 && zero.joint == names[joint.child]);
}

Result<void> check_zero(const NamedZero& zero, std::span<const JointBodies> joints,
                        const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const JointBodies& joint : joints)
    for (std::size_t i = 0; i < zero_count(joint.type); ++i) {
      known.push_back(position_name(joint, i, names));
      if (!is_of(zero, joint, i, names)) continue;
      const bool slides = joint.type == EstimatedJointType::prismatic;
      if (slides == (zero.motion == elementary::Motion::translation)) return {};
      return error("--zero {}: the joint {}, so its position is {}", zero.joint, slides ? "slides" : "rotates",
                   slides ? "a length (mm, m)" : "an angle (deg, rad)");
    }
  return error("--zero {}: no joint position of that name; the machine has {}", zero.joint, fmt::join(known, ", "));
}

}  // namespace

const NamedZero* named_zero(std::span<const NamedZero> zeros, const JointBodies& joint, std::size_t index,
                            const std::vector<std::string>& names) {
  for (const NamedZero& zero : zeros)
    if (index < zero_count(joint.type) && is_of(zero, joint, index, names)) return &zero;
  return nullptr;
}

Result<void> check_zeros(std::span<const NamedZero> zeros, std::span<const JointBodies> joints,
                         const std::vector<std::string>& names, const SplineGrid& grid) {
  for (const NamedZero& zero : zeros) {
    if (auto checked = check_zero(zero, joints, names); !checked) return checked;
    if (zero.at < grid.begin || zero.at > grid.end())
      return error("--zero {}: {} s is outside the recording, {:.3f} to {:.3f} s", zero.joint, zero.at, grid.begin,
                   grid.end());
  }
  return {};
}

}  // namespace kinfer::identify

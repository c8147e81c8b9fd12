// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/patch/urdf_patch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/io/robot/patch/urdf_joints.hpp"
#include "kinfer/io/robot/xml_list.hpp"

namespace kinfer {
namespace {

/// Adding zero turns -0 into 0, which is how people write it.
std::string plain_list(const Vec3& value) {
  return xml_list(Vec3(value + Vec3::Zero()));
}

constexpr double rounding = 1e-15;  // [m], [rad] a smaller change is none

/// Replaces `length` bytes from `at`.
struct Edit {
  std::size_t at = 0, length = 0;
  std::string text;
};

std::string quoted_attribute(const char* key, const Vec3& value, char quote) {
  return fmt::format("{}={}{}{}", key, quote, plain_list(value), quote);
}

/// The spaces before a position of the text, as far as they reach.
std::string_view space_before(std::string_view text, std::size_t at) {
  std::size_t begin = at;
  while (begin > 0 && std::string_view(" \t\r\n").find(text[begin - 1]) != std::string_view::npos) --begin;
  return text.substr(begin, at - begin);
}

class UrdfPatcher {
 public:
  explicit UrdfPatcher(std::string_view text) : text_(text) {}

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
      if (moved) set_attribute(*joint.origin, "xyz", after.position);
      if (turned) set_attribute(*joint.origin, "rpy", rpy);
    } else if (moved || turned) {
      insert_origin(joint.first_child, after.position, rpy);
    }
    changes_.push_back(std::move(change));
  }

  PatchedText finish() {
    std::ranges::stable_sort(edits_, {}, &Edit::at);
    PatchedText patched{.text = {}, .changes = std::move(changes_)};
    std::size_t at = 0;
    for (const Edit& edit : edits_) {
      patched.text.append(text_, at, edit.at - at).append(edit.text);
      at = edit.at + edit.length;
    }
    patched.text.append(text_, at);
    return patched;
  }

 private:
  void set_attribute(const XmlElementPosition& element, const char* key, const Vec3& value) {
    if (const XmlAttributePosition* place = element.attribute(key)) {
      edits_.push_back({place->begin, place->end - place->begin, plain_list(value)});
    } else if (element.attributes.empty()) {
      edits_.push_back({element.name_end, 0, " " + quoted_attribute(key, value, '"')});
    } else {  // after the last one, with the space that stands before it
      const XmlAttributePosition& last = element.attributes.back();
      edits_.push_back({last.end + 1, 0,
                        std::string(space_before(text_, last.name_begin)) + quoted_attribute(key, value, last.quote)});
    }
  }

  /// Before the first child, with that child's indentation, quotes and way to end an empty element.
  void insert_origin(const XmlElementPosition& neighbour, const Vec3& xyz, const Vec3& rpy) {
    const char quote = neighbour.attributes.empty() ? '"' : neighbour.attributes.front().quote;
    const bool spaced_end = neighbour.is_empty && !space_before(text_, neighbour.start_end - 2).empty();
    edits_.push_back(
        {neighbour.begin, 0,
         fmt::format("<origin {} {}{}/>{}", quoted_attribute("xyz", xyz, quote), quoted_attribute("rpy", rpy, quote),
                     spaced_end ? " " : "", space_before(text_, neighbour.begin))});
  }

  std::string_view text_;
  std::vector<Edit> edits_;
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

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/patch/mjcf_patch.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <cmath>

#include "kinfer/io/robot/mjcf/mjcf.hpp"

namespace kinfer {
namespace {

constexpr double no_change = 1e-13;     // [m], [rad] less is the rounding of products of poses
constexpr double rounded_zero = 1e-16;  // [m], [1]

double largest(const Vec3& v) {
  return v.cwiseAbs().maxCoeff();
}

/// Places of all elements, in the order of the text; none where text and tree disagree.
std::optional<std::vector<XmlElementPosition>> all_positions(std::string_view text) {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS || !document.RootElement()) return std::nullopt;
  auto positions = xml_positions(text);
  if (!positions) return std::nullopt;
  std::size_t next = 0;
  const auto agrees = [&](const auto& self, const tinyxml2::XMLElement& element) -> bool {
    if (next == positions->size() || !corresponds(text, (*positions)[next++], element)) return false;
    for (auto* child = element.FirstChildElement(); child; child = child->NextSiblingElement())
      if (!self(self, *child)) return false;
    return true;
  };
  if (!agrees(agrees, *document.RootElement()) || next != positions->size()) return std::nullopt;
  return positions;
}

class MjcfPatcher {
 public:
  MjcfPatcher(std::string_view text, const MjcfTree& tree, const std::vector<XmlElementPosition>& positions, int base,
              const std::vector<CalibratedOrigin>& origins)
      : tree_(tree), positions_(positions), base_(base), origins_(origins), edits_(text) {}

  PatchedText patch() {
    for (const MjcfBody& body : tree_.bodies) change(body);
    return {.text = edits_.apply(), .changes = std::move(changes_)};
  }

 private:
  const CalibratedOrigin* origin_of(int joint) const {
    const auto found = std::ranges::find(origins_, tree_.joints[joint].name, &CalibratedOrigin::joint);
    return found == origins_.end() ? nullptr : &*found;
  }

  bool is_calibrated(int joint) const {
    const CalibratedOrigin* origin = origin_of(joint);
    return origin && (std::abs(origin->offset) > no_change || change_of(joint).has_value());
  }

  /// What multiplies the origin of the joint from the left; none where it stays.
  std::optional<Pose> change_of(int joint) const {
    const CalibratedOrigin* origin = origin_of(joint);
    if (!origin) return std::nullopt;
    const Pose change = origin->after * origin->before.inverse();
    if (largest(change.position) < no_change && largest(log_so3(change.rotation)) < no_change) return std::nullopt;
    return change;
  }

  /// Poses of the joints' points with the axes of the body, all joints at their references, in the frame that the chain
  /// has above the body.
  std::vector<Pose> joint_poses(const MjcfBody& body) const {
    std::vector<Pose> poses;
    Pose above = mjcf_attachment(tree_, body.parent, base_) * body.pose();
    for (const int joint : body.joints) {
      const Vec3& at = tree_.joints[joint].position;
      const Pose change = change_of(joint).value_or(Pose{});
      const Pose own = poses.empty() ? above * Pose{Mat3::Identity(), at} : Pose{Mat3::Identity(), at + above.position};
      poses.push_back(poses.empty() ? change * own : poses.back() * (change * own));
      above = {Mat3::Identity(), -at};
    }
    return poses;
  }

  void change(const MjcfBody& body) {
    if (std::ranges::none_of(body.joints, [&](int joint) { return is_calibrated(joint); })) return;
    const std::vector<Pose> joints = joint_poses(body);
    const Pose above_T_body = joints.back() * mjcf_attachment(tree_, tree_.body_named(body.name), base_);
    const Pose parent_T_body = mjcf_attachment(tree_, body.parent, base_).inverse() * above_T_body;
    for (std::size_t i = 0; i + 1 < joints.size(); ++i)
      change_joint(tree_.joints[body.joints[i]], above_T_body.inverse() * joints[i]);
    change_body(body, body.frame.inverse() * parent_T_body);
  }

  void change_body(const MjcfBody& body, const Pose& local) {
    const int last = body.joints.back();
    OriginChange change = empty_change(last, body.line);
    change.translation = local.position - body.local.position;
    change.rotation_vector = log_so3(body.local.rotation.transpose() * local.rotation);
    const XmlElementPosition& place = positions_[body.element];
    const bool moved = largest(change.translation) > no_change, turned = largest(change.rotation_vector) > no_change;
    if (moved) edits_.set_attribute(place, "pos", tidy_list(local.position));
    if (turned) set_orientation(body, place, local.rotation);
    if (moved || turned || std::abs(change.offset) > no_change) changes_.push_back(std::move(change));
  }

  void set_orientation(const MjcfBody& body, const XmlElementPosition& place, const Mat3& rotation) {
    const MjcfOrientation kind = body.orientation;
    const auto numbers = numbers_of(kind, rotation, body.orientation_numbers, tree_.units);
    if (numbers) return edits_.set_attribute(place, attribute_of(kind), plain_list(*numbers));
    const std::vector<double> upright{1.0, 0.0, 0.0, 0.0};
    const std::string quat = plain_list(*numbers_of(MjcfOrientation::quat, rotation, upright, tree_.units));
    if (kind == MjcfOrientation::none) return edits_.set_attribute(place, "quat", quat);
    edits_.replace_attribute(place, attribute_of(kind), "quat", quat);
  }

  /// What rounding leaves of a zero is a zero.
  static std::string tidy_list(const Vec3& v) {
    return plain_list(Vec3(v.unaryExpr([](double x) { return std::abs(x) < rounded_zero ? 0.0 : x; })));
  }

  static const char* attribute_of(MjcfOrientation kind) {
    return mjcf_orientations[static_cast<std::size_t>(kind) - 1].attribute;
  }

  /// `body_T_joint`: of the joint's point with the axes that the body had.
  void change_joint(const MjcfJoint& joint, const Pose& body_T_joint) {
    const Vec3 axis = body_T_joint.rotation * joint.axis;
    OriginChange change = empty_change(tree_.joint_named(joint.name), joint.line);
    change.translation = body_T_joint.position - joint.position;
    change.rotation_vector = joint.axis.cross(axis);  // their angle is small
    const XmlElementPosition& place = positions_[joint.element];
    const Mat3 body_R_frame = joint.frame.rotation;
    const bool moved = largest(change.translation) > no_change, turned = largest(change.rotation_vector) > no_change;
    if (moved) edits_.set_attribute(place, "pos", tidy_list(Vec3(joint.frame.inverse() * body_T_joint.position)));
    if (turned) edits_.set_attribute(place, "axis", tidy_list(Vec3(body_R_frame.transpose() * axis)));
    if (moved || turned || std::abs(change.offset) > no_change) changes_.push_back(std::move(change));
  }

  OriginChange empty_change(int joint, int line) const {
    const CalibratedOrigin* origin = origin_of(joint);
    return {.joint = tree_.joints[joint].name,
            .line = line,
            .offset = origin ? origin->offset : 0.0,
            .translates = tree_.joints[joint].type == MjcfJointType::slide};
  }

  const MjcfTree& tree_;
  const std::vector<XmlElementPosition>& positions_;
  int base_ = -1;
  const std::vector<CalibratedOrigin>& origins_;
  XmlEdits edits_;
  std::vector<OriginChange> changes_;
};

}  // namespace

Result<PatchedText> patch_mjcf(std::string_view text, const std::string& name, const ChainEnds& ends,
                               const std::vector<CalibratedOrigin>& origins) {
  KINFER_TRY(tree, parse_mjcf_tree(text, name));
  const auto positions = all_positions(text);
  if (!positions) return error("{}: its XML is too unusual to be changed in place", name);
  PatchedText patched = MjcfPatcher(text, tree, *positions, tree.body_named(ends.base_link), origins).patch();
  // Poses at the limit of what a file may hold can be beyond it once they are moved.
  if (const auto again = parse_mjcf(patched.text, name, ends); !again) return forward_error(again.error());
  return patched;
}

}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <tinyxml2.h>

#include <cmath>
#include <set>

#include "kinfer/io/robot/mjcf/mjcf.hpp"
#include "kinfer/io/robot/model/joint_transforms.hpp"
#include "kinfer/io/robot/xml/xml_list.hpp"
#include "kinfer/io/robot/xml/xml_names.hpp"
#include "kinfer/io/text/format_number.hpp"

namespace kinfer {
namespace {

/// An <equality> constraint: `joint` moves by factor · position of `leader`.
struct EqualityConstraint {
  std::string joint, leader;
  double factor = 1.0;
};

class MjcfWriter {
 public:
  explicit MjcfWriter(const Chain& chain) : chain_(chain) {
    for (const Joint& joint : chain.joints) joint_names_.insert(joint.name);
    for (const Joint& joint : chain.joints) site_of_.push_back(unique_name(joint.name, site_names_));
  }

  std::string write() {
    open("mujoco", {{"model", chain_.name.empty() ? "robot" : chain_.name}});
    // Every moving body needs a mass; where the chain has none, boundmass and boundinertia set small ones.
    leaf("compiler", {{"angle", "radian"}, {"boundmass", "0.001"}, {"boundinertia", "0.001"}});
    leaf("option", {{"gravity", xml_list(chain_.gravity)}});
    open("worldbody", {});
    open_body("base", chain_.base.pose());
    if (chain_.tip_joint() < 0) write_sites({});
    write_children(-1, {});
    close();
    close();
    write_constraints();
    close();
    return printer_.CStr();
  }

 private:
  using Attributes = std::initializer_list<std::pair<const char*, std::string>>;

  void open(const char* element, Attributes attributes) {
    printer_.OpenElement(element);
    for (const auto& [key, value] : attributes) printer_.PushAttribute(key, value.c_str());
  }
  void close() { printer_.CloseElement(); }
  void leaf(const char* element, Attributes attributes) {
    open(element, attributes);
    close();
  }

  void open_body(const std::string& name, const Pose& pose) {
    open("body", {{"name", name}, {"pos", xml_list(pose.position)}, {"quat", xml_list(Quat(pose.rotation))}});
  }

  /// `after`: pose of the parent joint's frame in the parent's body.
  void write_children(int parent, const Pose& after) {
    for (std::size_t i = 0; i < chain_.joints.size(); ++i)
      if (chain_.joints[i].parent == parent) write_joint(static_cast<int>(i), after);
  }

  void write_joint(int index, const Pose& after_parent) {
    const Joint& joint = chain_.joints[index];
    const JointTransforms transforms = joint_transforms(joint.link);
    open_body("link_" + joint.name, after_parent * transforms.before);
    if (has_position(joint.type)) write_motion(index, transforms.axis);
    for (const PointMass& mass : chain_.masses)
      if (mass.joint == index)
        leaf("geom", {{"type", "sphere"},
                      {"size", "0.01"},
                      {"pos", xml_list(transforms.after * mass.com)},
                      {"mass", format_number(mass.mass)},
                      {"contype", "0"},
                      {"conaffinity", "0"}});
    leaf("site", {{"name", site_of_[index]},
                  {"pos", xml_list(transforms.after.position)},
                  {"quat", xml_list(Quat(transforms.after.rotation))}});
    if (index == chain_.tip_joint()) write_sites(transforms.after);
    write_children(index, transforms.after);
    close();
  }

  void write_motion(int index, const Vec3& axis) {
    const Joint& joint = chain_.joints[index];
    if (joint.is_active) add_joint(joint.name, joint, axis, true);
    for (const MimicTerm& term : mimic_terms(chain_, index)) {
      const std::string name = unique_name(joint.name + "_follows_" + term.joint, joint_names_);
      add_joint(name, joint, axis, false);
      constraints_.push_back({name, term.joint, term.multiplier});
    }
  }

  void add_joint(const std::string& name, const Joint& joint, const Vec3& axis, bool may_be_limited) {
    open("joint", {{"name", name}, {"type", std::string(traits(joint.type).mjcf)}, {"axis", xml_list(axis)}});
    if (may_be_limited && std::isfinite(joint.lower) && std::isfinite(joint.upper)) {
      printer_.PushAttribute("limited", "true");
      printer_.PushAttribute("range",
                             fmt::format("{} {}", format_number(joint.lower), format_number(joint.upper)).c_str());
    }
    close();
  }

  void write_sites(const Pose& flange) {
    const Pose tool = flange * chain_.tool.pose();
    leaf("site", {{"name", tool_site}, {"pos", xml_list(tool.position)}, {"quat", xml_list(Quat(tool.rotation))}});
    for (const Target& target : chain_.targets)
      leaf("site", {{"name", unique_name(target.name, site_names_)}, {"pos", xml_list(tool * target.xyz)}});
  }

  std::string body_name(int joint) const { return joint < 0 ? "base" : "link_" + chain_.joints[joint].name; }

  /// MuJoCo takes the point of the second body from the joint positions 0, where the loop is closed.
  void write_closure(const LoopClosure& closure) {
    const Pose body_T_frame = closure.first < 0 ? Pose{} : joint_transforms(chain_.joints[closure.first].link).after;
    leaf("connect", {{"name", closure.name},
                     {"body1", body_name(closure.first)},
                     {"body2", body_name(closure.second)},
                     {"anchor", xml_list(body_T_frame * closure.point_in_first)}});
  }

  void write_constraints() {
    if (constraints_.empty() && chain_.closures.empty()) return;
    open("equality", {});
    for (const LoopClosure& closure : chain_.closures) write_closure(closure);
    for (const EqualityConstraint& constraint : constraints_)
      leaf("joint", {{"joint1", constraint.joint},
                     {"joint2", constraint.leader},
                     {"polycoef", fmt::format("0 {} 0 0 0", format_number(constraint.factor))}});
    close();
  }

  const Chain& chain_;
  tinyxml2::XMLPrinter printer_;
  std::vector<EqualityConstraint> constraints_;
  std::vector<std::string> site_of_;  ///< of each joint: the name of its site
  std::set<std::string> site_names_{tool_site}, joint_names_;
};

}  // namespace

std::string format_mjcf(const Chain& chain) {
  const Chain named = with_xml_names(chain);
  return MjcfWriter(named).write();
}

}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
#include <tinyxml2.h>

#include <cmath>
#include <set>

#include "kinfer/io/robot/model/joint_transforms.hpp"
#include "kinfer/io/robot/urdf/urdf.hpp"
#include "kinfer/io/robot/urdf/urdf_tool.hpp"
#include "kinfer/io/robot/xml/xml_list.hpp"
#include "kinfer/io/robot/xml/xml_names.hpp"
#include "kinfer/io/text/format_number.hpp"

namespace kinfer {
namespace {

constexpr const char* no_limit = "1e9";  // URDF requires limits, efforts and speeds even where none is known

class UrdfWriter {
 public:
  explicit UrdfWriter(const Chain& chain) : chain_(chain), after_(chain.joints.size()), link_(chain.joints.size()) {
    for (const Joint& joint : chain.joints) joint_names_.insert(joint.name);
  }

  std::string write() {
    printer_.PushHeader(false, true);
    printer_.OpenElement("robot");
    printer_.PushAttribute("name", chain_.name.empty() ? "robot" : chain_.name.c_str());
    const std::string world = add_link(written_urdf::world_link);
    const std::string base = add_link(written_urdf::base_link);
    add_fixed(written_urdf::base_joint, world, base, chain_.base.pose());
    for (std::size_t i = 0; i < chain_.joints.size(); ++i) write_joint(static_cast<int>(i), base);
    write_tool(base);
    write_closures();
    printer_.CloseElement();
    return printer_.CStr();
  }

 private:
  /// URDF is a tree: a loop stays open in it, and only a comment says where it closes.
  void write_closures() {
    const auto name = [&](int joint) { return joint < 0 ? std::string("base") : chain_.joints[joint].name; };
    for (const LoopClosure& closure : chain_.closures)
      printer_.PushComment(
          fmt::format(" loop left open: revolute joint {} between {} (point {}, axis {}) and {} (point "
                      "{}, axis {}) ",
                      without_double_hyphen(closure.name), without_double_hyphen(name(closure.first)),
                      xml_list(closure.point_in_first), xml_list(closure.axis_in_first),
                      without_double_hyphen(name(closure.second)), xml_list(closure.point_in_second),
                      xml_list(closure.axis_in_second))
              .c_str());
  }

  /// XML comments may not contain "--".
  static std::string without_double_hyphen(std::string text) {
    for (std::size_t at = text.find("--"); at != std::string::npos; at = text.find("--", at)) text.replace(at, 2, "-");
    return text;
  }

  std::string add_link(const std::string& wish) {
    std::string name = unique_name(wish, link_names_);
    printer_.OpenElement("link");
    printer_.PushAttribute("name", name.c_str());
    printer_.CloseElement();
    return name;
  }

  void open_joint(const std::string& name, std::string_view type, const std::string& parent, const std::string& child,
                  const Pose& origin) {
    printer_.OpenElement("joint");
    printer_.PushAttribute("name", name.c_str());
    printer_.PushAttribute("type", std::string(type).c_str());
    add_element("parent", "link", parent);
    add_element("child", "link", child);
    printer_.OpenElement("origin");
    printer_.PushAttribute("xyz", xml_list(origin.position).c_str());
    printer_.PushAttribute("rpy", xml_list(to_rpy(origin.rotation)).c_str());
    printer_.CloseElement();
  }

  void add_element(const char* element, const char* attribute, const std::string& value) {
    printer_.OpenElement(element);
    printer_.PushAttribute(attribute, value.c_str());
    printer_.CloseElement();
  }

  void add_fixed(const std::string& wish, const std::string& parent, const std::string& child, const Pose& origin) {
    open_joint(unique_name(wish, joint_names_), "fixed", parent, child, origin);
    printer_.CloseElement();
  }

  void add_limit(const Joint& joint) {
    printer_.OpenElement("limit");
    printer_.PushAttribute("lower", std::isfinite(joint.lower) ? format_number(joint.lower).c_str()
                                                               : (std::string("-") + no_limit).c_str());
    printer_.PushAttribute("upper", std::isfinite(joint.upper) ? format_number(joint.upper).c_str() : no_limit);
    printer_.PushAttribute("effort", no_limit);
    printer_.PushAttribute("velocity", no_limit);
    printer_.CloseElement();
  }

  void add_moving(const std::string& name, const Joint& joint, const std::string& parent, const std::string& child,
                  const Pose& origin, const Vec3& axis, const MimicTerm* mimic) {
    const JointTypeTraits& type = traits(joint.type);
    const bool limited = !mimic && (std::isfinite(joint.lower) || std::isfinite(joint.upper));
    open_joint(name, limited ? type.urdf : type.urdf_unlimited, parent, child, origin);
    add_element("axis", "xyz", xml_list(axis));
    if (limited || type.urdf == type.urdf_unlimited) add_limit(mimic ? Joint{} : joint);  // a type that has limits
    if (mimic) {
      printer_.OpenElement("mimic");
      printer_.PushAttribute("joint", mimic->joint.c_str());
      printer_.PushAttribute("multiplier", format_number(mimic->multiplier).c_str());
      printer_.CloseElement();
    }
    printer_.CloseElement();
  }

  void write_joint(int index, const std::string& base) {
    const Joint& joint = chain_.joints[index];
    const JointTransforms transforms = joint_transforms(joint.link);
    std::string parent = joint.parent < 0 ? base : link_[joint.parent];
    Pose origin = (joint.parent < 0 ? Pose{} : after_[joint.parent]) * transforms.before;
    after_[index] = transforms.after;
    std::vector<MimicTerm> mimics = mimic_terms(chain_, index);
    const bool is_fixed = !has_position(joint.type) || (!joint.is_active && mimics.empty());
    link_[index] = add_link("link_" + joint.name);
    if (is_fixed) {
      open_joint(joint.name, "fixed", parent, link_[index], origin);
      return printer_.CloseElement();
    }
    // Rotations about one axis add up in any order: one URDF joint each, the first with the joint's own name.
    if (joint.is_active) {
      add_moving(joint.name, joint, parent, link_[index], origin, transforms.axis, nullptr);
    } else {
      add_moving(joint.name, joint, parent, link_[index], origin, transforms.axis, &mimics.front());
      mimics.erase(mimics.begin());
    }
    for (const MimicTerm& mimic : mimics) {
      const std::string name = unique_name(joint.name + "_follows_" + mimic.joint, joint_names_);
      const std::string link = add_link("link_" + name);
      add_moving(name, joint, link_[index], link, Pose{}, transforms.axis, &mimic);
      link_[index] = link;
    }
  }

  void write_tool(const std::string& base) {
    const int tip = chain_.tip_joint();
    const std::string tool = add_link(written_urdf::tool_link);
    add_fixed(written_urdf::tool_joint, tip < 0 ? base : link_[tip], tool,
              (tip < 0 ? Pose{} : after_[tip]) * chain_.tool.pose());
    for (const Target& target : chain_.targets)
      add_fixed(written_urdf::target_joint_prefix + target.name, tool, add_link(target.name),
                {Mat3::Identity(), target.xyz});
  }

  const Chain& chain_;
  tinyxml2::XMLPrinter printer_;
  std::vector<Pose> after_;        ///< of each joint: from its last link's frame to the joint's frame
  std::vector<std::string> link_;  ///< of each joint: its last link
  std::set<std::string> link_names_, joint_names_;
};

}  // namespace

std::string format_urdf(const Chain& chain) {
  const Chain named = with_xml_names(chain);
  return UrdfWriter(named).write();
}

}  // namespace kinfer

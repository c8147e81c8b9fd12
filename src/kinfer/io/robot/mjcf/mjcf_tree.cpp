// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/mjcf/mjcf_tree.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>

#include "kinfer/io/robot/mjcf/mjcf_attributes.hpp"
#include "kinfer/io/robot/mjcf/mjcf_defaults.hpp"
#include "kinfer/io/robot/xml/xml_errors.hpp"
#include "kinfer/io/robot/xml/xml_names.hpp"
#include "kinfer/io/text/first_error.hpp"

namespace kinfer {
namespace {

using tinyxml2::XMLElement;

/// Numbers of all elements in the order of the text.
std::unordered_map<const XMLElement*, int> element_numbers(const XMLElement& root) {
  std::unordered_map<const XMLElement*, int> numbers;
  const auto visit = [&](const auto& self, const XMLElement& element) -> void {
    numbers.emplace(&element, static_cast<int>(numbers.size()));
    for (auto* child = element.FirstChildElement(); child; child = child->NextSiblingElement()) self(self, *child);
  };
  visit(visit, root);
  return numbers;
}

std::optional<MjcfJointType> joint_type_of(std::string_view name) {
  if (name.empty() || name == "hinge") return MjcfJointType::hinge;
  if (name == "slide") return MjcfJointType::slide;
  if (name == "ball") return MjcfJointType::ball;
  if (name == "free") return MjcfJointType::free;
  return std::nullopt;
}

class MjcfTreeParser {
 public:
  explicit MjcfTreeParser(FirstError& first_error) : first_error_(first_error) {}

  MjcfTree parse(const XMLElement& mujoco) {
    if (const char* model = mujoco.Attribute("model")) tree_.model = name_from_xml(model);
    numbers_ = element_numbers(mujoco);
    refuse_include(mujoco);
    for (auto* e = mujoco.FirstChildElement("compiler"); e; e = e->NextSiblingElement("compiler")) read_compiler(*e);
    defaults_.read(mujoco, first_error_);
    for (auto* e = mujoco.FirstChildElement("worldbody"); e; e = e->NextSiblingElement("worldbody"))
      read_children(*e, {.body = -1, .frame = {}, .child_class = {}});
    for (auto* e = mujoco.FirstChildElement("equality"); e; e = e->NextSiblingElement("equality")) read_equality(*e);
    name_what_has_none();
    expect_unique_names();
    expect_constrained_joints();
    return std::move(tree_);
  }

 private:
  /// What surrounds an element.
  struct Surroundings {
    int body = -1;
    Pose frame;  ///< body_T_frame
    std::string child_class;
  };

  void refuse_include(const XMLElement& element) {
    if (const auto* include = element.FirstChildElement("include"))
      first_error_.report(include->GetLineNum(), "<include> is not followed: give one complete file");
  }

  void read_compiler(const XMLElement& compiler) {
    const int line = compiler.GetLineNum();
    const auto value = [&](const char* key) {
      return std::string(compiler.Attribute(key) ? compiler.Attribute(key) : "");
    };
    if (const std::string angle = value("angle"); !angle.empty()) {
      if (angle != "degree" && angle != "radian")
        first_error_.report(line, fmt::format("angle=\"{}\": expected degree or radian", angle));
      tree_.units.degrees = angle == "degree";
    }
    if (const std::string sequence = value("eulerseq"); !sequence.empty()) {
      if (is_euler_sequence(sequence))
        tree_.units.euler_sequence = sequence;
      else
        first_error_.report(line, fmt::format("eulerseq=\"{}\": expected three of x, y, z, X, Y, Z", sequence));
    }
    if (value("coordinate") == "global")
      first_error_.report(line,
                          "coordinate=\"global\" cannot be read: expected poses of bodies in their parents (save the "
                          "model with a MuJoCo before 2.3.4, which writes local ones)");
    if (const std::string automatic = value("autolimits"); !automatic.empty()) has_auto_limits_ = automatic == "true";
  }

  void read_children(const XMLElement& container, const Surroundings& around) {
    for (auto* child = container.FirstChildElement(); child; child = child->NextSiblingElement())
      read_child(*child, around);
  }

  void read_child(const XMLElement& child, const Surroundings& around) {
    const std::string_view kind = child.Name();
    if (kind == "body") return read_body(child, around);
    if (kind == "frame") return read_frame(child, around);
    if (kind == "joint" || kind == "freejoint") return read_joint(child, around);
    if (kind == "site") return read_site(child, around);
    if (kind == "include") first_error_.report(child.GetLineNum(), "<include> is not followed: give one complete file");
    if (kind == "replicate" || kind == "attach")
      first_error_.report(
          child.GetLineNum(),
          fmt::format("<{}> is not carried out: give the file that MuJoCo saves of the compiled model", kind));
  }

  MjcfAttributes attributes(const XMLElement& element, const Surroundings& around) {
    return {element, around.child_class, defaults_, tree_.units, first_error_};
  }

  void read_frame(const XMLElement& element, const Surroundings& around) {
    const MjcfAttributes own = attributes(element, around);
    read_children(element, {.body = around.body,
                            .frame = around.frame * own.placement().pose,
                            .child_class = own.text_or("childclass", around.child_class)});
    own.expect_class(own.text_or("childclass", ""));
  }

  void read_body(const XMLElement& element, const Surroundings& around) {
    const MjcfAttributes own = attributes(element, around);
    const MjcfPlacement placement = own.placement();
    MjcfBody body{.name = own.name("name"),
                  .parent = around.body,
                  .frame = around.frame,
                  .local = placement.pose,
                  .orientation = placement.orientation,
                  .orientation_numbers = placement.numbers,
                  .line = element.GetLineNum(),
                  .element = numbers_.at(&element)};
    own.expect_class(own.text_or("childclass", ""));
    if (around.body >= 0) tree_.bodies[around.body].is_leaf = false;
    const int index = static_cast<int>(tree_.bodies.size());
    tree_.bodies.push_back(std::move(body));
    read_children(element, {.body = index, .frame = {}, .child_class = own.text_or("childclass", around.child_class)});
  }

  void read_joint(const XMLElement& element, const Surroundings& around) {
    const int line = element.GetLineNum();
    if (around.body < 0) return first_error_.report(line, "a joint of the world: expected it in a body");
    const MjcfAttributes own = attributes(element, around);
    const bool is_free = std::string_view(element.Name()) == "freejoint";
    const std::string type_name = own.text_or("type", "");
    const auto type = is_free ? MjcfJointType::free : joint_type_of(type_name);
    if (!type)
      return first_error_.report(
          line, fmt::format("{}: type=\"{}\": expected hinge, slide, ball or free", own.who(), type_name));
    MjcfJoint joint{.name = own.name("name"),
                    .body = around.body,
                    .type = *type,
                    .frame = around.frame,
                    .line = line,
                    .element = numbers_.at(&element)};
    if (*type == MjcfJointType::hinge || *type == MjcfJointType::slide) read_motion(own, joint);
    tree_.bodies[around.body].joints.push_back(static_cast<int>(tree_.joints.size()));
    tree_.joints.push_back(std::move(joint));
  }

  void read_motion(const MjcfAttributes& own, MjcfJoint& joint) {
    const double unit = joint.type == MjcfJointType::hinge ? tree_.units.angle() : 1.0;
    joint.position = joint.frame * own.vector("pos", Vec3::Zero());
    joint.axis = joint.frame.rotation * own.direction("axis", Vec3::UnitZ());
    joint.reference = unit * own.number("ref", 0.0);
    const auto range = own.numbers("range", 2).value_or(std::vector<double>{0.0, 0.0});
    const std::string limited = own.text_or("limited", "auto");
    const bool has_range = range[0] != 0.0 || range[1] != 0.0;
    joint.is_limited = limited == "true" || (limited == "auto" && has_auto_limits_ && has_range);
    joint.lower = unit * range[0], joint.upper = unit * range[1];
  }

  void read_site(const XMLElement& element, const Surroundings& around) {
    const MjcfAttributes own = attributes(element, around);
    const std::string name = own.name("name");
    if (name.empty()) return;
    const bool by_ends = !own.text_or("fromto", "").empty();
    tree_.sites.push_back({.name = name,
                           .body = around.body,
                           .pose = around.frame * (by_ends ? Pose{} : own.placement().pose),
                           .is_placed_by_ends = by_ends});
  }

  void read_equality(const XMLElement& section) {
    refuse_include(section);
    for (auto* element = section.FirstChildElement("joint"); element; element = element->NextSiblingElement("joint")) {
      const MjcfAttributes own(*element, "", defaults_, tree_.units, first_error_, "equality");
      if (own.text_or("active", "true") == "false") continue;
      MjcfJointConstraint constraint{
          .joint = own.name("joint1"), .other = own.name("joint2"), .line = element->GetLineNum()};
      const auto coefficients = own.numbers("polycoef", 1, 5);
      if (coefficients) std::ranges::copy(*coefficients, constraint.polynomial.begin());
      tree_.constraints.push_back(std::move(constraint));
    }
  }

  void name_what_has_none() {
    for (std::size_t b = 0; b < tree_.bodies.size(); ++b)
      if (tree_.bodies[b].name.empty()) tree_.bodies[b].name = unused(fmt::format("body{}", b + 1));
    for (MjcfJoint& joint : tree_.joints)
      if (joint.name.empty()) joint.name = unused(tree_.bodies[joint.body].name + "_joint");
  }

  std::string unused(const std::string& wish) const {
    std::string name = wish;
    for (int i = 2; tree_.body_named(name) >= 0 || tree_.joint_named(name) >= 0; ++i)
      name = fmt::format("{}{}", wish, i);
    return name;
  }

  void expect_unique_names() {
    std::set<std::string_view> bodies{"world"}, joints;
    for (const MjcfBody& body : tree_.bodies)
      if (!bodies.insert(body.name).second)
        first_error_.report(body.line, fmt::format("body \"{}\" appears twice", body.name));
    for (const MjcfJoint& joint : tree_.joints)
      if (!joints.insert(joint.name).second)
        first_error_.report(joint.line, fmt::format("joint \"{}\" appears twice", joint.name));
  }

  void expect_constrained_joints() {
    for (const MjcfJointConstraint& constraint : tree_.constraints)
      for (const std::string& name : {constraint.joint, constraint.other})
        if (tree_.joint_named(name) < 0 && !(name.empty() && &name != &constraint.joint))
          first_error_.report(constraint.line,
                              fmt::format("an equality constrains joint \"{}\", which does not exist", name));
  }

  FirstError& first_error_;
  MjcfTree tree_;
  MjcfDefaults defaults_;
  bool has_auto_limits_ = true;
  std::unordered_map<const XMLElement*, int> numbers_;
};

}  // namespace

int MjcfTree::body_named(std::string_view name) const {
  const auto found = std::ranges::find_if(bodies, [&](const MjcfBody& body) { return body.name == name; });
  return found == bodies.end() ? -1 : static_cast<int>(found - bodies.begin());
}

int MjcfTree::joint_named(std::string_view name) const {
  const auto found = std::ranges::find_if(joints, [&](const MjcfJoint& joint) { return joint.name == name; });
  return found == joints.end() ? -1 : static_cast<int>(found - joints.begin());
}

const MjcfSite* MjcfTree::site_named(std::string_view name) const {
  const auto found = std::ranges::find_if(sites, [&](const MjcfSite& site) { return site.name == name; });
  return found == sites.end() ? nullptr : &*found;
}

Result<MjcfTree> parse_mjcf_tree(std::string_view text, const std::string& name) {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) return malformed_xml(document, name);
  const XMLElement* mujoco = document.RootElement();
  if (!mujoco || std::string_view(mujoco->Name()) != "mujoco")
    return error("{}:{}: expected <mujoco> as the outermost element, found <{}>", name,
                 mujoco ? mujoco->GetLineNum() : 1, mujoco ? mujoco->Name() : "");
  FirstError first_error(name);
  MjcfTree tree = MjcfTreeParser(first_error).parse(*mujoco);
  if (first_error.any()) return forward_error(first_error.as_error());
  return tree;
}

}  // namespace kinfer

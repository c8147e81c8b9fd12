// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/patch/urdf_joints.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <sstream>

#include "kinfer/io/robot/patch/xml_edits.hpp"

namespace kinfer {
namespace {

using Positions = std::vector<XmlElementPosition>;

std::string text_of(const tinyxml2::XMLElement* element, const char* key) {
  const char* text = element ? element->Attribute(key) : nullptr;
  return text ? text : "";
}

Vec3 three_numbers(const std::string& text) {
  std::istringstream words(text);
  words.imbue(std::locale::classic());
  Vec3 numbers = Vec3::Zero();
  for (int i = 0; i < 3; ++i) words >> numbers[i];
  return numbers;
}

/// Indices of the children of an element, in order.
std::vector<int> children(const Positions& positions, int parent) {
  std::vector<int> indices;
  for (int i = parent + 1; i < static_cast<int>(positions.size()); ++i)
    if (positions[i].parent == parent) indices.push_back(i);
  return indices;
}

/// The first child of that name; −1 where there is none.
int child_named(const Positions& positions, const std::vector<int>& among, std::string_view name) {
  const auto found = std::ranges::find_if(among, [&](int i) { return positions[i].name == name; });
  return found == among.end() ? -1 : *found;
}

class UrdfJointLocator {
 public:
  UrdfJointLocator(std::string_view text, const Positions& positions) : text_(text), positions_(positions) {}

  /// None where text and tree disagree.
  std::optional<UrdfJointPositions> locate(const tinyxml2::XMLElement& robot) {
    UrdfJointPositions result{.robot_name = text_of(&robot, "name"), .joints = {}};
    if (positions_.empty() || !corresponds(text_, positions_.front(), robot)) return std::nullopt;
    const auto* element = robot.FirstChildElement("joint");
    for (const int index : children(positions_, 0)) {
      if (positions_[index].name != "joint") continue;
      if (!element || !corresponds(text_, positions_[index], *element)) return std::nullopt;
      auto joint = locate_joint(*element, index);
      if (!joint) return std::nullopt;
      result.joints.push_back(std::move(*joint));
      element = element->NextSiblingElement("joint");
    }
    if (element) return std::nullopt;
    return result;
  }

 private:
  std::optional<UrdfJointPosition> locate_joint(const tinyxml2::XMLElement& element, int index) const {
    UrdfJointPosition joint{.name = text_of(&element, "name"),
                            .parent_link = text_of(element.FirstChildElement("parent"), "link"),
                            .child_link = text_of(element.FirstChildElement("child"), "link"),
                            .is_fixed = text_of(&element, "type") == "fixed",
                            .line = element.GetLineNum()};
    const std::vector<int> inside = children(positions_, index);
    if (inside.empty()) return std::nullopt;
    joint.first_child = positions_[inside.front()];
    const auto* origin = element.FirstChildElement("origin");
    const int place = child_named(positions_, inside, "origin");
    if ((origin == nullptr) != (place < 0)) return std::nullopt;
    if (!origin) return joint;
    if (!corresponds(text_, positions_[place], *origin)) return std::nullopt;
    joint.origin = positions_[place];
    joint.xyz = three_numbers(text_of(origin, "xyz"));
    joint.rpy = three_numbers(text_of(origin, "rpy"));
    return joint;
  }

  std::string_view text_;
  const Positions& positions_;
};

}  // namespace

const UrdfJointPosition* UrdfJointPositions::find(std::string_view joint) const {
  const auto found = std::ranges::find_if(joints, [&](const auto& j) { return j.name == joint; });
  return found == joints.end() ? nullptr : &*found;
}

const UrdfJointPosition* UrdfJointPositions::joint_to(std::string_view link) const {
  const auto found = std::ranges::find_if(joints, [&](const auto& j) { return j.child_link == link; });
  return found == joints.end() ? nullptr : &*found;
}

Result<UrdfJointPositions> locate_urdf_joints(std::string_view text, const std::string& name) {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS || !document.RootElement())
    return error("{}:{}: malformed XML", name, document.ErrorLineNum());
  const auto positions = xml_positions(text);
  auto joints = positions ? UrdfJointLocator(text, *positions).locate(*document.RootElement()) : std::nullopt;
  if (!joints) return error("{}: its XML is too unusual to be changed in place", name);
  return std::move(*joints);
}

}  // namespace kinfer

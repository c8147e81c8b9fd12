// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/urdf/urdf_tree.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <set>

#include "kinfer/io/robot/xml/xml_errors.hpp"
#include "kinfer/io/text/first_error.hpp"

namespace kinfer {
namespace {

using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

std::string attribute(const XMLElement* element, const char* name) {
  const char* text = element ? element->Attribute(name) : nullptr;
  return text ? text : "";
}

class UrdfTreeParser {
 public:
  explicit UrdfTreeParser(FirstError& first_error) : first_error_(first_error) {}

  UrdfTree check(const XMLElement& robot) {
    read_links(robot);
    read_joints(robot);
    if (!first_error_.any()) find_root(robot.GetLineNum());
    if (!first_error_.any()) expect_no_loop();
    return std::move(tree_);
  }

 private:
  void read_links(const XMLElement& robot) {
    for (auto* link = robot.FirstChildElement("link"); link; link = link->NextSiblingElement("link")) {
      const std::string name = attribute(link, "name");
      if (name.empty()) first_error_.report(link->GetLineNum(), "a <link> has no name");
      if (tree_.has_link(name)) first_error_.report(link->GetLineNum(), fmt::format("link \"{}\" appears twice", name));
      tree_.links.push_back(name);
    }
    if (tree_.links.empty())
      first_error_.report(robot.GetLineNum(), "the robot has no links, expected at least two <link>");
  }

  void read_joints(const XMLElement& robot) {
    for (auto* joint = robot.FirstChildElement("joint"); joint; joint = joint->NextSiblingElement("joint")) {
      UrdfTree::Edge edge{attribute(joint, "name"), attribute(joint->FirstChildElement("parent"), "link"),
                          attribute(joint->FirstChildElement("child"), "link"), joint->GetLineNum(),
                          attribute(joint, "type") == "fixed"};
      check_edge(edge);
      tree_.edges.push_back(std::move(edge));
    }
    if (tree_.edges.empty())
      first_error_.report(robot.GetLineNum(), "the robot has no joints, expected at least one <joint>");
  }

  void check_edge(const UrdfTree::Edge& edge) {
    if (edge.joint.empty()) first_error_.report(edge.line, "a <joint> has no name");
    for (const UrdfTree::Edge& other : tree_.edges) {
      if (other.joint == edge.joint)
        first_error_.report(edge.line, fmt::format("joint \"{}\" appears twice", edge.joint));
      if (other.child == edge.child)
        first_error_.report(
            edge.line, fmt::format("link \"{}\" is the child of joint \"{}\" and of joint \"{}\": loops cannot be read",
                                   edge.child, other.joint, edge.joint));
    }
    check_end(edge, "parent", edge.parent);
    check_end(edge, "child", edge.child);
    if (edge.parent == edge.child)
      first_error_.report(edge.line,
                          fmt::format("joint \"{}\" connects link \"{}\" to itself", edge.joint, edge.child));
  }

  void check_end(const UrdfTree::Edge& edge, const char* which, const std::string& link) {
    if (link.empty())
      first_error_.report(edge.line, fmt::format("joint \"{}\" has no <{} link=\"...\">", edge.joint, which));
    else if (!tree_.has_link(link))
      first_error_.report(edge.line,
                          fmt::format("joint \"{}\": its {} link \"{}\" does not exist", edge.joint, which, link));
  }

  void find_root(int line) {
    std::vector<std::string> roots;
    for (const std::string& link : tree_.links)
      if (!tree_.edge_to(link)) roots.push_back(link);
    if (roots.empty()) return;  // a loop through all links
    if (roots.size() > 1)
      first_error_.report(line,
                          fmt::format("links \"{}\" and \"{}\" have no parent, expected one root", roots[0], roots[1]));
    tree_.root = roots.front();
  }

  /// Every link has at most one parent, so a walk towards the root either ends there or repeats.
  void expect_no_loop() {
    for (const UrdfTree::Edge& start : tree_.edges) {
      std::set<std::string> seen;
      const UrdfTree::Edge* edge = &start;
      while (edge && seen.insert(edge->joint).second) edge = tree_.edge_to(edge->parent);
      if (edge)
        return first_error_.report(edge->line,
                                   fmt::format("joint \"{}\" is part of a loop: loops cannot be read", edge->joint));
    }
  }

  FirstError& first_error_;
  UrdfTree tree_;
};

/// Names and joints only: an invalid mesh or inertia must not prevent reading the kinematics.
std::string reduce_to_kinematics(const XMLElement& robot) {
  XMLDocument reduced;
  XMLElement* copy = reduced.NewElement("robot");
  const std::string name = attribute(&robot, "name");
  copy->SetAttribute("name", name.empty() ? "robot" : name.c_str());
  reduced.InsertEndChild(copy);
  for (auto* link = robot.FirstChildElement("link"); link; link = link->NextSiblingElement("link"))
    copy->InsertNewChildElement("link")->SetAttribute("name", attribute(link, "name").c_str());
  for (auto* joint = robot.FirstChildElement("joint"); joint; joint = joint->NextSiblingElement("joint")) {
    XMLElement* bare = copy->InsertNewChildElement("joint");
    bare->SetAttribute("name", attribute(joint, "name").c_str());
    if (const char* type = joint->Attribute("type")) bare->SetAttribute("type", type);
    for (const char* part : {"origin", "parent", "child", "axis", "limit", "mimic"})
      if (const XMLElement* element = joint->FirstChildElement(part))
        bare->InsertEndChild(element->DeepClone(&reduced));
  }
  tinyxml2::XMLPrinter printer(nullptr, true);
  reduced.Print(&printer);
  return printer.CStr();
}

}  // namespace

bool UrdfTree::has_link(std::string_view name) const {
  return std::find(links.begin(), links.end(), name) != links.end();
}

const UrdfTree::Edge* UrdfTree::edge_to(std::string_view child) const {
  const auto found = std::find_if(edges.begin(), edges.end(), [&](const Edge& edge) { return edge.child == child; });
  return found == edges.end() ? nullptr : &*found;
}

bool UrdfTree::is_leaf(std::string_view link) const {
  return std::none_of(edges.begin(), edges.end(), [&](const Edge& edge) { return edge.parent == link; });
}

Result<UrdfTree> parse_urdf_tree(std::string_view text, const std::string& name) {
  XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) return malformed_xml(document, name);
  const XMLElement* robot = document.RootElement();
  if (!robot || std::string_view(robot->Name()) != "robot")
    return error("{}:{}: expected <robot> as the outermost element, found <{}>", name, robot ? robot->GetLineNum() : 1,
                 robot ? robot->Name() : "");
  FirstError first_error(name);
  UrdfTree tree = UrdfTreeParser(first_error).check(*robot);
  if (first_error.any()) return forward_error(first_error.as_error());
  tree.kinematics = reduce_to_kinematics(*robot);
  return tree;
}

}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
#include <console_bridge/console.h>
#include <fmt/ranges.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <mutex>
#include <set>

#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/robot/model/possible_chain.hpp"
#include "kinfer/io/robot/urdf/urdf.hpp"
#include "kinfer/io/robot/urdf/urdf_tool.hpp"
#include "kinfer/io/robot/urdf/urdf_tree.hpp"
#include "kinfer/io/robot/xml/xml_names.hpp"
#include "kinfer/io/text/replace_all.hpp"

namespace kinfer {
namespace {

constexpr double unlimited =
    1e4;  // [rad], [m] and beyond: what a URDF states for a joint without limits, as limits are mandatory

/// Captures what the library would print.
class LogCapture : public console_bridge::OutputHandler {
 public:
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first.empty()) first = text;
  }
  std::string first;
};

/// The model, and what the library says of it.
struct Parsed {
  urdf::ModelInterfaceSharedPtr model;
  std::string first_error;
};

/// The library's output handler and level are global: for one caller at a time.
Parsed parse_without_output(const std::string& text, console_bridge::LogLevel level) {
  LogCapture log_capture;
  const console_bridge::LogLevel before = console_bridge::getLogLevel();
  console_bridge::useOutputHandler(&log_capture);
  console_bridge::setLogLevel(level);
  Parsed parsed;
  try {
    parsed.model = urdf::parseURDF(text);
  } catch (const std::exception& failure) {
    log_capture.first = failure.what();
  }
  console_bridge::setLogLevel(before);
  console_bridge::restorePreviousOutputHandler();
  parsed.first_error = log_capture.first;
  return parsed;
}

/// The library prints some errors, with what the file says in them, as a format (urdfdom 3.0.1, pose.cpp). So nothing
/// is printed of the file's own text, and only where that fails is the reason printed, of a text with each % doubled.
Result<urdf::ModelInterfaceSharedPtr> parse_model(std::string text, const std::string& name) {
  static std::mutex parser_mutex;
  const std::lock_guard lock(parser_mutex);
  if (Parsed parsed = parse_without_output(text, console_bridge::CONSOLE_BRIDGE_LOG_NONE); parsed.model)
    return parsed.model;
  replace_all(text, "%", "%%");
  Parsed failed = parse_without_output(text, console_bridge::CONSOLE_BRIDGE_LOG_ERROR);
  replace_all(failed.first_error, "%%", "%");
  return error("{}: not a valid URDF: {}", name, failed.first_error);
}

Frame frame_of(const urdf::Pose& pose) {
  const Quat rotation(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z);
  return {Vec3(pose.position.x, pose.position.y, pose.position.z), rotation.normalized().toRotationMatrix(),
          Vec3::Zero()};
}

bool is_finite(const urdf::Joint& joint) {
  const auto& p = joint.parent_to_joint_origin_transform;
  const double sum = p.position.x + p.position.y + p.position.z + p.rotation.w + p.rotation.x + p.rotation.y +
                     p.rotation.z + joint.axis.x + joint.axis.y + joint.axis.z +
                     (joint.mimic ? joint.mimic->multiplier + joint.mimic->offset : 0.0);
  return std::isfinite(sum);
}

std::string_view type_name(const urdf::Joint& joint) {
  switch (joint.type) {
    case urdf::Joint::REVOLUTE:
      return "revolute";
    case urdf::Joint::CONTINUOUS:
      return "continuous";
    case urdf::Joint::PRISMATIC:
      return "prismatic";
    case urdf::Joint::FIXED:
      return "fixed";
    default:
      return "another type";
  }
}

/// "revolute, continuous, prismatic or fixed"
std::string known_types() {
  std::vector<std::string_view> names;
  for (const JointTypeTraits& type : joint_types)
    for (const std::string_view name : {type.urdf, type.urdf_unlimited})
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  const std::string_view last = names.back();
  names.pop_back();
  return fmt::format("{} or {}", fmt::join(names, ", "), last);
}

Pose motion(const UrdfLink& link, JointType type, double amount) {
  if (translates(type)) return {Mat3::Identity(), amount * link.axis};
  return {exp_so3(amount * link.axis), Vec3::Zero()};
}

/// Builds the chain of the joints that are needed, parents first.
class ChainBuilder {
 public:
  ChainBuilder(const UrdfTree& tree, const urdf::ModelInterface& model, const std::string& file)
      : tree_(tree), model_(model), file_(file), tool_(find_written_tool(tree)) {}

  Result<Chain> build(const ChainEnds& ends) {
    KINFER_TRY(path, path_between(ends));
    if (path.empty()) return error("{}: base link and tip link are the same, expected joints between them", file_);
    for (const UrdfTree::Edge* edge : path) add(*edge);
    chain_.name = model_.getName();
    chain_.tip = static_cast<int>(chain_.joints.size()) - 1;
    base_link_ = path.front()->parent;
    if (tool_ && path.back()->child == tool_->link) {
      add_targets();
      if (moving_joints(path) == 0) add_other_arms();
    }
    for (std::size_t j = 0; j < chain_.joints.size() && first_error_.empty(); ++j)
      add_coupling(j);  // may add further joints
    if (first_error_.empty() && dof(chain_) == 0)
      first_error_ = "no joint between the base link and the tip link moves";
    if (first_error_.empty()) first_error_ = impossible_model(chain_).value_or("");
    if (!first_error_.empty()) return error("{}: {}", file_, first_error_);
    chain_.name = name_from_xml(chain_.name);
    for (Joint& joint : chain_.joints) joint.name = name_from_xml(joint.name);
    return std::move(chain_);
  }

 private:
  using Path = std::vector<const UrdfTree::Edge*>;

  /// Edges from `base` down to `tip`; empty where tip is not below base.
  std::optional<Path> path_down(const std::string& base, const std::string& tip) const {
    Path path;
    for (std::string link = tip; link != base;) {
      const UrdfTree::Edge* edge = tree_.edge_to(link);
      if (!edge) return std::nullopt;
      path.push_back(edge);
      link = edge->parent;
    }
    std::reverse(path.begin(), path.end());
    return path;
  }

  Result<Path> path_between(const ChainEnds& ends) const {
    const std::string base = ends.base_link.empty() ? tree_.root : ends.base_link;
    if (!tree_.has_link(base)) return error("{}: the base link \"{}\" does not exist", file_, base);
    if (ends.tip_link.empty()) return default_path(base);
    if (!tree_.has_link(ends.tip_link)) return error("{}: the tip link \"{}\" does not exist", file_, ends.tip_link);
    const auto path = path_down(base, ends.tip_link);
    if (!path) return error("{}: the tip link \"{}\" is not below the base link \"{}\"", file_, ends.tip_link, base);
    return *path;
  }

  /// To the tool of a file that kinfer wrote, on whichever arm, else to the end of the longest arm.
  Path default_path(const std::string& base) const {
    auto path = tool_ ? path_down(base, tool_->link) : std::nullopt;
    return path ? std::move(*path) : longest_path(base);
  }

  static std::ptrdiff_t moving_joints(const Path& path) {
    return std::ranges::count_if(path, [](const UrdfTree::Edge* edge) { return !edge->is_fixed; });
  }

  Path longest_path(const std::string& base) const {
    Path longest;
    std::ptrdiff_t most = -1;
    for (const std::string& link : tree_.links) {
      const auto path = tree_.is_leaf(link) ? path_down(base, link) : std::nullopt;
      if (!path) continue;
      const std::ptrdiff_t moving = moving_joints(*path);
      if (moving > most) most = moving, longest = *path;
    }
    return longest;
  }

  int index_of(const std::string& joint) const {
    const auto found =
        std::find_if(chain_.joints.begin(), chain_.joints.end(), [&](const Joint& j) { return j.name == joint; });
    return found == chain_.joints.end() ? -1 : static_cast<int>(found - chain_.joints.begin());
  }

  void add(const UrdfTree::Edge& edge) {
    const urdf::Joint& source = *model_.getJoint(edge.joint);
    Joint joint;
    joint.name = edge.joint;
    joint.parent = parent_index(edge);
    set_type(source, joint);
    UrdfLink link;
    link.origin = frame_of(source.parent_to_joint_origin_transform);
    const Vec3 axis(source.axis.x, source.axis.y, source.axis.z);
    expect_finite(source);
    if (has_position(joint.type)) {
      if (axis.norm() < 1e-9)
        report_error(fmt::format("joint \"{}\" has an axis of zeros", edge.joint));
      else
        link.axis = axis.normalized();
    }
    if (source.mimic && has_position(joint.type)) {
      joint.is_active = false;
      link.origin = Frame::from_pose(link.origin.pose() * motion(link, joint.type, source.mimic->offset));
    }
    joint.link = link;
    chain_.joints.push_back(std::move(joint));
  }

  /// Of a chain whose tool no joint moves: the joints that it has are on the other arms.
  void add_other_arms() {
    for (const UrdfTree::Edge& edge : tree_.edges)
      if (!edge.is_fixed) add_with_ancestors(edge.joint);
  }

  void add_targets() {
    for (const UrdfTree::Edge* edge : tool_->targets) {
      const urdf::Joint& source = *model_.getJoint(edge->joint);
      expect_finite(source);
      chain_.targets.push_back(
          {name_from_xml(target_name(*edge)), frame_of(source.parent_to_joint_origin_transform).xyz});
    }
  }

  int parent_index(const UrdfTree::Edge& edge) const {
    const UrdfTree::Edge* above = tree_.edge_to(edge.parent);
    return above ? index_of(above->joint) : -1;
  }

  void set_type(const urdf::Joint& source, Joint& joint) {
    const std::string_view name = type_name(source);
    const auto row = std::ranges::find_if(
        joint_types, [&](const JointTypeTraits& t) { return t.urdf == name || t.urdf_unlimited == name; });
    if (row == joint_types.end())
      return report_error(fmt::format("joint \"{}\": expected {}", joint.name, known_types()));
    joint.type = row->type;
    if (!has_position(joint.type)) joint.is_active = false;
    if (!has_position(joint.type) || name != row->urdf || !source.limits) return;
    if (source.limits->lower > -unlimited) joint.lower = source.limits->lower;
    if (source.limits->upper < unlimited) joint.upper = source.limits->upper;
  }

  /// A mimic joint follows the position of another; where that one is a mimic joint too, the factors multiply.
  void add_coupling(std::size_t index) {
    const urdf::Joint* source = model_.getJoint(chain_.joints[index].name).get();
    if (!source->mimic || !has_position(chain_.joints[index].type)) return;
    double factor = 1.0, offset = 0.0;
    std::set<std::string> seen;
    while (source->mimic && seen.insert(source->name).second) {
      if (source->name != chain_.joints[index].name) offset += factor * source->mimic->offset;
      factor *= source->mimic->multiplier;
      const std::string& followed = source->mimic->joint_name;
      const auto next = model_.getJoint(followed);
      if (!next)
        return report_error(
            fmt::format("joint \"{}\" mimics joint \"{}\", which does not exist", source->name, followed));
      source = next.get();
    }
    if (source->mimic) return report_error(fmt::format("joint \"{}\" mimics itself", source->name));
    const int leader = add_with_ancestors(source->name);
    if (leader < 0 || !has_position(chain_.joints[leader].type))
      return report_error(fmt::format("joint \"{}\" mimics joint \"{}\", which has no joint position",
                                      chain_.joints[index].name, source->name));
    chain_.joints[index].couplings = {{leader, factor}};
    UrdfLink& link = std::get<UrdfLink>(chain_.joints[index].link);
    link.origin = Frame::from_pose(link.origin.pose() * motion(link, chain_.joints[index].type, offset));
  }

  /// Adds a mimicked joint, with its ancestors, even where it moves another branch; −1 where it is above the base link.
  int add_with_ancestors(const std::string& joint) {
    if (const int known = index_of(joint); known >= 0) return known;
    const auto child =
        std::find_if(tree_.edges.begin(), tree_.edges.end(), [&](const auto& e) { return e.joint == joint; });
    const auto path = path_down(base_link_, child->child);
    if (!path) return -1;
    for (const UrdfTree::Edge* edge : *path)
      if (index_of(edge->joint) < 0) add(*edge);
    return index_of(joint);
  }

  void expect_finite(const urdf::Joint& joint) {
    if (!is_finite(joint)) report_error(fmt::format("joint \"{}\" has a number that is not finite", joint.name));
  }

  void report_error(const std::string& sentence) {
    if (first_error_.empty()) first_error_ = sentence;
  }

  const UrdfTree& tree_;
  const urdf::ModelInterface& model_;
  const std::string& file_;
  const std::optional<WrittenTool> tool_;
  std::string base_link_, first_error_;
  Chain chain_;
};

}  // namespace

Result<Chain> parse_urdf(const std::string& text, const std::string& name, const ChainEnds& ends) {
  KINFER_TRY(tree, parse_urdf_tree(text, name));
  KINFER_TRY(model, parse_model(tree.kinematics, name));
  return ChainBuilder(tree, *model, name).build(ends);
}

Result<Chain> read_urdf(const std::filesystem::path& path, const ChainEnds& ends) {
  KINFER_TRY(text, read_text_file(path));
  return parse_urdf(text, path.string(), ends);
}

}  // namespace kinfer

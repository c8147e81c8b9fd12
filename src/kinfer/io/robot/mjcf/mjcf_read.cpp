// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "kinfer/io/robot/mjcf/mjcf.hpp"
#include "kinfer/io/robot/model/possible_chain.hpp"

namespace kinfer {
namespace {

constexpr int world = -1;

bool is_single_axis(MjcfJointType type) {
  return type == MjcfJointType::hinge || type == MjcfJointType::slide;
}

/// Bodies below `base` down to `tip`; none where tip is not below base.
std::optional<std::vector<int>> bodies_down(const MjcfTree& tree, int base, int tip) {
  std::vector<int> path;
  for (int body = tip; body != base; body = tree.bodies[body].parent) {
    if (body == world) return std::nullopt;
    path.push_back(body);
  }
  std::ranges::reverse(path);
  return path;
}

/// What a path offers as a chain: its moving joints, and whether a chain can hold all of them.
struct PathMeasure {
  bool is_possible = true;
  int moving = 0;
};

bool is_better(const PathMeasure& a, const PathMeasure& b) {
  return a.is_possible != b.is_possible ? a.is_possible : a.moving > b.moving;
}

PathMeasure measure_path(const MjcfTree& tree, const std::vector<int>& path) {
  PathMeasure measure;
  for (const int body : path)
    for (const int joint : tree.bodies[body].joints) {
      if (is_single_axis(tree.joints[joint].type))
        ++measure.moving;
      else
        measure.is_possible = false;
    }
  return measure;
}

/// The leaf at the end of the longest path, of those that a chain can hold where there is one; −1: no body below.
int longest_leaf(const MjcfTree& tree, int base) {
  int leaf = world;
  PathMeasure most{.is_possible = false, .moving = -1};
  for (int b = 0; b < static_cast<int>(tree.bodies.size()); ++b) {
    const auto path = tree.bodies[b].is_leaf ? bodies_down(tree, base, b) : std::nullopt;
    if (!path || path->empty()) continue;
    PathMeasure measure = measure_path(tree, *path);
    if (measure.moving == 0) measure.is_possible = false;  // a fixed thing beside a robot that cannot be held
    if (is_better(measure, most)) most = measure, leaf = b;
  }
  return leaf;
}

/// The site in which a chain that was written as MJCF has its tool, where the body has one and no body is called so.
bool has_tool(const MjcfTree& tree, int body) {
  const MjcfSite* site = tree.site_named(tool_site);
  return site && site->body == body && !site->is_placed_by_ends && tree.body_named(tool_site) < 0;
}

/// By the names of its bodies.
bool is_written_by_kinfer(const MjcfTree& tree) {
  return std::ranges::all_of(tree.bodies, [](const MjcfBody& body) {
    return body.parent == world ? body.name == "base" : body.name.starts_with("link_");
  });
}

/// The site of the tool in a file that kinfer wrote, on whichever arm; null where there is none.
const MjcfSite* find_written_tool(const MjcfTree& tree) {
  return is_written_by_kinfer(tree) ? tree.site_named(tool_site) : nullptr;
}

/// The body that carries the tool in a file that kinfer wrote, else the leaf at the end of the longest path.
int default_tip(const MjcfTree& tree, int base) {
  const MjcfSite* site = find_written_tool(tree);
  return site && bodies_down(tree, base, site->body) ? site->body : longest_leaf(tree, base);
}

Pose shift(const Vec3& by) {
  return {Mat3::Identity(), by};
}

Pose motion_along(const MjcfJoint& joint, double amount) {
  if (joint.type == MjcfJointType::slide) return shift(amount * joint.axis);
  return {exp_so3(amount * joint.axis), Vec3::Zero()};
}

/// How a joint moves: its variable, measured from its reference, is offset + factor · that of the leader.
struct Following {
  int leader = -1;  ///< itself: an active joint; −1: it does not move
  double factor = 1.0, offset = 0.0;
};

/// Builds the chain of the joints that are needed, parents first.
class MjcfChainBuilder {
 public:
  MjcfChainBuilder(const MjcfTree& tree, const std::string& file) : tree_(tree), file_(file) {}

  /// `ends`: with both names.
  Result<Chain> build(const ChainEnds& ends) {
    base_ = tree_.body_named(ends.base_link);
    const int body = tree_.body_named(ends.tip_link);
    const MjcfSite* site = body < 0 && ends.tip_link != "world" ? tree_.site_named(ends.tip_link) : nullptr;
    const int tip = site ? site->body : body;
    const auto path = bodies_down(tree_, base_, tip);
    if (!path)
      return error("{}: the tip link \"{}\" is not below the base link \"{}\"", file_, ends.tip_link, ends.base_link);
    attached_[base_] = -1;
    for (const int b : *path) add_body(b);
    add_tip(tip, site, ends.tip_link);
    chain_.tip = static_cast<int>(chain_.joints.size()) - 1;
    if (site && site == find_written_tool(tree_) && measure_path(tree_, *path).moving == 0) add_other_arms();
    for (std::size_t j = 0; j < chain_.joints.size(); ++j) add_coupling(j);  // may add further joints
    return finish();
  }

 private:
  Result<Chain> finish() {
    chain_.name = tree_.model;
    if (first_error_.empty() && dof(chain_) == 0)
      first_error_ = "no joint between the base link and the tip link moves";
    if (first_error_.empty()) first_error_ = impossible_model(chain_).value_or("");
    if (!first_error_.empty()) return error("{}: {}", file_, first_error_);
    return std::move(chain_);
  }

  void add_body(int index) {
    const MjcfBody& body = tree_.bodies[index];
    const int parent = attached_.at(body.parent);
    const Pose place = mjcf_attachment(tree_, body.parent, base_) * body.pose();
    if (body.joints.empty()) {
      add_fixed(body.name, parent, place);
    } else {
      Pose before = place;
      int above = parent;
      for (const int joint : body.joints) {
        add_joint(joint, above, before * shift(tree_.joints[joint].position));
        before = shift(-tree_.joints[joint].position);
        above = static_cast<int>(chain_.joints.size()) - 1;
      }
    }
    attached_[index] = static_cast<int>(chain_.joints.size()) - 1;
  }

  /// Of a chain whose tool no joint moves: the joints that it has are on the other arms.
  void add_other_arms() {
    for (std::size_t j = 0; j < tree_.joints.size(); ++j) add_with_ancestors(static_cast<int>(j));
  }

  /// `place`: pose of the joint's point with the axes of the body, at the joint's reference.
  void add_joint(int index, int parent, const Pose& place) {
    const MjcfJoint& source = tree_.joints[index];
    if (!is_single_axis(source.type)) return report_impossible(source);
    const Following following = following_of(index);
    Joint joint{.name = source.name, .parent = parent};
    joint.type = source.type == MjcfJointType::slide ? JointType::prismatic : JointType::revolute;
    double zero = following.offset;  // of the variable, measured from the reference, at joint positions 0
    if (following.leader >= 0) zero -= following.factor * tree_.joints[following.leader].reference;
    joint.is_active = following.leader == index;
    if (following.leader < 0) joint.type = JointType::fixed;
    joint.link = UrdfLink{.origin = Frame::from_pose(place * motion_along(source, zero)), .axis = source.axis};
    if (source.is_limited) joint.lower = source.lower, joint.upper = source.upper;
    chain_.joints.push_back(std::move(joint));
    source_of_.resize(chain_.joints.size(), -1);
    source_of_.back() = index;
  }

  void add_fixed(const std::string& wish, int parent, const Pose& origin) {
    Joint joint{.name = unused(wish), .parent = parent, .type = JointType::fixed, .is_active = false};
    joint.link = UrdfLink{.origin = Frame::from_pose(origin)};
    chain_.joints.push_back(std::move(joint));
    source_of_.resize(chain_.joints.size(), -1);
  }

  /// The chain ends in the frame of the body or the site, not in that of the last joint.
  void add_tip(int body, const MjcfSite* site, const std::string& name) {
    if (site && site->is_placed_by_ends)
      report_error(fmt::format("site \"{}\" is placed by fromto: expected pos and an orientation", name));
    const Pose attachment = mjcf_attachment(tree_, body, base_);
    const bool is_joint_frame = !site && attachment.position == Vec3::Zero();
    if (!is_joint_frame) add_fixed(name, attached_.at(body), site ? attachment * site->pose : attachment);
  }

  /// A name that no joint of the file has.
  std::string unused(const std::string& wish) const {
    std::string name = wish;
    const auto is_taken = [&] {
      return tree_.joint_named(name) >= 0 ||
             std::ranges::find(chain_.joints, name, &Joint::name) != chain_.joints.end();
    };
    for (int i = 2; is_taken(); ++i) name = fmt::format("{}_{}", wish, i);
    return name;
  }

  /// The constraint that determines the joint; null where there is none.
  const MjcfJointConstraint* constraint_of(int joint) {
    const MjcfJointConstraint* found = nullptr;
    for (const MjcfJointConstraint& constraint : tree_.constraints) {
      if (constraint.joint != tree_.joints[joint].name) continue;
      if (found)
        report_error(fmt::format("joint \"{}\" is constrained by two equalities, in lines {} and {}", constraint.joint,
                                 found->line, constraint.line));
      found = &constraint;
    }
    return found;
  }

  /// Where the leader follows another joint itself, the factors multiply.
  Following following_of(int joint) {
    Following following{.leader = joint};
    std::set<int> seen;
    for (const MjcfJointConstraint* c = constraint_of(joint); c; c = constraint_of(following.leader)) {
      if (!seen.insert(following.leader).second) {
        report_error(fmt::format("joint \"{}\" follows itself by its equalities", tree_.joints[joint].name));
        return {};
      }
      if (std::any_of(c->polynomial.begin() + 2, c->polynomial.end(), [](double p) { return p != 0.0; }))
        report_error(
            fmt::format("joint \"{}\" follows joint \"{}\" by a polynomial of degree 2 or more (line {}): "
                        "expected a factor alone",
                        c->joint, c->other, c->line));
      following.offset += following.factor * c->polynomial[0];
      following.factor *= c->other.empty() ? 0.0 : c->polynomial[1];
      following.leader = following.factor == 0.0 ? -1 : tree_.joint_named(c->other);
      if (following.leader < 0) break;
    }
    return following;
  }

  void add_coupling(std::size_t index) {
    const int source = source_of_[index];
    if (source < 0 || chain_.joints[index].is_active || chain_.joints[index].type == JointType::fixed) return;
    const Following following = following_of(source);
    if (following.leader < 0) return;
    const int leader = add_with_ancestors(following.leader);
    if (leader < 0)
      return report_error(fmt::format("joint \"{}\" follows joint \"{}\", which is not below the base link",
                                      tree_.joints[source].name, tree_.joints[following.leader].name));
    chain_.joints[index].couplings = {{leader, following.factor}};
  }

  /// Adds the joint that leads, with its ancestors, even where it moves another branch; −1 where it is above the base.
  int add_with_ancestors(int joint) {
    const auto position = [&] { return std::ranges::find(source_of_, joint) - source_of_.begin(); };
    if (position() == std::ssize(source_of_)) {
      const auto path = bodies_down(tree_, base_, tree_.joints[joint].body);
      if (!path) return -1;
      for (const int body : *path)
        if (!attached_.contains(body)) add_body(body);
    }
    return position() == std::ssize(source_of_) ? -1 : static_cast<int>(position());
  }

  void report_impossible(const MjcfJoint& joint) {
    const bool is_free = joint.type == MjcfJointType::free;
    report_error(
        fmt::format("line {}: joint \"{}\" is a {} joint, which a chain cannot hold: expected hinge and slide "
                    "joints alone (--base-link \"{}\" begins the chain below it)",
                    joint.line, joint.name, is_free ? "free" : "ball", tree_.bodies[joint.body].name));
  }

  void report_error(const std::string& sentence) {
    if (first_error_.empty()) first_error_ = sentence;
  }

  const MjcfTree& tree_;
  const std::string& file_;
  int base_ = world;
  std::map<int, int> attached_;  ///< of each body that was added: the chain's joint that carries it
  std::vector<int> source_of_;   ///< of each of the chain's joints: the joint of the file; −1: fixed
  std::string first_error_;
  Chain chain_;
};

}  // namespace

Pose mjcf_attachment(const MjcfTree& tree, int body, int base) {
  if (body < 0 || body == base || tree.bodies[body].joints.empty()) return {};
  return shift(-tree.joints[tree.bodies[body].joints.back()].position);
}

Result<ChainEnds> mjcf_ends(const MjcfTree& tree, const std::string& name, const ChainEnds& ends) {
  ChainEnds found = ends;
  if (found.base_link.empty()) found.base_link = "world";
  const int base = tree.body_named(found.base_link);
  if (base < 0 && found.base_link != "world")
    return error("{}: the base link \"{}\" does not exist: expected the name of a body, or world", name,
                 found.base_link);
  if (found.tip_link.empty()) {
    const int tip = default_tip(tree, base);
    if (tip < 0) return error("{}: no body below the base link \"{}\"", name, found.base_link);
    found.tip_link = has_tool(tree, tip) ? tool_site : tree.bodies[tip].name;
  }
  if (tree.body_named(found.tip_link) < 0 && !tree.site_named(found.tip_link))
    return error("{}: the tip link \"{}\" does not exist: expected the name of a body or of a site", name,
                 found.tip_link);
  return found;
}

Result<Chain> parse_mjcf(const std::string& text, const std::string& name, const ChainEnds& ends) {
  KINFER_TRY(tree, parse_mjcf_tree(text, name));
  KINFER_TRY(found, mjcf_ends(tree, name, ends));
  return MjcfChainBuilder(tree, name).build(found);
}

}  // namespace kinfer

#include <tinyxml2.h>

#include <cmath>

#include "kinfer/io/digits.hpp"
#include "kinfer/io/joint_parts.hpp"
#include "kinfer/io/mjcf.hpp"

namespace kinfer {
namespace {

std::string list(const Vec3& values) {
  return fmt::format("{} {} {}", digits(values.x()), digits(values.y()), digits(values.z()));
}

std::string list(const Quat& q) {
  return fmt::format("{} {} {} {}", digits(q.w()), digits(q.x()), digits(q.y()), digits(q.z()));
}

/// A joint that follows another's reading.
struct Tie {
  std::string joint, leader;
  double factor = 1.0;
};

class Writer {
 public:
  explicit Writer(const Chain& chain) : chain_(chain) {}

  std::string write() {
    open("mujoco", {{"model", chain_.name.empty() ? "robot" : chain_.name}});
    // Every moving body needs a mass; where the chain knows none, the least that keeps the engine content.
    leaf("compiler", {{"angle", "radian"}, {"boundmass", "0.001"}, {"boundinertia", "0.001"}});
    leaf("option", {{"gravity", list(chain_.gravity)}});
    open("worldbody", {});
    open_body("base", chain_.base.pose());
    if (chain_.tip_joint() < 0) write_sites({});
    write_children(-1, {});
    close();
    close();
    write_ties();
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
    open("body", {{"name", name}, {"pos", list(pose.position)}, {"quat", list(Quat(pose.rotation))}});
  }

  /// `after`: from the parent's body to the parent's frame.
  void write_children(int parent, const Pose& after) {
    for (std::size_t i = 0; i < chain_.joints.size(); ++i)
      if (chain_.joints[i].parent == parent) write_joint(static_cast<int>(i), after);
  }

  void write_joint(int index, const Pose& after_parent) {
    const Joint& joint = chain_.joints[index];
    const JointParts parts = parts_of(joint.link);
    open_body("link_" + joint.name, after_parent * parts.before);
    if (joint.type != JointType::fixed) write_motion(index, parts.axis);
    for (const PointMass& mass : chain_.masses)
      if (mass.joint == index)
        leaf("geom", {{"type", "sphere"},
                      {"size", "0.01"},
                      {"pos", list(parts.after * mass.com)},
                      {"mass", digits(mass.mass)},
                      {"contype", "0"},
                      {"conaffinity", "0"}});
    leaf("site",
         {{"name", joint.name}, {"pos", list(parts.after.position)}, {"quat", list(Quat(parts.after.rotation))}});
    if (index == chain_.tip_joint()) write_sites(parts.after);
    write_children(index, parts.after);
    close();
  }

  void write_motion(int index, const Vec3& axis) {
    const Joint& joint = chain_.joints[index];
    if (joint.has_reading) add_joint(joint.name, joint, axis, true);
    for (const Follower& follower : followers(chain_, index)) {
      const std::string name = joint.name + "_follows_" + follower.joint;
      add_joint(name, joint, axis, false);
      ties_.push_back({name, follower.joint, follower.multiplier});
    }
  }

  void add_joint(const std::string& name, const Joint& joint, const Vec3& axis, bool may_be_limited) {
    open("joint",
         {{"name", name}, {"type", joint.type == JointType::prismatic ? "slide" : "hinge"}, {"axis", list(axis)}});
    if (may_be_limited && std::isfinite(joint.lower) && std::isfinite(joint.upper)) {
      printer_.PushAttribute("limited", "true");
      printer_.PushAttribute("range", fmt::format("{} {}", digits(joint.lower), digits(joint.upper)).c_str());
    }
    close();
  }

  void write_sites(const Pose& flange) {
    const Pose tool = flange * chain_.tool.pose();
    leaf("site", {{"name", "tool"}, {"pos", list(tool.position)}, {"quat", list(Quat(tool.rotation))}});
    for (const Target& target : chain_.targets) leaf("site", {{"name", target.name}, {"pos", list(tool * target.xyz)}});
  }

  void write_ties() {
    if (ties_.empty()) return;
    open("equality", {});
    for (const Tie& tie : ties_)
      leaf(
          "joint",
          {{"joint1", tie.joint}, {"joint2", tie.leader}, {"polycoef", fmt::format("0 {} 0 0 0", digits(tie.factor))}});
    close();
  }

  const Chain& chain_;
  tinyxml2::XMLPrinter printer_;
  std::vector<Tie> ties_;
};

}  // namespace

std::string mjcf(const Chain& chain) {
  return Writer(chain).write();
}

}  // namespace kinfer

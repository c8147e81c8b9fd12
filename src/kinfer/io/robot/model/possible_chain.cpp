// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/model/possible_chain.hpp"

#include <fmt/format.h>

#include <cmath>

#include "kinfer/io/text/possible_range.hpp"

namespace kinfer {
namespace {

/// Keeps the first number that cannot be.
class Examination {
 public:
  void number(std::string_view key, double value, const PossibleRange& range) {
    if (found_) return;
    if (const auto what = impossible(value, range)) found_ = fmt::format("{}: {}", key, *what);
  }
  void point(std::string_view key, const Vec3& xyz) {
    for (const double value : xyz) number(key, value, possible::length);
  }
  void frame(std::string_view key, const Frame& frame) {
    point(key, frame.xyz);
    for (const double value : frame.rotation.reshaped()) number(key, value, possible::angle);
    for (const double value : frame.small_rotation) number(key, value, possible::angle);
  }
  void complain(std::string sentence) {
    if (!found_) found_ = std::move(sentence);
  }
  const std::optional<std::string>& found() const { return found_; }

 private:
  std::optional<std::string> found_;
};

void examine(Examination& all, const DhNumbers& row) {
  all.number("a", row.a, possible::length), all.number("d", row.d, possible::length);
  all.number("alpha", row.alpha, possible::angle), all.number("theta", row.theta, possible::angle);
  all.number("beta", row.beta, possible::angle);
}

void examine(Examination& all, const UrdfLink& link) {
  all.frame("origin", link.origin);
  if (!(std::abs(link.axis.norm() - 1.0) < 1e-6)) all.complain("axis: expected a direction");
}

void examine(Examination& all, const Vec3& fixture) {
  all.point("anchors", fixture);
}
void examine(Examination& all, const Target& fixture) {
  all.point(fixture.name, fixture.xyz);
}
void examine(Examination& all, const Plane& fixture) {
  all.number(fixture.name, fixture.offset, possible::length);
}
void examine(Examination& all, const NamedFrame& fixture) {
  all.frame(fixture.name, fixture.frame);
}

}  // namespace

std::optional<std::string> impossible_number(const Joint& joint) {
  Examination all;
  std::visit([&](const auto& link) { examine(all, link); }, joint.link);
  all.number("gain", joint.gain, possible::ratio);
  for (const Coupling& coupling : joint.couplings) all.number("coupling", coupling.factor, possible::ratio);
  all.number("compliance", joint.compliance, possible::compliance);
  all.number("torque_compliance", joint.torque_compliance, possible::compliance);
  all.number("backlash", joint.backlash, rotates(joint.type) ? possible::angle : possible::length);
  for (const Harmonic& harmonic : joint.harmonics) {
    all.number("harmonics", harmonic.order, possible::harmonic_order);
    all.number("harmonics", harmonic.sine, possible::angle), all.number("harmonics", harmonic.cosine, possible::angle);
  }
  for (const double limit : {joint.lower, joint.upper})
    if (std::isfinite(limit)) all.number("limits", limit, rotates(joint.type) ? possible::angle : possible::length);
  if (!(joint.lower <= joint.upper)) all.complain("limits: expected the lower one first");
  return all.found();
}

std::optional<std::string> impossible_model(const Chain& chain) {
  Examination all;
  all.frame("base", chain.base), all.frame("tool", chain.tool);
  for (const double value : chain.gravity) all.number("gravity", value, possible::gravity);
  for (const Joint& joint : chain.joints)
    if (const auto what = impossible_number(joint)) all.complain(fmt::format("joint \"{}\": {}", joint.name, *what));
  for (const Target& target : chain.targets) examine(all, target);
  for (const PointMass& mass : chain.masses) all.number("mass", mass.mass, possible::mass), all.point("com", mass.com);
  for (const LoopClosure& closure : chain.closures)
    all.point(closure.name, closure.point_in_first), all.point(closure.name, closure.point_in_second);
  for (const RobotMounting& mounting : chain.mountings) {
    all.frame(mounting.name, mounting.tool);
    if (mounting.base) all.frame(mounting.name, *mounting.base);
  }
  all.number("expansion", chain.expansion, possible::expansion);
  all.number("reference_temperature", chain.reference_temperature, possible::temperature);
  for_each_fixture_list(chain.fixtures, [&](const auto&, const auto& list) {
    for (const auto& fixture : list) examine(all, fixture);
  });
  if (dof(chain) == 0) all.complain("the robot has no joint that moves");
  return all.found();
}

}  // namespace kinfer

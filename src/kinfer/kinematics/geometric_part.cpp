// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/geometric_part.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer {
namespace {

constexpr std::array all_kinds{NonGeometricKind::gain,       NonGeometricKind::coupling,
                               NonGeometricKind::compliance, NonGeometricKind::torque_compliance,
                               NonGeometricKind::backlash,   NonGeometricKind::harmonics,
                               NonGeometricKind::expansion,  NonGeometricKind::field};

/// Gives the joint one kind of numbers of another joint; returns whether they differed.
bool take(Joint& joint, const Joint& from, NonGeometricKind kind) {
  const auto assign = [](auto& value, const auto& other, auto same) {
    const bool differs = !same(value, other);
    value = other;
    return differs;
  };
  const auto equal = [](double a, double b) { return a == b; };
  const auto lists = [](auto fields) {
    return [fields](const auto& a, const auto& b) { return std::ranges::equal(a, b, {}, fields, fields); };
  };
  switch (kind) {
    case NonGeometricKind::gain:
      return assign(joint.gain, from.gain, equal);
    case NonGeometricKind::coupling:
      return assign(joint.couplings, from.couplings,
                    lists([](const Coupling& c) { return std::pair(c.joint, c.factor); }));
    case NonGeometricKind::compliance:
      return assign(joint.compliance, from.compliance, equal);
    case NonGeometricKind::torque_compliance:
      return assign(joint.torque_compliance, from.torque_compliance, equal);
    case NonGeometricKind::backlash:
      return assign(joint.backlash, from.backlash, equal);
    case NonGeometricKind::harmonics:
      return assign(joint.harmonics, from.harmonics,
                    lists([](const Harmonic& h) { return std::tuple(h.order, h.sine, h.cosine); }));
    case NonGeometricKind::expansion:
    case NonGeometricKind::field:
      break;
  }
  return false;
}

bool same(const DisplacementField& a, const DisplacementField& b) {
  return a.points.cols() == b.points.cols() && a.points == b.points && a.length == b.length &&
         a.coefficients == b.coefficients;
}

struct Distance {
  double rms = 0.0, max = 0.0;
};

Distance tool_distance(const Chain& a, const Chain& b, const MatrixXd& q) {
  const std::vector<double> approach(static_cast<std::size_t>(q.rows()), 1.0);
  Distance distance;
  for (Eigen::Index i = 0; i < q.cols(); ++i) {
    const Load load{.approach = approach};
    const double d = (forward(a, q.col(i), load).position - forward(b, q.col(i), load).position).norm();
    distance.max = std::max(distance.max, d);
    distance.rms += d * d / static_cast<double>(q.cols());
  }
  distance.rms = std::sqrt(distance.rms);
  return distance;
}

}  // namespace

std::string_view name(NonGeometricKind kind) {
  constexpr std::string_view names[] = {"gain",     "coupling",  "compliance", "torque_compliance",
                                        "backlash", "harmonics", "expansion",  "field"};
  return names[static_cast<std::size_t>(kind)];
}

GeometricPart geometric_part(const Chain& corrected, const Chain& reference, const MatrixXd& q) {
  KINFER_EXPECT(corrected.joints.size() == reference.joints.size(), "{} and {} joints", corrected.joints.size(),
                reference.joints.size());
  GeometricPart part{.chain = corrected, .differences = {}};
  for (const NonGeometricKind kind : all_kinds) {
    Chain without = corrected;
    NonGeometricDifference difference{.kind = kind};
    for (std::size_t j = 0; j < corrected.joints.size(); ++j) {
      take(part.chain.joints[j], reference.joints[j], kind);
      if (take(without.joints[j], reference.joints[j], kind)) ++difference.joints;
    }
    const bool expands = kind == NonGeometricKind::expansion && corrected.expansion != reference.expansion;
    const bool has_field = kind == NonGeometricKind::field && !same(corrected.field, reference.field);
    if (difference.joints == 0 && !expands && !has_field) continue;
    if (has_field) without.field = reference.field;
    difference.depends_on_load = expands || kind == NonGeometricKind::torque_compliance;
    const Distance distance = tool_distance(corrected, without, q);
    difference.rms = distance.rms, difference.max = distance.max;
    part.differences.push_back(difference);
  }
  part.chain.expansion = reference.expansion, part.chain.field = reference.field;
  if (part.differences.empty()) return part;
  const Distance distance = tool_distance(corrected, part.chain, q);
  part.rms = distance.rms, part.max = distance.max;
  return part;
}

}  // namespace kinfer

#include "studies/paper1/truth_errors.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer::study {
namespace {

/// What is left of `error` across the directions, which need not be orthogonal.
double left_across(Vec3 error, const Vec3& axis, const std::vector<Vec3>& hidden) {
  std::vector<Vec3> basis;
  const auto add = [&](Vec3 direction) {
    for (const Vec3& b : basis) direction -= b * b.dot(direction);
    if (direction.norm() > 1e-3) basis.push_back(direction.normalized());
  };
  add(axis);
  for (const Vec3& direction : hidden) add(direction);
  for (const Vec3& b : basis) error -= b * b.dot(error);
  return error.norm();
}

double axis_angle(const Vec3& a, const Vec3& b) {
  return std::asin(std::min(1.0, a.cross(b).norm()));
}

/// The turn about the body's incoming axis that brings the found outgoing axis nearest to the true one.
double best_turn(const JointTruth& incoming, const JointTruth& outgoing, const FoundJoint& found) {
  const Vec3 n = incoming.axis_in_child;
  const auto across = [&](const Vec3& v) { return Vec3(v - n * n.dot(v)); };
  Vec3 is = found.axis_in_parent, ought = outgoing.axis_in_parent;
  if (is.dot(ought) < 0.0) is = -is;
  if (across(ought).norm() < 0.2) {
    is = found.point_in_parent - incoming.point_in_child;
    ought = outgoing.point_in_parent - incoming.point_in_child;
  }
  is = across(is), ought = across(ought);
  return std::atan2(n.dot(is.cross(ought)), is.dot(ought));
}

}  // namespace

GeometryErrors geometry_errors(const std::vector<FoundJoint>& found, const MachineTruth& truth) {
  GeometryErrors errors;
  for (const FoundJoint& joint : found) {
    if (joint.type == FoundJointType::rigid) continue;
    const auto is_it = [&](const JointTruth& t) { return t.parent == joint.parent && t.child == joint.child; };
    const auto t = std::ranges::find_if(truth.joints, is_it);
    if (t == truth.joints.end()) return {1e3, 1e3, 1e3};
    Vec3 axis = joint.axis_in_parent, point = joint.point_in_parent;
    const auto incoming = std::ranges::find(truth.joints, joint.parent, &JointTruth::child);
    if (incoming != truth.joints.end() && t->hidden_in_parent.size() == 1) {
      const double turn = best_turn(*incoming, *t, joint);
      const Mat3 r = exp_so3(turn * incoming->axis_in_child);
      axis = r * axis;
      point = incoming->point_in_child + r * (point - incoming->point_in_child);
      errors.azimuth = std::max(errors.azimuth, std::abs(turn));
    }
    errors.direction = std::max(
        {errors.direction, axis_angle(axis, t->axis_in_parent), axis_angle(joint.axis_in_child, t->axis_in_child)});
    errors.line =
        std::max({errors.line, left_across(point - t->point_in_parent, t->axis_in_parent, t->hidden_in_parent),
                  left_across(joint.point_in_child - t->point_in_child, t->axis_in_child, t->hidden_in_child)});
  }
  return errors;
}

}  // namespace kinfer::study

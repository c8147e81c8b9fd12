// SPDX-License-Identifier: Apache-2.0
#include "kinfer/motion/joint_path.hpp"

#include <algorithm>

#include "kinfer/base/expect.hpp"
#include "kinfer/motion/corners.hpp"
#include "kinfer/motion/thresholds.hpp"

namespace kinfer::motion {
namespace {

using Eigen::Index;

}  // namespace

JointPath::JointPath(const MatrixXd& waypoints, const std::vector<MotionLimits>& limits,
                     const JointPathOptions& options)
    : end_(waypoints.col(waypoints.cols() - 1)) {
  KINFER_EXPECT(waypoints.cols() > 0 && static_cast<std::size_t>(waypoints.rows()) == limits.size(),
                "{} limits for {} joints", limits.size(), waypoints.rows());
  const auto moves = [&](Index line) {
    return (waypoints.col(line + 1) - waypoints.col(line)).cwiseAbs().maxCoeff() > thresholds::least_move;
  };
  const VectorXd units = options.cut_units.size() == 0 ? VectorXd::Ones(waypoints.rows()) : options.cut_units;
  const bool blends = !options.stop_at_waypoints && options.most_cut >= thresholds::least_cut;
  Index first = 0;
  cuts_.assign(1, 0.0), passing_times_.assign(1, 0.0);
  while (first + 1 < waypoints.cols()) {
    if (!moves(first)) {
      passing_times_.push_back(duration_), cuts_.push_back(0.0), ++first;
      continue;
    }
    Index last = first + 1;
    while (blends && last + 1 < waypoints.cols() && moves(last)) ++last;
    append(waypoints.middleCols(first, last - first + 1), limits, options.most_cut, units);
    first = last;
  }
}

void JointPath::append(const MatrixXd& waypoints, const std::vector<MotionLimits>& limits, double most_cut,
                       const VectorXd& units) {
  const std::vector<Corner> corners = quickest_corners(waypoints, limits, most_cut, units);
  const auto way = [&](Index line) -> VectorXd { return waypoints.col(line + 1) - waypoints.col(line); };
  const auto add = [&](Ramp ramp) {
    ramp.begin = duration_, duration_ += ramp.shape.duration();
    ramps_.push_back(std::move(ramp));
  };
  for (Index k = 0; k + 1 < waypoints.cols(); ++k) {
    const Corner &corner = corners[static_cast<std::size_t>(k)], &next = corners[static_cast<std::size_t>(k) + 1];
    const VectorXd line = way(k);
    const MotionLimits along = limits_along(line, limits);
    const LineProfile profile = profile_between(corner, next, along);
    const SRamp up = fastest_ramp(profile.peak - corner.after, along);
    const SRamp down = fastest_ramp(profile.peak - next.before, along);
    const double half = 0.5 * next.ramp.duration();
    const double braking = 0.5 * down.duration() * (profile.peak + next.before);
    add({.from = waypoints.col(k) + 0.5 * corner.ramp.duration() * corner.after * line,
         .before = corner.after * line,
         .change = (profile.peak - corner.after) * line,
         .after = profile.peak * line,
         .shape = up});
    duration_ += profile.cruise;
    add({.from = waypoints.col(k + 1) - (half * next.before + braking) * line,
         .before = profile.peak * line,
         .change = (next.before - profile.peak) * line,
         .after = next.before * line,
         .shape = down});
    passing_times_.push_back(duration_ + half);
    cuts_.push_back(next.cut < thresholds::least_cut ? 0.0 : next.cut);
    if (next.before > 0.0)
      add({.from = waypoints.col(k + 1) - half * next.before * line,
           .before = next.before * line,
           .change = change_of_velocity(next, line, way(k + 1)),
           .after = next.after * way(k + 1),
           .shape = next.ramp});
  }
}

PathState JointPath::at(double t) const {
  const Index n = end_.size();
  PathState state{end_, VectorXd::Zero(n), VectorXd::Zero(n), VectorXd::Zero(n)};
  if (ramps_.empty() || t >= duration_) return state;
  const auto later = std::upper_bound(ramps_.begin(), ramps_.end(), std::max(t, 0.0),
                                      [](double time, const Ramp& ramp) { return time < ramp.begin; });
  const Ramp& ramp = later == ramps_.begin() ? ramps_.front() : *(later - 1);
  const double since = std::max(t, 0.0) - ramp.begin, length = ramp.shape.duration();
  if (since >= length) {
    state.position = ramp.from + length * ramp.before + 0.5 * length * ramp.change + (since - length) * ramp.after;
    state.velocity = ramp.after;
    return state;
  }
  const RampState shape = ramp.shape.at(since);
  state.position = ramp.from + since * ramp.before + shape.position * length * ramp.change;
  state.velocity = ramp.before + shape.speed * ramp.change;
  state.acceleration = shape.acceleration * ramp.change;
  state.jerk = shape.jerk * ramp.change;
  return state;
}

}  // namespace kinfer::motion

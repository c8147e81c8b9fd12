// SPDX-License-Identifier: Apache-2.0
#include "kinfer/motion/joint_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/base/expect.hpp"
#include "kinfer/motion/thresholds.hpp"

namespace kinfer::motion {
namespace {

using Eigen::Index;

/// The fastest ramp by which every joint keeps its limits.
SRamp ramp_between(const VectorXd& before, const VectorXd& after, const std::vector<MotionLimits>& limits) {
  double acceleration = std::numeric_limits<double>::infinity(), jerk = acceleration;
  for (Index k = 0; k < before.size(); ++k) {
    const double change = std::abs(after[k] - before[k]);
    if (change == 0.0) continue;
    acceleration = std::min(acceleration, limits[static_cast<std::size_t>(k)].acceleration / change);
    jerk = std::min(jerk, limits[static_cast<std::size_t>(k)].jerk / change);
  }
  return std::isfinite(jerk) ? SRamp(acceleration, jerk) : SRamp();
}

/// Lines between two stops, with the speed of each.
class Stretch {
 public:
  Stretch(MatrixXd waypoints, const std::vector<MotionLimits>& limits, double most_cut)
      : waypoints_(std::move(waypoints)), limits_(limits), most_cut_(most_cut) {
    for (Index line = 0; line < lines(); ++line) speeds_.push_back(fastest(line));
    slow_down();
  }

  Index lines() const { return waypoints_.cols() - 1; }
  const MatrixXd& waypoints() const { return waypoints_; }
  double time_of(Index line) const { return 1.0 / speeds_[static_cast<std::size_t>(line)]; }

  /// At rest before the first line and after the last.
  VectorXd velocity(Index line) const {
    if (line < 0 || line >= lines()) return VectorXd::Zero(waypoints_.rows());
    return speeds_[static_cast<std::size_t>(line)] * delta(line);
  }
  SRamp ramp(Index waypoint) const { return ramp_between(velocity(waypoint - 1), velocity(waypoint), limits_); }

  /// By how much the corner is cut.
  double cut(Index waypoint) const {
    if (waypoint == 0 || waypoint == lines()) return 0.0;
    const SRamp shape = ramp(waypoint);
    const double part = shape.at(0.5 * shape.duration()).position * shape.duration();
    return part * (velocity(waypoint) - velocity(waypoint - 1)).cwiseAbs().maxCoeff();
  }

 private:
  VectorXd delta(Index line) const { return waypoints_.col(line + 1) - waypoints_.col(line); }

  double fastest(Index line) const {
    double speed = std::numeric_limits<double>::infinity();
    const VectorXd way = delta(line);
    for (Index k = 0; k < way.size(); ++k)
      if (way[k] != 0.0) speed = std::min(speed, limits_[static_cast<std::size_t>(k)].velocity / std::abs(way[k]));
    return speed;
  }

  /// The ramps at its ends do not overlap.
  bool fits(Index line) const { return time_of(line) >= 0.5 * (ramp(line).duration() + ramp(line + 1).duration()); }

  /// Lowers speeds, from the fastest that the joints allow, until all ramps fit and no corner is cut too much.
  void slow_down() {
    bool changed = true;
    for (int sweep = 0; changed; ++sweep) {
      changed = false;
      if (sweep == thresholds::speed_sweeps)  // a slower path has room for its ramps: that ends it
        for (double& speed : speeds_) speed *= 0.5, changed = true;
      if (sweep == thresholds::speed_sweeps) sweep = 0;
      for (Index line = 0; line < lines(); ++line)
        if (!fits(line)) reduce({line}, [&] { return fits(line); }), changed = true;
      for (Index waypoint = 1; waypoint < lines(); ++waypoint)
        if (cut(waypoint) > most_cut_ * (1.0 + 1e-12))
          reduce({waypoint - 1, waypoint}, [&] { return cut(waypoint) <= most_cut_; }), changed = true;
    }
  }

  /// Multiplies the speeds of these lines by the largest factor below 1 found with which the condition holds.
  template <class Condition>
  void reduce(std::initializer_list<Index> which, Condition holds) {
    const std::vector<double> before = speeds_;
    const auto set = [&](double factor) {
      for (const Index line : which)
        speeds_[static_cast<std::size_t>(line)] = factor * before[static_cast<std::size_t>(line)];
    };
    double low = 1.0, high = 1.0;
    do high = low, low *= 0.5, set(low);
    while (!holds());
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      set(middle);
      (holds() ? low : high) = middle;
    }
    set(low);
  }

  MatrixXd waypoints_;
  const std::vector<MotionLimits>& limits_;
  double most_cut_;
  std::vector<double> speeds_;  // of each line [1/s]
};

}  // namespace

JointPath::JointPath(const MatrixXd& waypoints, const std::vector<MotionLimits>& limits,
                     const JointPathOptions& options)
    : end_(waypoints.col(waypoints.cols() - 1)) {
  KINFER_EXPECT(waypoints.cols() > 0 && static_cast<std::size_t>(waypoints.rows()) == limits.size(),
                "{} limits for {} joints", limits.size(), waypoints.rows());
  const auto moves = [&](Index line) { return waypoints.col(line) != waypoints.col(line + 1); };
  Index first = 0;
  cuts_.assign(1, 0.0), passing_times_.assign(1, 0.0);
  while (first + 1 < waypoints.cols()) {
    if (!moves(first)) {
      passing_times_.push_back(duration_), cuts_.push_back(0.0), ++first;
      continue;
    }
    Index last = first + 1;
    while (!options.stop_at_waypoints && last + 1 < waypoints.cols() && moves(last)) ++last;
    const Stretch stretch(waypoints.middleCols(first, last - first + 1), limits, options.most_cut);
    double passing = duration_ + 0.5 * stretch.ramp(0).duration();
    for (Index w = 0; w <= stretch.lines(); ++w) {
      const VectorXd before = stretch.velocity(w - 1), after = stretch.velocity(w);
      const SRamp shape = stretch.ramp(w);
      const double half = 0.5 * shape.duration();
      ramps_.push_back({passing - half, stretch.waypoints().col(w) - half * before, before, after, shape});
      if (w > 0) passing_times_.push_back(passing), cuts_.push_back(stretch.cut(w));
      if (w == stretch.lines()) passing_times_.back() = duration_ = passing + half;
      if (w < stretch.lines()) passing += stretch.time_of(w);
    }
    first = last;
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
  const VectorXd change = ramp.after - ramp.before;
  if (since >= length) {
    state.position = ramp.from + length * ramp.before + 0.5 * length * change + (since - length) * ramp.after;
    state.velocity = ramp.after;
    return state;
  }
  const RampState shape = ramp.shape.at(since);
  state.position = ramp.from + since * ramp.before + shape.position * length * change;
  state.velocity = ramp.before + shape.speed * change;
  state.acceleration = shape.acceleration * change;
  state.jerk = shape.jerk * change;
  return state;
}

}  // namespace kinfer::motion

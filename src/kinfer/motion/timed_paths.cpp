// SPDX-License-Identifier: Apache-2.0
#include "kinfer/motion/timed_paths.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/motion/thresholds.hpp"

namespace kinfer::motion {
namespace {

using Eigen::Index;

/// Known before the work: its time and memory grow with the samples.
Result<void> check_samples(double duration, double step, double most) {
  const double samples = std::floor(duration / step) + 2.0;
  if (samples <= most) return {};
  const std::string rows = samples < 1e15 ? fmt::format("{:.0f}", samples) : fmt::format("{:.3g}", samples);
  return error("the path would take {:.4g} s: {} rows, one every {:.4g} ms, and at most {:.0f} are written", duration,
               rows, 1e3 * step, most);
}

std::vector<double> sample_times(double duration, double step) {
  KINFER_EXPECT(step > 0.0, "a step of {} s", step);
  std::vector<double> times;
  for (Index k = 0; static_cast<double>(k) * step < duration; ++k) times.push_back(static_cast<double>(k) * step);
  times.push_back(duration);
  return times;
}

void resize(TimedPath& path, Index joints) {
  const auto samples = static_cast<Index>(path.time.size());
  path.position.resize(joints, samples), path.velocity.resize(joints, samples);
  path.acceleration.resize(joints, samples);
}

int line_at(const std::vector<double>& passing, double time) {
  const auto later = std::upper_bound(passing.begin(), passing.end(), time);
  return static_cast<int>(
      std::clamp<std::ptrdiff_t>(later - passing.begin() - 1, 0, std::max<std::ptrdiff_t>(std::ssize(passing) - 2, 0)));
}

/// The first sample at which a joint is outside its limits.
std::optional<PathObstacle> outside_limits(const Chain& chain, const TimedPath& path) {
  const std::vector<int> joints = active_joints(chain);
  for (Index i = 0; i < path.position.cols(); ++i)
    for (Index k = 0; k < path.position.rows(); ++k) {
      const Joint& joint = chain.joints[static_cast<std::size_t>(joints[static_cast<std::size_t>(k)])];
      const double q = path.position(k, i), time = path.time[static_cast<std::size_t>(i)];
      if (q < joint.lower || q > joint.upper)
        return PathObstacle{PathObstacle::Kind::outside_limits, time, line_at(path.passing_times, time),
                            static_cast<int>(k)};
    }
  return std::nullopt;
}

/// Angle by which the orientation changes between two targets [rad].
double turn_between(const OrientationGoal& from, const OrientationGoal& to) {
  if (const auto* a = std::get_if<FullGoal>(&from)) return angle_between(a->rotation, std::get<FullGoal>(to).rotation);
  if (const auto* a = std::get_if<AxisGoal>(&from))
    return std::acos(std::clamp(a->direction.dot(std::get<AxisGoal>(to).direction), -1.0, 1.0));
  if (const auto* a = std::get_if<PitchGoal>(&from)) return std::abs(std::get<PitchGoal>(to).angle - a->angle);
  return 0.0;
}

/// Of one line: what its length and its turn allow.
MotionLimits limits_of_line(const ReachTarget& from, const ReachTarget& to, const ToolPathOptions& options) {
  const double length = (to.position - from.position).norm(), turn = turn_between(from.orientation, to.orientation);
  const auto least = [&](double by_length, double by_turn) {
    return std::min(length > 0.0 ? by_length / length : 1e9, turn > 0.0 ? by_turn / turn : 1e9);
  };
  return {least(options.translation.velocity, options.rotation.velocity),
          least(options.translation.acceleration, options.rotation.acceleration),
          least(options.translation.jerk, options.rotation.jerk)};
}

/// Derivatives of a row of samples at equal distances `h`, of the first three orders, at the largest.
struct LargestDerivatives {
  VectorXd first, second, third;  // of each joint
};

LargestDerivatives largest_derivatives(const MatrixXd& q, double h) {
  LargestDerivatives largest{VectorXd::Zero(q.rows()), VectorXd::Zero(q.rows()), VectorXd::Zero(q.rows())};
  for (Index i = 2; i + 2 < q.cols(); ++i) {
    const VectorXd first = (q.col(i + 1) - q.col(i - 1)) / (2.0 * h);
    const VectorXd second = (q.col(i + 1) - 2.0 * q.col(i) + q.col(i - 1)) / (h * h);
    const VectorXd third = (q.col(i + 2) - 2.0 * q.col(i + 1) + 2.0 * q.col(i - 1) - q.col(i - 2)) / (2.0 * h * h * h);
    largest.first = largest.first.cwiseMax(first.cwiseAbs());
    largest.second = largest.second.cwiseMax(second.cwiseAbs());
    largest.third = largest.third.cwiseMax(third.cwiseAbs());
  }
  return largest;
}

/// By how much the path has to be slowed down; at least 1.
double slow_down(const MatrixXd& q, double h, const std::vector<MotionLimits>& limits) {
  const LargestDerivatives largest = largest_derivatives(q, h);
  double factor = 1.0;
  for (Index k = 0; k < q.rows(); ++k) {
    const MotionLimits& limit = limits[static_cast<std::size_t>(k)];
    factor = std::max({factor, largest.first[k] / limit.velocity, std::sqrt(largest.second[k] / limit.acceleration),
                       std::cbrt(largest.third[k] / limit.jerk)});
  }
  return factor > 1.0 ? factor * thresholds::slow_down_margin : 1.0;
}

bool is_singular(const Chain& chain, const VectorXd& q, double length, bool directs_orientation) {
  Twists twists = jacobian(chain, q);
  twists.topRows<3>() /= length;
  const VectorXd s = svd(directs_orientation ? MatrixXd(twists) : MatrixXd(twists.topRows<3>())).s;
  return s[s.size() - 1] < thresholds::singular_path * s[0];
}

}  // namespace

Result<PathResult> joint_space_path(const Chain& chain, const MatrixXd& waypoints,
                                    const std::vector<MotionLimits>& limits, const JointPathOptions& options,
                                    double step) {
  const JointPath planned(waypoints, limits, options);
  if (auto checked = check_samples(planned.duration(), step, thresholds::most_samples); !checked)
    return forward_error(checked.error());
  PathResult result;
  TimedPath& path = result.path;
  path.duration = planned.duration(), path.cuts = planned.cuts(), path.passing_times = planned.passing_times();
  path.time = sample_times(path.duration, step);
  resize(path, waypoints.rows());
  for (std::size_t i = 0; i < path.time.size(); ++i) {
    const PathState state = planned.at(path.time[i]);
    const auto column = static_cast<Index>(i);
    path.position.col(column) = state.position, path.velocity.col(column) = state.velocity;
    path.acceleration.col(column) = state.acceleration;
  }
  result.obstacle = outside_limits(chain, path);
  return result;
}

ReachTarget interpolate(const ReachTarget& from, const ReachTarget& to, double s) {
  ReachTarget target{from.position + s * (to.position - from.position), from.orientation};
  if (auto* goal = std::get_if<FullGoal>(&target.orientation)) {
    const Mat3& last = std::get<FullGoal>(to.orientation).rotation;
    goal->rotation = exp_so3(s * log_so3(last * goal->rotation.transpose())) * goal->rotation;
  } else if (auto* axis = std::get_if<AxisGoal>(&target.orientation)) {
    const Vec3 last = std::get<AxisGoal>(to.orientation).direction;
    const Vec3 normal = axis->direction.cross(last);
    const double angle = std::atan2(normal.norm(), axis->direction.dot(last));
    if (normal.norm() > 1e-12) axis->direction = exp_so3(s * angle * normal.normalized()) * axis->direction;
  } else if (auto* pitch = std::get_if<PitchGoal>(&target.orientation)) {
    pitch->angle += s * (std::get<PitchGoal>(to.orientation).angle - pitch->angle);
  }
  return target;
}

namespace {

/// Lines of the tool between targets, each a motion of one coordinate from 0 to 1, and the postures along them.
class ToolLines {
 public:
  ToolLines(const Chain& chain, const std::vector<ReachTarget>& targets, const ToolPathOptions& options)
      : chain_(chain),
        targets_(targets),
        solver_(chain, options.reach),
        length_(std::max(1e-3, (targets.front().position - chain.base.xyz).norm())) {
    MatrixXd way(1, 2);
    way << 0.0, 1.0;
    for (std::size_t k = 0; k + 1 < targets.size(); ++k) {
      lines_.emplace_back(way, std::vector{limits_of_line(targets[k], targets[k + 1], options)});
      passing_.push_back(passing_.back() + lines_.back().duration());
    }
  }

  double duration() const { return passing_.back(); }
  const std::vector<double>& passing_times() const { return passing_; }
  const std::optional<PathObstacle>& obstacle() const { return obstacle_; }

  /// Postures at these times, each near the one before it, before the first at which the tool cannot follow its line:
  /// beyond the reach every posture would be searched for in vain.
  MatrixXd follow(const std::vector<double>& times, const VectorXd& preferred) {
    MatrixXd q(preferred.size(), static_cast<Index>(times.size()));
    VectorXd before = preferred;
    for (std::size_t i = 0; i < times.size(); ++i) {
      const ReachSolution found = solver_.solve(target_at(times[i]), before);
      const VectorXd& posture = found.postures.front().q;
      const bool jumps = i > 0 && (posture - before).cwiseAbs().maxCoeff() > thresholds::path_jump;
      if (!obstacle_) obstacle_ = obstacle_at(times[i], found, jumps);
      if (!is_on_line(found) || jumps) return q.leftCols(static_cast<Index>(i));
      q.col(static_cast<Index>(i)) = before = posture;
    }
    return q;
  }

 private:
  ReachTarget target_at(double time) const {
    if (lines_.empty()) return targets_.front();
    const auto k = static_cast<std::size_t>(line_at(passing_, time));
    return interpolate(targets_[k], targets_[k + 1], lines_[k].at(time - passing_[k]).position[0]);
  }

  static bool is_on_line(const ReachSolution& found) { return found.status == ReachStatus::reached; }

  std::optional<PathObstacle> obstacle_at(double time, const ReachSolution& found, bool jumps) const {
    const int line = line_at(passing_, time);
    if (found.status == ReachStatus::outside_limits)
      return PathObstacle{PathObstacle::Kind::outside_limits, time, line, found.limited_joints.front()};
    if (!is_on_line(found) || jumps) return PathObstacle{PathObstacle::Kind::not_reached, time, line, -1};
    const bool directs = std::holds_alternative<FullGoal>(targets_.front().orientation);
    if (is_singular(chain_, found.postures.front().q, length_, directs))
      return PathObstacle{PathObstacle::Kind::near_singular, time, line, -1};
    return std::nullopt;
  }

  const Chain& chain_;
  const std::vector<ReachTarget>& targets_;
  ReachSolver solver_;
  double length_;
  std::vector<JointPath> lines_;
  std::vector<double> passing_{0.0};
  std::optional<PathObstacle> obstacle_;
};

/// Central differences; at rest at both ends.
void set_derivatives(TimedPath& path) {
  const Index samples = path.position.cols();
  path.velocity = path.acceleration = MatrixXd::Zero(path.position.rows(), samples);
  for (Index i = 1; i + 1 < samples; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double before = path.time[k] - path.time[k - 1], after = path.time[k + 1] - path.time[k];
    const VectorXd from = (path.position.col(i) - path.position.col(i - 1)) / before,
                   to = (path.position.col(i + 1) - path.position.col(i)) / after;
    path.velocity.col(i) = (after * from + before * to) / (before + after);
    path.acceleration.col(i) = 2.0 * (to - from) / (before + after);
  }
}

}  // namespace

Result<PathResult> tool_space_path(const Chain& chain, const std::vector<ReachTarget>& targets,
                                   const VectorXd& preferred, const std::vector<MotionLimits>& limits,
                                   const ToolPathOptions& options, double step) {
  KINFER_EXPECT(!targets.empty(), "a path needs targets");
  ToolLines lines(chain, targets, options);
  if (auto checked = check_samples(lines.duration(), step, thresholds::most_tool_samples); !checked)
    return forward_error(checked.error());
  PathResult result;
  TimedPath& path = result.path;
  // The factor comes from fine steps of the unhurried time; the samples are taken once it is known.
  const double fine = std::max(lines.duration() / thresholds::most_path_steps, thresholds::path_step);
  const MatrixXd postures = lines.follow(sample_times(lines.duration(), fine), preferred);
  if (!lines.obstacle()) path.slowed_by = slow_down(postures.leftCols(postures.cols() - 1), fine, limits);
  path.duration = path.slowed_by * lines.duration();
  if (auto checked = check_samples(path.duration, step, thresholds::most_tool_samples); !checked)
    return forward_error(checked.error());
  path.time = sample_times(path.duration, step);
  std::vector<double> unhurried = path.time;
  for (double& time : unhurried) time /= path.slowed_by;
  path.position = lines.follow(unhurried, preferred);
  path.time.resize(static_cast<std::size_t>(path.position.cols()));
  path.duration = path.time.empty() ? 0.0 : path.time.back();
  set_derivatives(path);
  for (const double time : lines.passing_times())
    if (path.slowed_by * time <= path.duration) path.passing_times.push_back(path.slowed_by * time);
  path.cuts.assign(path.passing_times.size(), 0.0);
  result.obstacle = lines.obstacle();
  if (result.obstacle) {
    result.obstacle->time *= path.slowed_by;
    result.targets = reach(chain, targets, preferred, options.reach, options.threads);
  }
  return result;
}

}  // namespace kinfer::motion

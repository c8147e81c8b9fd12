// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/inverse.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kinfer/base/expect.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer {
namespace {

constexpr double initial_damping = 1e-6;  // of the largest squared column; small, as starts are usually close
constexpr double min_damping = 1e-14;
constexpr double max_damping = 1e8;          // beyond it a step is shorter than rounding
constexpr double max_step = 0.5;             // [rad] or units of one joint: keeps to the posture of the start
constexpr double stationary_slope = 1e-8;    // relative gradient of the error below which no small change helps
constexpr double singular_condition = 1e-4;  // smallest over largest singular value of the Jacobian
constexpr double perturbation =
    0.05;  // [rad] or units, moves away from a posture where the gradient vanishes by accident
constexpr int max_perturbations = 3;

struct Goal {
  Vec3 position;
  std::optional<Mat3> rotation;
};

/// Task-space error at one q: position, then length-weighted rotation vector, 3 or 6 rows.
struct TaskError {
  VectorXd error;
  double position = 0.0;  // [m]
  double angle = 0.0;     // [rad]
};

class InverseSolver {
 public:
  InverseSolver(const Chain& chain, const Goal& goal, const InverseOptions& options, const Load& load)
      : chain_(chain), goal_(goal), options_(options), load_(load), limits_(joint_limits(chain)) {}

  InverseSolution run(ConstVectorRef start) {
    unit_ = units(task_error(limits_.clamped(start)).position);
    InverseSolution best = iterate(limits_.clamped(start));
    for (int k = 1; k <= max_perturbations && best.status == InverseStatus::unreachable; ++k) {
      InverseSolution other = iterate(limits_.clamped(perturbed(best.q, k)));
      other.iterations += best.iterations;
      const double was = weighted(best), is = weighted(other);
      if (is < was) {
        best = std::move(other);
      } else {
        best.iterations = other.iterations;
      }
    }
    return best;
  }

 private:
  double weighted(const InverseSolution& s) const {
    return std::hypot(s.position_error, options_.length * s.angle_error);
  }

  /// q perturbed by amounts that are the same in every run and follow no symmetry of a machine.
  VectorXd perturbed(VectorXd q, int k) const {
    for (Eigen::Index i = 0; i < q.size(); ++i)
      q[i] += unit_[i] * (perturbation * std::sin(1.0 + 2.4 * double(i) + 1.7 * k));
    return q;
  }

  /// Of each joint's steps: 1 rad; of a joint that translates the reach of the machine [m], or the way to the target
  /// where that is longer.
  VectorXd units(double position_error) const {
    const std::vector<int> moving = active_joints(chain_);
    VectorXd unit = VectorXd::Ones(static_cast<Eigen::Index>(moving.size()));
    for (std::size_t k = 0; k < moving.size(); ++k)
      if (translates(chain_.joints[static_cast<std::size_t>(moving[k])].type))
        unit[static_cast<Eigen::Index>(k)] = std::max(options_.length, position_error);
    return unit;
  }

  TaskError task_error(const VectorXd& q) const {
    const Pose tool = forward(chain_, q, load_);
    const Vec3 left = goal_.position - tool.position;
    if (!goal_.rotation) return {left, left.norm(), 0.0};
    const Vec3 turn = log_so3(*goal_.rotation * tool.rotation.transpose());
    TaskError both{VectorXd(6), left.norm(), turn.norm()};
    both.error << left, options_.length * turn;
    return both;
  }

  /// By the joints in their units.
  MatrixXd weighted_jacobian(const VectorXd& q) const {
    Twists twists = jacobian(chain_, q, load_);
    for (Eigen::Index k = 0; k < unit_.size(); ++k) twists.col(k) *= unit_[k];
    if (!goal_.rotation) return twists.topRows<3>();
    twists.bottomRows<3>() *= options_.length;
    return twists;
  }

  bool within_tolerance(const TaskError& g) const {
    return g.position <= options_.position_tolerance && g.angle <= options_.angle_tolerance;
  }

  /// Zeroes the columns of joints at a limit whose step would leave it; returns whether there are any.
  bool freeze_joints_at_limits(MatrixXd& j, const VectorXd& q, const VectorXd& error) const {
    bool is_limited = false;
    const VectorXd descent_direction = j.transpose() * error;
    for (Eigen::Index k = 0; k < q.size(); ++k) {
      const bool beyond = (q[k] <= limits_.lower[k] && descent_direction[k] < 0) ||
                          (q[k] >= limits_.upper[k] && descent_direction[k] > 0);
      if (!beyond) continue;
      j.col(k).setZero();
      is_limited = true;
    }
    return is_limited;
  }

  static VectorXd step(const MatrixXd& j, const VectorXd& error, double damping) {
    MatrixXd normal = gram(j);
    normal.diagonal().array() += damping * normal.diagonal().maxCoeff();
    const std::optional<VectorXd> solved = solve_spd(normal, j.transpose() * error);
    if (!solved) return VectorXd::Zero(j.cols());
    const double largest = solved->cwiseAbs().maxCoeff();
    return largest > max_step ? VectorXd(*solved * (max_step / largest)) : *solved;
  }

  InverseStatus final_status(const MatrixXd& j, bool stationary, bool is_limited) const {
    if (stationary) return is_limited ? InverseStatus::at_limit : InverseStatus::unreachable;
    const VectorXd s = svd(j).s;
    return s[s.size() - 1] < singular_condition * s[0] ? InverseStatus::near_singular : InverseStatus::iteration_limit;
  }

  /// Levenberg-Marquardt; the damping follows the gain ratio (Nielsen 1999).
  InverseSolution iterate(VectorXd q) const {
    TaskError now = task_error(q);
    double damping = initial_damping, growth = 2.0;
    MatrixXd full;
    bool is_limited = false, stationary = false;
    int used = 0;
    for (; used < options_.iterations && !within_tolerance(now); ++used) {
      MatrixXd j = full = weighted_jacobian(q);
      is_limited = freeze_joints_at_limits(j, q, now.error);
      stationary = damping > max_damping ||
                   (j.transpose() * now.error).norm() <= stationary_slope * full.norm() * now.error.norm();
      if (stationary) break;
      const VectorXd tried = limits_.clamped(q + unit_.cwiseProduct(step(j, now.error, damping)));
      TaskError then = task_error(tried);
      const double predicted =
          now.error.squaredNorm() - (now.error - full * (tried - q).cwiseQuotient(unit_)).squaredNorm();
      const double gain = now.error.squaredNorm() - then.error.squaredNorm();
      if (gain > 0.0) {
        const double trust = predicted > 0.0 ? 2.0 * std::min(gain / predicted, 1.0) - 1.0 : 0.0;
        damping = std::max(min_damping, damping * std::max(1.0 / 3.0, 1.0 - trust * trust * trust));
        q = tried, now = std::move(then), growth = 2.0;
      } else {
        damping *= growth, growth *= 2.0;
      }
    }
    const InverseStatus status =
        within_tolerance(now) ? InverseStatus::reached : final_status(full, stationary, is_limited);
    return {std::move(q), status, now.position, now.angle, used};
  }

  const Chain& chain_;
  const Goal& goal_;
  const InverseOptions& options_;
  const Load& load_;
  JointLimits limits_;
  VectorXd unit_;
};

InverseSolution solve_inverse(const Chain& chain, const Goal& goal, ConstVectorRef start, const InverseOptions& options,
                              const Load& load) {
  KINFER_EXPECT(start.size() == dof(chain) && start.size() > 0, "{} joint positions for {} joints", start.size(),
                dof(chain));
  KINFER_EXPECT(options.iterations > 0 && options.length > 0.0);
  return InverseSolver(chain, goal, options, load).run(start);
}

}  // namespace

InverseSolution inverse(const Chain& chain, const Pose& world_T_tool, ConstVectorRef start,
                        const InverseOptions& options, const Load& load) {
  return solve_inverse(chain, {world_T_tool.position, world_T_tool.rotation}, start, options, load);
}

InverseSolution inverse_position(const Chain& chain, const Vec3& point, ConstVectorRef start,
                                 const InverseOptions& options, const Load& load) {
  return solve_inverse(chain, {point, std::nullopt}, start, options, load);
}

}  // namespace kinfer

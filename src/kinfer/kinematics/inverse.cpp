#include "kinfer/kinematics/inverse.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kinfer/base/expect.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

constexpr double first_damping = 1e-6;  // of the largest squared column; small, as starts are usually close
constexpr double least_damping = 1e-14;
constexpr double most_damping = 1e8;         // beyond it a step is shorter than rounding
constexpr double longest_step = 0.5;         // [rad] or [m] of one reading: keeps to the posture of the start
constexpr double stationary_slope = 1e-8;    // relative slope of the error below which no small change helps
constexpr double singular_condition = 1e-4;  // smallest over largest singular value of the Jacobian
constexpr double nudge = 0.05;               // [rad] or [m] away from a posture where the slope vanishes by accident
constexpr int nudges = 3;

struct Goal {
  Vec3 position;
  std::optional<Mat3> rotation;
};

struct Limits {
  VectorXd lower, upper;
  VectorXd clamped(const VectorXd& q) const { return q.cwiseMax(lower).cwiseMin(upper); }
};

Limits limits_of(const Chain& chain) {
  const std::vector<int> joints = joints_with_reading(chain);
  Limits limits{VectorXd(joints.size()), VectorXd(joints.size())};
  for (Eigen::Index k = 0; k < limits.lower.size(); ++k) {
    limits.lower[k] = chain.joints[joints[k]].lower;
    limits.upper[k] = chain.joints[joints[k]].upper;
  }
  return limits;
}

/// What is left to go at one q: position over length-weighted angle, 3 or 6 rows.
struct Gap {
  VectorXd error;
  double position = 0.0;  // [m]
  double angle = 0.0;     // [rad]
};

class Search {
 public:
  Search(const Chain& chain, const Goal& goal, const InverseOptions& options, const Load& load)
      : chain_(chain), goal_(goal), options_(options), load_(load), limits_(limits_of(chain)) {}

  InverseSolution run(ConstVectorRef start) {
    InverseSolution best = descend(limits_.clamped(start));
    for (int k = 1; k <= nudges && best.reach == Reach::not_reachable; ++k) {
      InverseSolution other = descend(limits_.clamped(nudged(best.q, k)));
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

  /// The readings moved by amounts that are the same in every run and follow no symmetry of a machine.
  static VectorXd nudged(VectorXd q, int k) {
    for (Eigen::Index i = 0; i < q.size(); ++i) q[i] += nudge * std::sin(1.0 + 2.4 * double(i) + 1.7 * k);
    return q;
  }

  Gap gap(const VectorXd& q) const {
    const Pose tool = forward(chain_, q, load_);
    const Vec3 left = goal_.position - tool.position;
    if (!goal_.rotation) return {left, left.norm(), 0.0};
    const Vec3 turn = log_so3(*goal_.rotation * tool.rotation.transpose());
    Gap both{VectorXd(6), left.norm(), turn.norm()};
    both.error << left, options_.length * turn;
    return both;
  }

  MatrixXd weighted_jacobian(const VectorXd& q) const {
    Twists twists = jacobian(chain_, q, load_);
    if (!goal_.rotation) return twists.topRows<3>();
    twists.bottomRows<3>() *= options_.length;
    return twists;
  }

  bool within_tolerance(const Gap& g) const {
    return g.position <= options_.position_tolerance && g.angle <= options_.angle_tolerance;
  }

  /// Zeroes the columns of readings that are at a limit and wish to go beyond it; says whether there are any.
  bool hold_at_limits(MatrixXd& j, const VectorXd& q, const VectorXd& error) const {
    bool held = false;
    const VectorXd wish = j.transpose() * error;
    for (Eigen::Index k = 0; k < q.size(); ++k) {
      const bool beyond = (q[k] <= limits_.lower[k] && wish[k] < 0) || (q[k] >= limits_.upper[k] && wish[k] > 0);
      if (!beyond) continue;
      j.col(k).setZero();
      held = true;
    }
    return held;
  }

  static VectorXd step(const MatrixXd& j, const VectorXd& error, double damping) {
    MatrixXd normal = j.transpose() * j;
    normal.diagonal().array() += damping * normal.diagonal().maxCoeff();
    const std::optional<VectorXd> solved = solve_positive(normal, j.transpose() * error);
    if (!solved) return VectorXd::Zero(j.cols());
    const double longest = solved->cwiseAbs().maxCoeff();
    return longest > longest_step ? VectorXd(*solved * (longest_step / longest)) : *solved;
  }

  Reach ended(const MatrixXd& j, bool stationary, bool held) const {
    if (stationary) return held ? Reach::at_limit : Reach::not_reachable;
    const VectorXd s = svd(j).s;
    return s[s.size() - 1] < singular_condition * s[0] ? Reach::near_singular : Reach::out_of_steps;
  }

  /// Levenberg-Marquardt; the damping follows how well the linear model foretold the gain (Nielsen 1999).
  InverseSolution descend(VectorXd q) const {
    Gap now = gap(q);
    double damping = first_damping, growth = 2.0;
    MatrixXd full;
    bool held = false, stationary = false;
    int used = 0;
    for (; used < options_.iterations && !within_tolerance(now); ++used) {
      MatrixXd j = full = weighted_jacobian(q);
      held = hold_at_limits(j, q, now.error);
      stationary = damping > most_damping ||
                   (j.transpose() * now.error).norm() <= stationary_slope * full.norm() * now.error.norm();
      if (stationary) break;
      const VectorXd tried = limits_.clamped(q + step(j, now.error, damping));
      Gap then = gap(tried);
      const double foretold = now.error.squaredNorm() - (now.error - full * (tried - q)).squaredNorm();
      const double gain = now.error.squaredNorm() - then.error.squaredNorm();
      if (gain > 0.0) {
        const double trust = foretold > 0.0 ? 2.0 * std::min(gain / foretold, 1.0) - 1.0 : 0.0;
        damping = std::max(least_damping, damping * std::max(1.0 / 3.0, 1.0 - trust * trust * trust));
        q = tried, now = std::move(then), growth = 2.0;
      } else {
        damping *= growth, growth *= 2.0;
      }
    }
    const Reach reach = within_tolerance(now) ? Reach::reached : ended(full, stationary, held);
    return {std::move(q), reach, now.position, now.angle, used};
  }

  const Chain& chain_;
  const Goal& goal_;
  const InverseOptions& options_;
  const Load& load_;
  Limits limits_;
};

InverseSolution search(const Chain& chain, const Goal& goal, ConstVectorRef start, const InverseOptions& options,
                       const Load& load) {
  KINFER_EXPECT(start.size() == dof(chain) && start.size() > 0, "{} readings for {} joints", start.size(), dof(chain));
  KINFER_EXPECT(options.iterations > 0 && options.length > 0.0);
  return Search(chain, goal, options, load).run(start);
}

}  // namespace

std::string_view sentence(Reach reach) {
  switch (reach) {
    case Reach::reached:
      return "the tool is where it should be";
    case Reach::not_reachable:
      return "the place is out of reach from this start: no small change of the joints brings the tool closer";
    case Reach::at_limit:
      return "a joint at its limit holds the tool back";
    case Reach::near_singular:
      return "the tool did not arrive: near this posture the machine can hardly move in one of the directions asked "
             "for";
    case Reach::out_of_steps:
      return "the tool did not arrive within the allowed number of steps";
  }
  return "";
}

InverseSolution inverse(const Chain& chain, const Pose& world_T_tool, ConstVectorRef start,
                        const InverseOptions& options, const Load& load) {
  return search(chain, {world_T_tool.position, world_T_tool.rotation}, start, options, load);
}

InverseSolution inverse_position(const Chain& chain, const Vec3& point, ConstVectorRef start,
                                 const InverseOptions& options, const Load& load) {
  return search(chain, {point, std::nullopt}, start, options, load);
}

}  // namespace kinfer

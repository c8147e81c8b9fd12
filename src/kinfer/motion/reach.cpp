// SPDX-License-Identifier: Apache-2.0
#include "kinfer/motion/reach.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/parallel.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/motion/reach_task.hpp"
#include "kinfer/motion/screw_chain.hpp"
#include "kinfer/motion/thresholds.hpp"

namespace kinfer::motion {
namespace {

using Eigen::Index;

struct Limits {
  VectorXd lower, upper;
};

Limits limits_of(const Chain& chain) {
  const std::vector<int> joints = active_joints(chain);
  Limits limits{VectorXd(joints.size()), VectorXd(joints.size())};
  for (Index k = 0; k < limits.lower.size(); ++k) {
    limits.lower[k] = chain.joints[static_cast<std::size_t>(joints[static_cast<std::size_t>(k)])].lower;
    limits.upper[k] = chain.joints[static_cast<std::size_t>(joints[static_cast<std::size_t>(k)])].upper;
  }
  return limits;
}

/// [m] Sum of the constant transforms: a bound of how far the tool gets without prismatic joints.
double reach_of(const Chain& chain) {
  const std::vector<Pose> frames = joint_frames(chain, VectorXd::Zero(dof(chain)));
  double length = chain.tool.xyz.norm();
  for (const int j : path_to(chain, chain.tip_joint())) {
    const int parent = chain.joints[static_cast<std::size_t>(j)].parent;
    if (parent >= 0)
      length +=
          (frames[static_cast<std::size_t>(j)].position - frames[static_cast<std::size_t>(parent)].position).norm();
  }
  return length > 0.0 ? length : 1.0;
}

bool has_deviations(const Chain& chain) {
  return chain.expansion != 0.0 || std::ranges::any_of(chain.joints, [](const Joint& j) {
           return j.compliance != 0.0 || j.torque_compliance != 0.0 || j.backlash != 0.0 || !j.harmonics.empty();
         });
}

/// Solves (A + damping · I) x = b in place by Cholesky; false where the matrix is singular. A is small and symmetric.
bool solve_damped(MatrixXd& a, VectorXd& b, double damping) {
  const Index n = b.size();
  for (Index k = 0; k < n; ++k) {
    double pivot = a(k, k) + damping;
    for (Index i = 0; i < k; ++i) pivot -= a(k, i) * a(k, i);
    if (!(pivot > 1e-300)) return false;
    const double root = std::sqrt(pivot);
    a(k, k) = root;
    for (Index row = k + 1; row < n; ++row) {
      double sum = a(row, k);
      for (Index i = 0; i < k; ++i) sum -= a(row, i) * a(k, i);
      a(row, k) = sum / root;
    }
    double sum = b[k];
    for (Index i = 0; i < k; ++i) sum -= a(k, i) * b[i];
    b[k] = sum / root;
  }
  for (Index k = n - 1; k >= 0; --k) {
    double sum = b[k];
    for (Index i = k + 1; i < n; ++i) sum -= a(i, k) * b[i];
    b[k] = sum / a(k, k);
  }
  return true;
}

}  // namespace

class ReachSolver::Search {
 public:
  Search(const Chain& chain, const ReachOptions& options, const Load& load)
      : chain_(chain),
        options_(options),
        load_(load),
        screws_(chain),
        limits_(limits_of(chain)),
        length_(reach_of(chain)),
        deviates_(has_deviations(chain)) {}

  ReachSolution solve(const ReachTarget& target, const VectorXd& preferred) {
    const ReachTask task(target, options_.tool_axis, length_);
    ReachSolution solution = search(task, preferred);
    const ReachTask::Error left = task.error(forward(chain_, solution.postures.front().q, load_));
    solution.position_error = left.position, solution.angle_error = left.angle;
    return solution;
  }

 private:
  enum class Steps {
    of_start,       ///< of the rigid chain, without limits, left early
    of_machine,     ///< the same with the deviations of the machine
    inside_limits,  ///< of the machine, clamped to the limits
  };

  /// What one start came to.
  struct Attempt {
    VectorXd q;
    double error = 0.0;  // weighted norm
    bool converged = false;
  };

  ReachSolution search(const ReachTask& task, const VectorXd& preferred) {
    ReachSolution solution;
    Attempt closest{preferred, std::numeric_limits<double>::infinity(), false};
    std::optional<VectorXd> beyond;  // reaches the target, outside the limits
    const Rng rng(options_.seed);
    for (int start = 0; start < options_.starts; ++start) {
      solution.starts_used = start + 1;
      Attempt attempt =
          descend(task, start == 0 ? preferred : draw(rng.stream(static_cast<std::uint64_t>(start))), Steps::of_start);
      if (!attempt.converged) {
        if (attempt.error < closest.error) closest = std::move(attempt);
        continue;
      }
      if (screws_.dof() > task.fixed_freedoms()) approach(task, preferred, attempt.q);
      if (deviates_) attempt = descend(task, std::move(attempt.q), Steps::of_machine);
      if (!attempt.converged) continue;
      unwind(attempt.q, preferred);
      if (!is_inside(attempt.q)) {
        if (!beyond || violation(attempt.q) < violation(*beyond)) beyond = attempt.q;
        continue;
      }
      keep(solution, std::move(attempt.q), preferred);
      if (options_.choice == PostureChoice::first) break;
    }
    if (!solution.postures.empty()) {
      solution.status = ReachStatus::reached;
      std::ranges::stable_sort(solution.postures, {}, &Posture::distance);
      if (options_.choice == PostureChoice::nearest) solution.postures.resize(1);
      return solution;
    }
    explain(task, preferred, closest, beyond, solution);
    return solution;
  }

  /// Why no posture was found, and the one inside the limits that comes closest.
  void explain(const ReachTask& task, const VectorXd& preferred, const Attempt& closest,
               const std::optional<VectorXd>& beyond, ReachSolution& solution) {
    Attempt inside = descend(task, clamped(beyond ? *beyond : closest.q), Steps::inside_limits);
    if (const Attempt other = descend(task, clamped(preferred), Steps::inside_limits); other.error < inside.error)
      inside = other;
    solution.postures = {{inside.q, distance(inside.q, preferred)}};
    if (inside.converged) {
      solution.status = ReachStatus::reached;
    } else if (beyond) {
      solution.status = ReachStatus::outside_limits;
      for (Index k = 0; k < beyond->size(); ++k)
        if ((*beyond)[k] < limits_.lower[k] || (*beyond)[k] > limits_.upper[k])
          solution.limited_joints.push_back(static_cast<int>(k));
    } else {
      solution.status =
          closest.error < thresholds::near_target ? ReachStatus::near_singular : ReachStatus::out_of_reach;
    }
  }

  bool is_met(const ReachTask::Error& error) const {
    return error.position <= options_.position_tolerance && error.angle <= options_.angle_tolerance;
  }

  /// The tool of the machine where it deviates from the rigid chain by loads, compliance and harmonics; their effect on
  /// the Jacobian is left out.
  Pose machine_tool(const VectorXd& q) const { return deviates_ ? forward(chain_, q, load_) : at_.tool; }

  Attempt descend(const ReachTask& task, VectorXd q, Steps kind) {
    const bool clamp = kind == Steps::inside_limits;
    const int most = kind == Steps::of_start ? thresholds::steps : thresholds::careful_steps;
    double earlier = std::numeric_limits<double>::infinity();
    for (int step = 0;; ++step) {
      screws_.place(q, at_);
      const ReachTask::Error error = task.error(kind == Steps::of_start ? at_.tool : machine_tool(q));
      const double size = error.weighted.norm();
      if (is_met(error)) return {std::move(q), size, true};
      if (step == most) return {std::move(q), size, false};
      if (kind == Steps::of_start && step % thresholds::judged_steps == thresholds::judged_steps - 1) {
        if (size > thresholds::worthwhile_decrease * earlier) return {std::move(q), size, false};
        earlier = size;
      }
      set_rows(task, q, error, clamp);
      if (!set_step(task, error.weighted, thresholds::damping * size * size)) return {std::move(q), size, false};
      const double largest = step_.cwiseAbs().maxCoeff();
      if (largest > thresholds::longest_step) step_ *= thresholds::longest_step / largest;
      q += step_;
      if (clamp) q = clamped(q);
    }
  }

  /// The Jacobian; without the joints that a clamped step would push against their limits.
  void set_rows(const ReachTask& task, const VectorXd& q, const ReachTask::Error& error, bool clamp) {
    screws_.jacobian(at_, twists_);
    task.rows(at_.tool, twists_, rows_);
    if (!clamp) return;
    for (Index k = 0; k < q.size(); ++k) {
      const double towards = rows_.col(k).dot(error.weighted.head(task.rows()));
      if ((q[k] <= limits_.lower[k] && towards < 0.0) || (q[k] >= limits_.upper[k] && towards > 0.0))
        rows_.col(k).setZero();
    }
  }

  /// step_ = Jᵀ (J Jᵀ + λ)⁻¹ e, or (JᵀJ + λ)⁻¹ Jᵀ e where that is the smaller system.
  bool set_step(const ReachTask& task, const Eigen::Matrix<double, 6, 1>& error, double damping) {
    const double least = damping + thresholds::least_damping;
    if (task.rows() <= rows_.cols()) {
      normal_.noalias() = rows_.lazyProduct(rows_.transpose());
      right_ = error.head(task.rows());
      if (!solve_damped(normal_, right_, least)) return false;
      step_.noalias() = rows_.transpose().lazyProduct(right_);
    } else {
      normal_.noalias() = rows_.transpose().lazyProduct(rows_);
      step_.noalias() = rows_.transpose().lazyProduct(error.head(task.rows()));
      if (!solve_damped(normal_, step_, least)) return false;
    }
    return true;
  }

  /// Moves a redundant chain towards the preferred posture, and towards the inside of the limits, without moving the
  /// tool: steps in the null space of the task.
  void approach(const ReachTask& task, const VectorXd& preferred, VectorXd& q) {
    unwind(q, preferred);
    double part = 1.0;
    for (int k = 0; k < thresholds::approach_steps; ++k) {
      screws_.place(q, at_);
      screws_.jacobian(at_, twists_);
      task.rows(at_.tool, twists_, rows_);
      const VectorXd wanted = preferred - q;
      // The part of the wanted step that moves the tool is taken out of it.
      Eigen::Matrix<double, 6, 1> moved = Eigen::Matrix<double, 6, 1>::Zero();
      moved.head(task.rows()) = rows_.lazyProduct(wanted);
      if (!set_step(task, moved, 0.0)) break;
      const VectorXd step = wanted - step_;
      const double largest = part * step.cwiseAbs().maxCoeff();
      if (largest < thresholds::approach_tolerance) break;
      const double length = part * std::min(1.0, thresholds::longest_step / largest);
      Attempt corrected = descend(task, q + length * step, Steps::of_start);
      if (corrected.converged && distance(corrected.q, preferred) < distance(q, preferred))
        q = std::move(corrected.q), part = std::min(1.0, 2.0 * part);
      else
        part *= 0.25;
    }
  }

  /// Removes revolutions: each periodic joint position as near to the preferred one as its limits allow.
  void unwind(VectorXd& q, const VectorXd& preferred) const {
    for (Index k = 0; k < q.size(); ++k) {
      const double period = screws_.period(static_cast<int>(k));
      if (period == 0.0) continue;
      q[k] = preferred[k] + std::remainder(q[k] - preferred[k], period);
      if (q[k] < limits_.lower[k]) q[k] += period * std::ceil((limits_.lower[k] - q[k]) / period);
      if (q[k] > limits_.upper[k]) q[k] -= period * std::ceil((q[k] - limits_.upper[k]) / period);
    }
  }

  bool is_inside(const VectorXd& q) const {
    return (q.array() >= limits_.lower.array()).all() && (q.array() <= limits_.upper.array()).all();
  }
  VectorXd clamped(const VectorXd& q) const { return q.cwiseMax(limits_.lower).cwiseMin(limits_.upper); }
  double violation(const VectorXd& q) const { return (q - clamped(q)).cwiseAbs().sum(); }

  /// [rad] of a difference of q[k]
  double angular(Index k, double difference) const {
    return screws_.is_rotational(static_cast<int>(k)) ? difference : difference / length_;
  }
  double distance(const VectorXd& q, const VectorXd& preferred) const {
    double squares = 0.0;
    for (Index k = 0; k < q.size(); ++k) squares += std::pow(angular(k, q[k] - preferred[k]), 2);
    return std::sqrt(squares);
  }

  void keep(ReachSolution& solution, VectorXd q, const VectorXd& preferred) const {
    for (const Posture& known : solution.postures) {
      VectorXd same = known.q;
      unwind(same, q);  // half a revolution to either side of the preferred posture is the same
      if (distance(same, q) < thresholds::same_posture) return;
    }
    const double from_preferred = distance(q, preferred);
    solution.postures.push_back({std::move(q), from_preferred});
  }

  VectorXd draw(Rng rng) const {
    VectorXd q(screws_.dof());
    for (Index k = 0; k < q.size(); ++k) {
      const double half = screws_.is_rotational(static_cast<int>(k)) ? std::numbers::pi : length_;
      const double lower =
          std::max(limits_.lower[k], std::isfinite(limits_.upper[k]) ? limits_.upper[k] - 2.0 * half : -half);
      const double upper = std::min(limits_.upper[k], lower + 2.0 * half);
      q[k] = rng.uniform(lower, upper);
    }
    return q;
  }

  Chain chain_;
  ReachOptions options_;
  Load load_;
  ScrewChain screws_;
  Limits limits_;
  double length_;
  bool deviates_;
  // Buffers of the inner loop.
  ScrewChain::Placement at_;
  Twists twists_;
  MatrixXd rows_, normal_;
  VectorXd right_, step_;
};

ReachSolver::ReachSolver(const Chain& chain, const ReachOptions& options, const Load& load)
    : search_(std::make_unique<Search>(chain, options, load)) {
  KINFER_EXPECT(options.starts > 0 && dof(chain) > 0, "{} starts for {} joints", options.starts, dof(chain));
}
ReachSolver::~ReachSolver() = default;
ReachSolver::ReachSolver(ReachSolver&&) noexcept = default;

ReachSolution ReachSolver::solve(const ReachTarget& target, const VectorXd& preferred) const {
  return search_->solve(target, preferred);
}

std::vector<ReachSolution> reach(const Chain& chain, const std::vector<ReachTarget>& targets, const MatrixXd& preferred,
                                 const ReachOptions& options, int threads) {
  KINFER_EXPECT(preferred.rows() == dof(chain), "{} joint positions for {} joints", preferred.rows(), dof(chain));
  std::vector<ReachSolution> solutions(targets.size());
  constexpr std::size_t block = 64;  // targets of one solver, whose preparation costs as much as a few of them
  parallel_for((targets.size() + block - 1) / block, threads, [&](std::size_t b) {
    const ReachSolver solver(chain, options);
    for (std::size_t i = b * block; i < std::min(targets.size(), (b + 1) * block); ++i)
      solutions[i] = solver.solve(targets[i], preferred.col(preferred.cols() == 1 ? 0 : static_cast<Index>(i)));
  });
  return solutions;
}

std::vector<ReachSolution> reach_in_sequence(const Chain& chain, const std::vector<ReachTarget>& targets,
                                             VectorXd preferred, const ReachOptions& options) {
  const ReachSolver solver(chain, options);
  std::vector<ReachSolution> solutions;
  for (const ReachTarget& target : targets) {
    solutions.push_back(solver.solve(target, preferred));
    if (solutions.back().status == ReachStatus::reached) preferred = solutions.back().postures.front().q;
  }
  return solutions;
}

VectorXd middle_posture(const Chain& chain) {
  const Limits limits = limits_of(chain);
  VectorXd q = VectorXd::Zero(limits.lower.size());
  for (Index k = 0; k < q.size(); ++k) {
    if (std::isfinite(limits.lower[k]) && std::isfinite(limits.upper[k]))
      q[k] = 0.5 * (limits.lower[k] + limits.upper[k]);
    else
      q[k] = std::clamp(0.0, limits.lower[k], limits.upper[k]);
  }
  return q;
}

}  // namespace kinfer::motion

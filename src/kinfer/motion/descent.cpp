// SPDX-License-Identifier: Apache-2.0
#include "kinfer/motion/descent.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/linalg/normal_equations.hpp"
#include "kinfer/linalg/small_cholesky.hpp"
#include "kinfer/motion/thresholds.hpp"

namespace kinfer::motion {
namespace {

using Eigen::Index;

double sum_of_transforms(const Chain& chain) {
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

/// The part of the null-space step that leads to its zero, by how it has changed along `moved` (Barzilai and Borwein
/// 1988; of one free dimension the secant step). At most 1: longer ones pass postures by.
double secant_part(const VectorXd& moved, const VectorXd& step_before, const VectorXd& step) {
  const double change = moved.dot(step_before - step), squares = moved.squaredNorm();
  return change > squares ? squares / change : 1.0;
}

}  // namespace

Descent::Descent(const Chain& chain, const Load& load, double position_tolerance, double angle_tolerance)
    : chain_(chain),
      load_(load),
      screws_(chain),
      limits_(joint_limits(chain)),
      length_(sum_of_transforms(chain)),
      deviates_(kinfer::has_non_geometric_terms(chain)),
      position_tolerance_(position_tolerance),
      angle_tolerance_(angle_tolerance) {
  set_units(0.0);
}

bool Descent::is_inside(const VectorXd& q) const {
  return (q.array() >= limits_.lower.array()).all() && (q.array() <= limits_.upper.array()).all();
}

bool Descent::is_met(const ReachTask::Error& error) const {
  return error.position <= position_tolerance_ && error.angle <= angle_tolerance_;
}

/// Fewer joints than a target fixes freedoms meet it exactly only where its numbers do not end.
bool Descent::is_met_but_for_rounding(const ReachTask& task, const ReachTask::Error& error) const {
  return screws_.dof() < task.fixed_freedoms() && std::max(error.position, error.angle) <= thresholds::rounded_target;
}

/// Steps of joints that translate are compared with the machine, and with the way to the target where that is longer:
/// no number of metres is long or short by itself.
void Descent::set_units(double position_error) {
  unit_.setOnes(screws_.dof());
  for (Index k = 0; k < unit_.size(); ++k)
    if (!screws_.is_rotational(static_cast<int>(k))) unit_[k] = std::max(length_, position_error);
}

Descent::Attempt Descent::run(const ReachTask& task, VectorXd q, Steps steps) {
  const bool of_machine = deviates_ && steps.of_machine;
  const int most = steps.are_patient ? thresholds::patient_steps : thresholds::steps;
  double earlier = std::numeric_limits<double>::infinity();
  if (steps.are_clamped) q = limits_.clamped(q);
  for (int step = 0;; ++step) {
    screws_.place(q, at_);
    // The effect of non-geometric terms on the Jacobian is left out.
    const ReachTask::Error error = task.error(of_machine ? tool(q) : at_.tool);
    const double size = error.weighted.norm();
    if (step == 0) set_units(error.position);
    if (is_met(error) || (steps.are_rough && size <= thresholds::rough_correction)) return {std::move(q), size, true};
    const auto left = [&] { return Attempt{std::move(q), size, is_met_but_for_rounding(task, error)}; };
    if (step == most) return left();
    if (!steps.are_patient && step % thresholds::judged_steps == thresholds::judged_steps - 1) {
      if (size > thresholds::worthwhile_decrease * earlier) return left();
      earlier = size;
    }
    set_rows(task);
    if (steps.are_clamped) leave_out_limited(task, q, error);
    if (!set_step(task, error.weighted, thresholds::damping * size * size)) return left();
    const double largest = step_.cwiseAbs().maxCoeff();
    if (largest > thresholds::longest_step) step_ *= thresholds::longest_step / largest;
    q += unit_.cwiseProduct(step_);
    if (steps.are_clamped) q = limits_.clamped(q);
  }
}

/// The Jacobian by the joints in their units.
void Descent::set_rows(const ReachTask& task) {
  screws_.jacobian(at_, twists_);
  task.rows(at_.tool, twists_, rows_);
  for (Index k = 0; k < unit_.size(); ++k) rows_.col(k) *= unit_[k];
}

/// The joints that a clamped step would push against their limits.
void Descent::leave_out_limited(const ReachTask& task, const VectorXd& q, const ReachTask::Error& error) {
  for (Index k = 0; k < q.size(); ++k) {
    const double towards = rows_.col(k).dot(error.weighted.head(task.rows()));
    if ((q[k] <= limits_.lower[k] && towards < 0.0) || (q[k] >= limits_.upper[k] && towards > 0.0))
      rows_.col(k).setZero();
  }
}

/// step_ = Jᵀ (J Jᵀ + λ)⁻¹ e, or (JᵀJ + λ)⁻¹ Jᵀ e where that is the smaller system.
bool Descent::set_step(const ReachTask& task, const Eigen::Matrix<double, 6, 1>& error, double damping) {
  const double least = damping + thresholds::least_damping;
  if (task.rows() == 6 && rows_.cols() >= 6) {  // the usual case, in registers
    const Eigen::Map<const Twists> rows(rows_.data(), 6, rows_.cols());
    Eigen::Matrix<double, 6, 6> normal = rows.lazyProduct(rows.transpose());
    normal.diagonal().array() += least;
    Eigen::Matrix<double, 6, 1> solution = error;
    if (!solve_six(normal, solution)) return false;
    step_.noalias() = rows.transpose().lazyProduct(solution);
  } else if (task.rows() <= rows_.cols()) {
    normal_.noalias() = rows_.lazyProduct(rows_.transpose());
    normal_.diagonal().array() += least;
    right_ = error.head(task.rows());
    if (!solve_in_place(normal_, right_)) return false;
    step_.noalias() = rows_.transpose().lazyProduct(right_);
  } else {
    normal_.noalias() = rows_.transpose().lazyProduct(rows_);
    normal_.diagonal().array() += least;
    step_.noalias() = rows_.transpose().lazyProduct(error.head(task.rows()));
    if (!solve_in_place(normal_, step_)) return false;
  }
  return true;
}

void Descent::approach(const ReachTask& task, const VectorXd& preferred, VectorXd& q) {
  unwind(q, preferred);
  const VectorXd start = q;
  const Steps steps{.are_clamped = is_inside(q)};
  Steps rough = steps;
  rough.are_rough = true;
  double part = 1.0;
  VectorXd moved, step_before;  // by the step before, if that led nearer
  for (int k = 0; k < thresholds::approach_steps; ++k) {
    set_units(0.0);
    if (moved.size() == 0) screws_.place(q, at_);  // else it is there
    set_rows(task);
    const VectorXd step = null_space_step(task, (preferred - q).cwiseQuotient(unit_));
    if (moved.size() > 0) part = secant_part(moved, step_before, step);
    const double largest = part * step.cwiseAbs().maxCoeff();
    if (!(largest >= thresholds::approach_tolerance)) break;
    part *= std::min(1.0, thresholds::longest_step / largest);
    Attempt corrected = run(task, q + part * unit_.cwiseProduct(step), rough);
    if (corrected.converged && distance(corrected.q, preferred) < distance(q, preferred)) {
      moved = (corrected.q - q).cwiseQuotient(unit_), step_before = step;
      q = std::move(corrected.q);
    } else {
      moved.resize(0);
      part *= 0.25;
    }
  }
  Attempt end = run(task, q, steps);
  q = end.converged ? end.q : start;
}

/// `wanted` without the part that moves the tool; 0 where that is not to be separated.
VectorXd Descent::null_space_step(const ReachTask& task, const VectorXd& wanted) {
  Eigen::Matrix<double, 6, 1> of_tool = Eigen::Matrix<double, 6, 1>::Zero();
  of_tool.head(task.rows()) = rows_.lazyProduct(wanted);
  if (!set_step(task, of_tool, 0.0)) return VectorXd::Zero(wanted.size());
  return wanted - step_;
}

void Descent::unwind(VectorXd& q, const VectorXd& preferred) const {
  for (Index k = 0; k < q.size(); ++k) {
    const double period = screws_.period(static_cast<int>(k));
    if (period == 0.0) continue;
    q[k] = preferred[k] + std::remainder(q[k] - preferred[k], period);
    if (q[k] < limits_.lower[k]) q[k] += period * std::ceil((limits_.lower[k] - q[k]) / period);
    if (q[k] > limits_.upper[k]) q[k] -= period * std::ceil((q[k] - limits_.upper[k]) / period);
  }
}

double Descent::distance(const VectorXd& q, const VectorXd& preferred) const {
  double squares = 0.0;
  for (Index k = 0; k < q.size(); ++k) {
    const double difference = q[k] - preferred[k];
    squares += std::pow(screws_.is_rotational(static_cast<int>(k)) ? difference : difference / length_, 2);
  }
  return std::sqrt(squares);
}

}  // namespace kinfer::motion

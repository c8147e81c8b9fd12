// SPDX-License-Identifier: Apache-2.0
#include "kinfer/plan/plan_poses.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/parallel.hpp"
#include "kinfer/calibrate/parameters/parameter_sets.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/kinematics/poses/tool_derivatives.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"
#include "kinfer/plan/lower_bound.hpp"
#include "kinfer/plan/optimal_design.hpp"
#include "kinfer/plan/pose_order.hpp"
#include "kinfer/plan/thresholds.hpp"

namespace kinfer::plan {
namespace {

/// The parameters to be identified; the tool rotation only if orientations are measured.
ParameterSet planned_parameters(const PlanTask& task) {
  PoseSet measured;
  measured.points.emplace_back();
  if (task.measures == Measures::poses) measured.orientations.emplace_back();
  return calibrate::geometric_parameters(task.nominal, measured, task.tolerances);
}

VectorXd prior_sds(const ParameterSet& set) {
  VectorXd sd(set.free_count());
  for (Eigen::Index k = 0; k < sd.size(); ++k) sd[k] = set.free()[k]->prior_sd;
  return sd;
}

/// Jacobians of tool positions, each followed by that of the orientation if measured, in units of prior sd and noise.
class ScaledJacobians {
 public:
  ScaledJacobians(const PlanTask& task, const ParameterSet& set)
      : task_(task), set_(set), sd_(prior_sds(set)), evaluator_(task.nominal, set) {}

  MatrixXd measured(const MatrixXd& q) const {
    return task_.measures == Measures::poses ? measured_poses(q) : measured_points(q);
  }
  MatrixXd information(const MatrixXd& q) const {
    const MatrixXd rows = measured(q);
    return gram(rows);
  }
  MatrixXd tool(const MatrixXd& q) const {
    return tool_derivatives(task_.nominal, set_, q).jacobian * sd_.asDiagonal();
  }
  double noise(const Vec3& position) const {
    return std::max(position_sd(task_.instrument, position), thresholds::least_noise);
  }
  double typical_noise(const MatrixXd& q) const {
    std::vector<double> sd;
    for (Eigen::Index i = 0; i < q.cols(); ++i) sd.push_back(noise(evaluator_.pose(q.col(i)).position));
    return median(std::move(sd));
  }

 private:
  MatrixXd measured_points(const MatrixXd& q) const {
    auto [position, rows] = tool_derivatives(task_.nominal, set_, q);
    for (Eigen::Index i = 0; i < q.cols(); ++i) rows.middleRows<3>(3 * i) /= noise(position.col(i));
    return rows * sd_.asDiagonal();
  }
  MatrixXd measured_poses(const MatrixXd& q) const {
    MatrixXd rows(6 * q.cols(), sd_.size());
    Twists twist;
    for (Eigen::Index i = 0; i < q.cols(); ++i) {
      const Pose pose = evaluator_.pose_and_derivative(q.col(i), {}, twist);
      rows.middleRows<3>(6 * i) = twist.topRows<3>() * sd_.asDiagonal() / noise(pose.position);
      rows.middleRows<3>(6 * i + 3) =
          twist.bottomRows<3>() * sd_.asDiagonal() / std::max(task_.instrument.sigma_angle, thresholds::least_noise);
    }
    return rows;
  }

  const PlanTask& task_;
  const ParameterSet& set_;
  VectorXd sd_;
  PoseEvaluator evaluator_;
};

MatrixXd pick_evenly(const MatrixXd& q, Eigen::Index most) {
  const Eigen::Index count = std::min(most, q.cols());
  MatrixXd picked(q.rows(), count);
  for (Eigen::Index i = 0; i < count; ++i) picked.col(i) = q.col(i * q.cols() / count);
  return picked;
}

ExpectedError expected_error(const DesignProblem& problem, int poses, const MatrixXd& information) {
  const auto covariance = invert_spd(information);
  if (!covariance) return {poses, 0.0, 0.0};
  const VectorXd variance = tool_variances(problem, *covariance);
  return {poses, std::sqrt(variance.mean()), std::sqrt(variance.maxCoeff())};
}

/// Expected error by the number of poses of a nested sequence.
std::vector<ExpectedError> curve(const DesignProblem& problem, const std::vector<int>& sequence) {
  std::vector<ExpectedError> points;
  for (std::size_t n = 1; n <= sequence.size(); ++n)
    points.push_back(
        expected_error(problem, static_cast<int>(n),
                       information(problem, {sequence.begin(), sequence.begin() + static_cast<std::ptrdiff_t>(n)})));
  return points;
}

/// Median over several random sequences, point by point.
std::vector<ExpectedError> random_curve(const DesignProblem& problem, int count, int threads, Rng rng) {
  std::vector<std::vector<ExpectedError>> curves(thresholds::random_draws);
  parallel_for(curves.size(), threads, [&](std::size_t d) {
    Rng stream = rng.stream(d);
    std::vector<int> all(problem.candidates());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
    for (std::size_t i = 0; i + 1 < all.size(); ++i) std::swap(all[i], all[i + stream.index(all.size() - i)]);
    all.resize(std::min<std::size_t>(all.size(), count));
    curves[d] = curve(problem, all);
  });
  std::vector<ExpectedError> middle;
  for (std::size_t n = 0; n < curves.front().size(); ++n) {
    std::vector<double> rms_list, worst_list;
    for (const auto& one : curves) rms_list.push_back(one[n].rms), worst_list.push_back(one[n].worst);
    middle.push_back({static_cast<int>(n) + 1, median(rms_list), median(worst_list)});
  }
  return middle;
}

/// Observability indices O1-O5 over the combinations that are observable from all candidates together.
void compute_observability(PosePlan& plan, const DesignProblem& problem, const MatrixXd& measured) {
  const RightSvd all = right_svd(problem.rows);
  plan.parameters = static_cast<int>(all.s.size());
  plan.rank = static_cast<int>((all.s.array() > thresholds::informative).count());
  if (plan.rank == 0 || measured.rows() < plan.rank) return;
  const VectorXd s = right_svd(measured * all.v.leftCols(plan.rank)).s;
  const Eigen::Index pose_count = measured.rows() / problem.block;
  const double poses = static_cast<double>(pose_count), smallest = s[plan.rank - 1];
  plan.observability = {std::exp(s.array().max(1e-300).log().mean()) / std::sqrt(poses), smallest / s[0], smallest,
                        smallest * smallest / s[0], 1.0 / s.array().max(1e-300).inverse().sum()};
}

/// Both matrices stacked vertically; either may be empty (0 x 0).
MatrixXd stack(const MatrixXd& above, const MatrixXd& below) {
  if (above.rows() == 0) return below;
  if (below.rows() == 0) return above;
  MatrixXd both(above.rows() + below.rows(), below.cols());
  if (above.size() > 0) both.topRows(above.rows()) = above;  // an empty one has no columns
  both.bottomRows(below.rows()) = below;
  return both;
}

/// Existing rows that add hardly any information to the others.
std::vector<int> find_redundant_rows(DesignProblem problem, Criterion criterion, const MatrixXd& existing) {
  problem.rows = existing;
  problem.prior_information.resize(0, 0);
  return find_redundant(problem, criterion, thresholds::redundant_rise);
}

/// Refines the chosen poses in joint space, beyond the list of candidates.
MatrixXd refine_poses(const PlanTask& task, const PlanOptions& options, const DesignProblem& problem,
                      const ScaledJacobians& scaled, const MatrixXd& chosen, Rng rng) {
  const auto apart = [&](const MatrixXd& poses, Eigen::Index moved) {
    for (Eigen::Index i = 0; i < poses.cols(); ++i)
      if (i != moved && (poses.col(i) - poses.col(moved)).cwiseAbs().maxCoeff() < options.spacing) return false;
    return true;
  };
  return refined_design(
      problem, options.criterion, chosen, [&](ConstVectorRef q) { return scaled.measured(q); },
      [&](ConstVectorRef q, Rng& draws) { return draw_pose_near(task.nominal, task.space, q, draws); }, apart, rng);
}

}  // namespace

Instrument planned_instrument(Instrument stated) {
  const Instrument usual = PlanTask{}.instrument;
  if (!(stated.sigma_angle > 0.0)) stated.sigma_angle = usual.sigma_angle;
  return with_lengths(stated, usual.sigma);
}

Result<PosePlan> plan_poses(const PlanTask& task, const PlanOptions& options, Rng rng) {
  MatrixXd candidates = task.candidates;
  if (candidates.size() == 0) {
    KINFER_TRY(drawn,
               draw_poses(task.nominal, task.space, std::max(options.candidates, 2 * options.poses), rng.stream(1)));
    candidates = drawn;
  }
  if (candidates.cols() < 2) return error("{} poses to choose from; at least 2 are needed", candidates.cols());
  const ParameterSet set = planned_parameters(task);
  const ScaledJacobians scaled(task, set);
  DesignProblem problem;
  problem.block = task.measures == Measures::poses ? 6 : 3;
  problem.rows = scaled.measured(candidates);
  problem.targets = scaled.tool(pick_evenly(candidates, thresholds::workspace_poses));
  const MatrixXd existing = task.existing.rows() > 0 ? scaled.measured(task.existing.joints) : MatrixXd();
  if (existing.size() > 0) problem.prior_information = gram(existing);
  problem.too_close = [&](int a, int b) {
    return (candidates.col(a) - candidates.col(b)).cwiseAbs().maxCoeff() < options.spacing;
  };

  PosePlan plan;
  plan.criterion = options.criterion;
  const std::vector<int> chosen =
      best_design(problem, options.criterion, options.poses, options.starts, options.threads, rng.stream(2));
  if (chosen.empty())
    return error("no choice of poses has a finite expected error: check the lengths of the robot and its tolerances");
  const bool is_from_list = task.candidates.size() > 0;
  const MatrixXd q = is_from_list
                         ? MatrixXd(candidates(Eigen::all, chosen))
                         : refine_poses(task, options, problem, scaled, candidates(Eigen::all, chosen), rng.stream(4));
  const std::vector<int> order = order_by_travel(task.nominal, q);
  std::vector<int> as_chosen(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) as_chosen[i] = static_cast<int>(i);
  plan.travel = travel(q, order), plan.travel_unordered = travel(q, as_chosen);
  plan.joints = q(Eigen::all, order);
  if (is_from_list)
    for (const int place : order) plan.candidates.push_back(chosen[place]);

  compute_observability(plan, problem, stack(existing, scaled.measured(q)));
  plan.noise = scaled.typical_noise(q);
  plan.expected =
      expected_error(problem, static_cast<int>(chosen.size()), information(problem, {}) + scaled.information(q));
  plan.existing = expected_error(problem, static_cast<int>(task.existing.rows()), information(problem, {}));
  if (options.criterion == Criterion::tool)
    plan.rms_lower_bound = std::sqrt(mean_square_lower_bound(problem, static_cast<int>(chosen.size())));
  const int far = std::min<int>(2 * options.poses, static_cast<int>(candidates.cols()));
  plan.planned_curve = curve(problem, greedy_design(problem, options.criterion, far));
  plan.random_curve = random_curve(problem, far, options.threads, rng.stream(3));
  if (chosen.size() <= plan.random_curve.size() && !chosen.empty()) plan.random = plan.random_curve[chosen.size() - 1];
  if (existing.size() > 0) plan.redundant_rows = find_redundant_rows(problem, options.criterion, existing);
  return plan;
}

}  // namespace kinfer::plan

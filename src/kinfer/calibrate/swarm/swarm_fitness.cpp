// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/swarm/swarm_fitness.hpp"

#include <optional>

#include "kinfer/estimate/poses/point_fit.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/kinematics/batch/batch_population.hpp"

namespace kinfer::calibrate {
struct SwarmFitness::Plan {
  std::optional<BatchPopulation<double>> batch;  // none: the forward kinematics of each pose is computed separately
  Chain nominal;
  ParameterSet set;
  PoseSet data;

  double slow_sum(const Chain& chain) const {
    double sum = 0.0;
    for (const double error : point_errors(chain, data)) sum += error * error;
    return sum;
  }
};

SwarmFitness::SwarmFitness(const Chain& nominal, const ParameterSet& set, const PoseSet& data) {
  auto plan = std::make_unique<Plan>(Plan{{}, nominal, set, data});
  if (data.mounting.empty() && has_batch_form(nominal, set)) plan->batch.emplace(nominal, set, point_table(data));
  plan_ = std::move(plan);
}

SwarmFitness::~SwarmFitness() = default;
SwarmFitness::SwarmFitness(SwarmFitness&&) noexcept = default;

void SwarmFitness::sums(ConstMatrixRef x, std::span<double> sum) const {
  if (plan_->batch) return plan_->batch->sums(x, sum);
  for (Eigen::Index i = 0; i < x.cols(); ++i) sum[i] = plan_->slow_sum(unpack(plan_->set, plan_->nominal, x.col(i)));
}

std::size_t SwarmFitness::points() const {
  return plan_->data.points.size();
}

}  // namespace kinfer::calibrate

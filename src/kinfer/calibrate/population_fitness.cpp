#include "kinfer/calibrate/population_fitness.hpp"

#include <optional>

#include "kinfer/estimate/point_fit.hpp"
#include "kinfer/estimate/residuals.hpp"
#include "kinfer/kinematics/batch_population.hpp"

namespace kinfer {
struct PopulationFitness::Plan {
  std::optional<BatchPopulation<double>> batch;  // none: every pose is walked from the base
  Chain nominal;
  ParameterSet set;
  PoseSet data;

  double slow_sum(const Chain& chain) const {
    double sum = 0.0;
    for (const double error : point_errors(chain, data)) sum += error * error;
    return sum;
  }
};

PopulationFitness::PopulationFitness(const Chain& nominal, const ParameterSet& set, const PoseSet& data) {
  auto plan = std::make_unique<Plan>(Plan{{}, nominal, set, data});
  if (data.mounting.empty() && has_batch_form(nominal, set)) plan->batch.emplace(nominal, set, point_table(data));
  plan_ = std::move(plan);
}

PopulationFitness::~PopulationFitness() = default;
PopulationFitness::PopulationFitness(PopulationFitness&&) noexcept = default;

void PopulationFitness::sums(ConstMatrixRef x, std::span<double> sum) const {
  if (plan_->batch) return plan_->batch->sums(x, sum);
  for (Eigen::Index i = 0; i < x.cols(); ++i) sum[i] = plan_->slow_sum(unpack(plan_->set, plan_->nominal, x.col(i)));
}

std::size_t PopulationFitness::points() const {
  return plan_->data.points.size();
}

}  // namespace kinfer

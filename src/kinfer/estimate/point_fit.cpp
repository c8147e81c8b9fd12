#include "kinfer/estimate/point_fit.hpp"

namespace kinfer {
namespace {

/// The priors' part of the cost, and of the normal equations where they are wanted.
struct Priors {
  MatrixXd information;
  VectorXd mean;

  explicit Priors(const ParameterSet& set) : mean(nominal_of(set)) {
    const MatrixXd rows = prior_rows(set);
    information = rows.transpose() * rows;
  }

  double add(ConstVectorRef x, NormalEquations* normal) const {
    const VectorXd pull = information * (x - mean);
    if (normal) {
      normal->matrix += information.triangularView<Eigen::Lower>();
      normal->gradient += pull;
    }
    return pull.dot(x - mean);
  }
};

}  // namespace

PointTable point_table(const PoseSet& data) {
  PointTable table;
  const auto count = static_cast<Eigen::Index>(data.points.size());
  table.joints.resize(data.joints.rows(), count), table.measured.resize(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const PointMeasurement& point = data.points[i];
    table.joints.col(i) = data.joints.col(point.row);
    table.measured.col(i) = point.position;
    table.target.push_back(point.target);
  }
  return table;
}

Eigen::Matrix3Xd inverse_sd(const Weights& weights) {
  Eigen::Matrix3Xd inverse(3, weights.point_sd.size());
  for (std::size_t i = 0; i < weights.point_sd.size(); ++i)
    inverse.col(static_cast<Eigen::Index>(i)) = weights.point_sd[i].cwiseInverse();
  return inverse;
}

LeastSquaresOutcome fit_points(const BatchPoints& points, const ParameterSet& set, const BatchPoints::Weights& weights,
                               ConstVectorRef start, const LeastSquaresOptions& options, const Observer& observer) {
  const Priors priors(set);
  BatchPoints::Scratch scratch;
  NormalProblem problem;
  problem.unknowns = points.unknowns();
  problem.cost = [&](ConstVectorRef x) { return points.cost(x, weights, scratch) + priors.add(x, nullptr); };
  problem.linearise = [&](ConstVectorRef x, NormalEquations& normal) {
    const double cost = points.normal_equations(x, weights, normal.matrix, normal.gradient, scratch);
    return cost + priors.add(x, &normal);
  };
  return least_squares(problem, start, options, observer);
}

}  // namespace kinfer

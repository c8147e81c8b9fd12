// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/poses/point_fit.hpp"

#include <algorithm>

#include "kinfer/linalg/products.hpp"

namespace kinfer {
namespace {

/// Contribution of the priors to the cost and, optionally, to the normal equations.
class Priors {
 public:
  explicit Priors(const ParameterSet& set) : mean_(nominal_of(set)) {
    if (set.prior_sqrt_information.size() > 0) {
      const MatrixXd rows = prior_sqrt_information_of(set);
      information_ = gram(rows);
      return;
    }
    own_.resize(mean_.size());
    Eigen::Index k = 0;
    for (const Parameter* p : set.free()) own_[k++] = 1.0 / (p->prior_sd * p->prior_sd);
  }

  double add(ConstVectorRef x, NormalEquations* normal) const {
    const VectorXd offset = x - mean_;
    VectorXd pull;
    if (information_.size() > 0)
      pull = information_ * offset;
    else
      pull = own_.cwiseProduct(offset);
    if (normal) {
      normal->gradient += pull;
      if (information_.size() > 0)
        normal->matrix += information_.triangularView<Eigen::Lower>();
      else
        normal->matrix.diagonal() += own_;
    }
    return pull.dot(offset);
  }

 private:
  VectorXd mean_;
  VectorXd own_;          // 1 / variance of each; 0 without a prior
  MatrixXd information_;  // of a joint prior, used instead
};

}  // namespace

bool has_only_points(const Chain& chain, const ParameterSet& set, const PoseSet& data) {
  const auto is_measured = [&](const ResidualKind& kind) { return kind.count(data) > 0; };
  const auto& kinds = residual_kinds();
  return data.mounting.empty() && !data.points.empty() && chain.fixtures.socket_distances.empty() &&
         std::count_if(kinds.begin(), kinds.end(), is_measured) == 1 && has_batch_form(chain, set);
}

bool has_full_covariances(const PoseSet& data) {
  return std::any_of(data.points.begin(), data.points.end(),
                     [](const PointMeasurement& point) { return point.axes.has_value(); });
}

std::vector<Mat3> whitening_matrices(const PoseSet& data, const Weights& weights) {
  std::vector<Mat3> by;
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const Mat3 along = data.points[i].axes.value_or(Mat3::Identity());
    by.push_back(weights.of<PointMeasurement>()[i].cwiseInverse().asDiagonal() * along.transpose());
  }
  return by;
}

void whiten(const std::vector<Mat3>& by, Eigen::Ref<MatrixXd> rows) {
  for (Eigen::Index k = 0; k < rows.cols(); ++k) {
    double* column = rows.col(k).data();
    for (const Mat3& w : by) {
      const double x = column[0], y = column[1], z = column[2];
      for (int i = 0; i < 3; ++i) column[i] = w(i, 0) * x + w(i, 1) * y + w(i, 2) * z;
      column += 3;
    }
  }
}

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
  Eigen::Matrix3Xd inverse(3, weights.of<PointMeasurement>().size());
  for (std::size_t i = 0; i < weights.of<PointMeasurement>().size(); ++i)
    inverse.col(static_cast<Eigen::Index>(i)) = weights.of<PointMeasurement>()[i].cwiseInverse();
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

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/poses/pose_normal_equations.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "kinfer/estimate/poses/point_fit.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer {
namespace {

/// Cost of blocks of `size` rows from row 0 on; `weight`, unless null, gets the square root of each row's robust
/// weight.
double cost_of_blocks(const BlockLoss& loss, int size, ConstVectorRef r, VectorXd* weight) {
  const double limit = loss.scale * std::sqrt(static_cast<double>(size));
  double cost = 0.0;
  for (Eigen::Index row = 0; row + size <= r.size(); row += size) {
    const auto [rho, slope] = loss_value(loss.loss, r.segment(row, size).squaredNorm(), limit);
    cost += rho;
    if (weight) weight->segment(row, size).setConstant(std::sqrt(slope));
  }
  return cost;
}

/// The measurement part of a problem.
class MeasurementCost {
 public:
  virtual ~MeasurementCost() = default;
  virtual double cost(ConstVectorRef x) = 0;
  /// Adds to the lower half and to the gradient.
  virtual double linearise(ConstVectorRef x, NormalEquations& normal) = 0;
};

/// Any kinds of measurements, block by block.
class GeneralMeasurements : public MeasurementCost {
 public:
  GeneralMeasurements(const Chain& nominal, const ParameterSet& set, const PoseSet& data, const Weights& weights,
                      BlockLoss loss)
      : nominal_(nominal),
        set_(set),
        data_(data),
        weights_(weights),
        loss_(loss),
        gravity_(gravity_torques_of_rows(nominal, data)),
        columns_(fixture_columns(nominal, set)) {}

  double cost(ConstVectorRef x) override {
    const Chain chain = unpack(set_, nominal_, x);
    evaluate_poses(chain, set_, data_, Derivative::no, gravity_, at_);
    return sum(chain, nullptr);
  }

  double linearise(ConstVectorRef x, NormalEquations& normal) override {
    const Chain chain = unpack(set_, nominal_, x);
    evaluate_poses(chain, set_, data_, Derivative::yes, gravity_, at_);
    jacobian_.resize(chunk_rows, set_.free_count());
    return sum(chain, &normal);
  }

 private:
  static constexpr Eigen::Index chunk_rows = 192;

  double sum(const Chain& chain, NormalEquations* normal) {
    double cost = 0.0;
    for (const ResidualKind& kind : residual_kinds()) {
      const std::size_t count = kind.count(data_), at_once = static_cast<std::size_t>(chunk_rows / kind.size);
      for (std::size_t first = 0; first < count; first += at_once)
        cost += chunk(chain, kind, first, std::min(count, first + at_once), normal);
    }
    return cost + socket_distances(chain, normal);
  }

  double chunk(const Chain& chain, const ResidualKind& kind, std::size_t first, std::size_t end,
               NormalEquations* normal) {
    const ResidualContext scene{chain, data_, at_, columns_};
    const auto rows = static_cast<Eigen::Index>(end - first) * kind.size;
    residuals_.resize(chunk_rows);
    VectorXd scale(rows);
    BlockRows out{residuals_, normal ? &jacobian_ : nullptr};
    for (std::size_t i = first; i < end; ++i, out.row += kind.size) {
      kind.write(scene, i, out);
      scale.segment(out.row, kind.size) = weights_.of(kind.kind)[i].head(kind.size).cwiseInverse();
    }
    residuals_.head(rows).array() *= scale.array();
    if (normal) jacobian_.topRows(rows).array().colwise() *= scale.array();
    if (kind.kind == kind_of<OrientationMeasurement>)
      whiten_couplings(scene, first, end, normal ? &jacobian_ : nullptr);
    const auto r = residuals_.head(rows);
    if (!normal) return cost_of_blocks(loss_, kind.size, r, nullptr);
    VectorXd root(rows);
    const double cost = cost_of_blocks(loss_, kind.size, r, &root);
    if (loss_.loss != Loss::none) jacobian_.topRows(rows).array().colwise() *= root.array();
    add(normal_equations(jacobian_.topRows(rows), r.cwiseProduct(root)), *normal);
    return cost;
  }

  /// Makes orientations `first` to `end`, whose weighted rows are written, independent of the points of their poses.
  void whiten_couplings(const ResidualContext& scene, std::size_t first, std::size_t end, MatrixXd* jacobian) {
    const auto before = [](const PoseCoupling& c, std::size_t i) {
      return static_cast<std::size_t>(c.orientation) < i;
    };
    const std::vector<PoseCoupling>& all = weights_.couplings;
    for (auto c = std::lower_bound(all.begin(), all.end(), first, before);
         c != all.end() && static_cast<std::size_t>(c->orientation) < end; ++c) {
      const auto row = static_cast<Eigen::Index>(3 * (static_cast<std::size_t>(c->orientation) - first));
      const Vec3 inverse_sd = weights_.of<PointMeasurement>()[c->point].cwiseInverse();
      VectorXd r(3);
      MatrixXd beside(3, jacobian ? set_.free_count() : 0);
      BlockRows out{r, jacobian ? &beside : nullptr};
      residual_kind(kind_of<PointMeasurement>).write(scene, static_cast<std::size_t>(c->point), out);
      c->whiten(residuals_.segment<3>(row), r.cwiseProduct(inverse_sd));
      if (jacobian) c->whiten(jacobian->middleRows<3>(row), inverse_sd.asDiagonal() * beside);
    }
  }

  double socket_distances(const Chain& chain, NormalEquations* normal) {
    const auto rows = static_cast<Eigen::Index>(chain.fixtures.socket_distances.size());
    if (rows == 0) return 0.0;
    VectorXd r(rows);
    MatrixXd jacobian(rows, normal ? set_.free_count() : 0);
    write_socket_distances(chain, columns_, r, normal ? &jacobian : nullptr, 0);
    if (normal) add(normal_equations(jacobian, r), *normal);
    return r.squaredNorm();
  }

  static void add(const NormalEquations& more, NormalEquations& to) {
    to.matrix += more.matrix;
    to.gradient += more.gradient;
  }

  const Chain& nominal_;
  const ParameterSet& set_;
  const PoseSet& data_;
  const Weights& weights_;
  BlockLoss loss_;
  MatrixXd gravity_;
  FixtureColumns columns_;
  EvaluatedPoses at_;
  VectorXd residuals_;
  MatrixXd jacobian_;
};

/// Points only, by the batch kernels.
class BatchPointMeasurements : public MeasurementCost {
 public:
  BatchPointMeasurements(const Chain& nominal, const ParameterSet& set, const PoseSet& data, const Weights& weights,
                         BlockLoss loss)
      : points_(nominal, set, point_table(data)),
        inverse_(inverse_sd(weights)),
        plain_(points_.weights(inverse_)),
        loss_(loss) {}

  double cost(ConstVectorRef x) override {
    return loss_.loss == Loss::none ? points_.cost(x, plain_, scratch_) : cost_of_blocks(loss_, 3, errors(x), nullptr);
  }

  double linearise(ConstVectorRef x, NormalEquations& normal) override {
    if (loss_.loss == Loss::none) return points_.normal_equations(x, plain_, normal.matrix, normal.gradient, scratch_);
    VectorXd root(inverse_.size());
    const double cost = cost_of_blocks(loss_, 3, errors(x), &root);
    const Eigen::Matrix3Xd weighted = inverse_.cwiseProduct(root.reshaped(3, inverse_.cols()));
    points_.normal_equations(x, points_.weights(weighted), normal.matrix, normal.gradient, scratch_);
    return cost;
  }

 private:
  VectorXd errors(ConstVectorRef x) {
    points_.errors(x, error_, scratch_);
    return error_.cwiseProduct(inverse_).reshaped();
  }

  BatchPoints points_;
  Eigen::Matrix3Xd inverse_, error_;
  BatchPoints::Weights plain_;
  BlockLoss loss_;
  BatchPoints::Scratch scratch_;
};

/// Points with full covariances: the kernels' rows are whitened, then accumulated.
class FullCovariancePointMeasurements : public MeasurementCost {
 public:
  FullCovariancePointMeasurements(const Chain& nominal, const ParameterSet& set, const PoseSet& data,
                                  const Weights& weights, BlockLoss loss)
      : points_(nominal, set, point_table(data)),
        unweighted_(points_.weights(Eigen::Matrix3Xd::Ones(3, points_.points()))),
        by_(whitening_matrices(data, weights)),
        loss_(loss) {}

  double cost(ConstVectorRef x) override {
    Eigen::Matrix3Xd error;
    points_.errors(x, error, scratch_);
    whiten(by_, error.reshaped());
    return cost_of_blocks(loss_, 3, error.reshaped(), nullptr);
  }

  double linearise(ConstVectorRef x, NormalEquations& normal) override {
    VectorXd r(3 * points_.points()), root(r.size());
    jacobian_.resize(r.size(), points_.unknowns());
    points_.residuals(x, unweighted_, r, jacobian_, scratch_);
    whiten(by_, r), whiten(by_, jacobian_);
    const double cost = cost_of_blocks(loss_, 3, r, &root);
    if (loss_.loss != Loss::none) jacobian_.array().colwise() *= root.array(), r.array() *= root.array();
    const NormalEquations sum = normal_equations(jacobian_, r);
    normal.matrix += sum.matrix, normal.gradient += sum.gradient;
    return cost;
  }

 private:
  BatchPoints points_;
  BatchPoints::Weights unweighted_;
  std::vector<Mat3> by_;
  BlockLoss loss_;
  MatrixXd jacobian_;
  BatchPoints::Scratch scratch_;
};

std::shared_ptr<MeasurementCost> make_measurement_cost(const Chain& nominal, const ParameterSet& set,
                                                       const PoseSet& data, const Weights& weights, BlockLoss loss) {
  if (!has_only_points(nominal, set, data))
    return std::make_shared<GeneralMeasurements>(nominal, set, data, weights, loss);
  if (has_full_covariances(data))
    return std::make_shared<FullCovariancePointMeasurements>(nominal, set, data, weights, loss);
  return std::make_shared<BatchPointMeasurements>(nominal, set, data, weights, loss);
}

}  // namespace

MatrixXd prior_information(const ParameterSet& set) {
  const MatrixXd rows = prior_sqrt_information_of(set);
  return gram(rows);
}

NormalProblem pose_normal_problem(const Chain& nominal, const ParameterSet& set, const PoseSet& data,
                                  const Weights& weights, BlockLoss loss) {
  const auto measured =
      make_measurement_cost(nominal, set, data, weights, loss);  // shared: a function must be copyable
  const auto priors = std::make_shared<const MatrixXd>(prior_information(set));
  NormalProblem problem;
  problem.unknowns = set.free_count();
  problem.cost = [measured, priors, centre = nominal_of(set)](ConstVectorRef x) {
    const VectorXd offset = x - centre;
    return measured->cost(x) + offset.dot(*priors * offset);
  };
  problem.linearise = [measured, priors, centre = nominal_of(set)](ConstVectorRef x, NormalEquations& normal) {
    const VectorXd offset = x - centre, pull = *priors * offset;
    normal.matrix = MatrixXd::Zero(x.size(), x.size());
    normal.gradient = VectorXd::Zero(x.size());
    const double cost = measured->linearise(x, normal);
    normal.matrix += priors->triangularView<Eigen::Lower>();
    normal.gradient += pull;
    return cost + offset.dot(pull);
  };
  return problem;
}

}  // namespace kinfer

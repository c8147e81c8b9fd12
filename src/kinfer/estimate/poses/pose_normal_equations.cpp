// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/poses/pose_normal_equations.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "kinfer/base/parallel.hpp"
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

/// Any kinds of measurements, chunk by chunk. The sums are taken in the order of the chunks, whatever the threads.
class GeneralMeasurements : public MeasurementCost {
 public:
  GeneralMeasurements(const Chain& nominal, const ParameterSet& set, const PoseSet& data, const Weights& weights,
                      BlockLoss loss, int threads)
      : nominal_(nominal),
        set_(set),
        data_(data),
        weights_(weights),
        loss_(loss),
        threads_(threads),
        gravity_(gravity_torques_of_rows(nominal, data, threads)),
        columns_(fixture_columns(nominal, set)),
        buffers_(buffer_count) {
    for (const ResidualKind& kind : residual_kinds()) {
      const std::size_t count = kind.count(data_), at_once = static_cast<std::size_t>(chunk_rows / kind.size);
      for (std::size_t first = 0; first < count; first += at_once)
        chunks_.push_back({&kind, first, std::min(count, first + at_once)});
    }
  }

  double cost(ConstVectorRef x) override {
    const Chain chain = unpack(set_, nominal_, x);
    evaluate_poses(chain, set_, data_, Derivative::no, gravity_, at_, threads_);
    return sum(chain, nullptr);
  }

  double linearise(ConstVectorRef x, NormalEquations& normal) override {
    const Chain chain = unpack(set_, nominal_, x);
    evaluate_poses(chain, set_, data_, Derivative::yes, gravity_, at_, threads_);
    return sum(chain, &normal);
  }

 private:
  static constexpr Eigen::Index chunk_rows = 192;
  static constexpr std::size_t buffer_count = 16;  // chunks at once

  struct Chunk {
    const ResidualKind* kind;
    std::size_t first, end;
  };

  struct Buffer {
    VectorXd residuals;
    MatrixXd jacobian;
    double cost = 0.0;
    NormalEquations normal;
  };

  double sum(const Chain& chain, NormalEquations* normal) {
    double cost = 0.0;
    for (std::size_t first = 0; first < chunks_.size(); first += buffer_count) {
      const std::size_t count = std::min(buffer_count, chunks_.size() - first);
      parallel_for(count, threads_,
                   [&](std::size_t k) { evaluate(chain, chunks_[first + k], normal != nullptr, buffers_[k]); });
      for (std::size_t k = 0; k < count; ++k) {
        cost += buffers_[k].cost;
        if (normal) add(buffers_[k].normal, *normal);
      }
    }
    return cost + socket_distances(chain, normal);
  }

  void evaluate(const Chain& chain, const Chunk& chunk, bool is_linearised, Buffer& to) const {
    const ResidualKind& kind = *chunk.kind;
    const ResidualContext scene{chain, data_, at_, columns_};
    const auto rows = static_cast<Eigen::Index>(chunk.end - chunk.first) * kind.size;
    to.residuals.resize(chunk_rows);
    if (is_linearised) to.jacobian.resize(chunk_rows, set_.free_count());
    VectorXd scale(rows);
    BlockRows out{to.residuals, is_linearised ? &to.jacobian : nullptr};
    for (std::size_t i = chunk.first; i < chunk.end; ++i, out.row += kind.size) {
      kind.write(scene, i, out);
      scale.segment(out.row, kind.size) = weights_.of(kind.kind)[i].head(kind.size).cwiseInverse();
    }
    to.residuals.head(rows).array() *= scale.array();
    if (is_linearised) to.jacobian.topRows(rows).array().colwise() *= scale.array();
    if (kind.kind == kind_of<OrientationMeasurement>) whiten_couplings(scene, chunk, is_linearised, to);
    const auto r = to.residuals.head(rows);
    VectorXd root(is_linearised ? rows : 0);
    to.cost = cost_of_blocks(loss_, kind.size, r, is_linearised ? &root : nullptr);
    if (!is_linearised) return;
    if (loss_.loss != Loss::none) to.jacobian.topRows(rows).array().colwise() *= root.array();
    to.normal = normal_equations(to.jacobian.topRows(rows), r.cwiseProduct(root));
  }

  /// Makes the orientations of a chunk, whose weighted rows are written, independent of the points of their poses.
  void whiten_couplings(const ResidualContext& scene, const Chunk& chunk, bool is_linearised, Buffer& to) const {
    const auto before = [](const PoseCoupling& c, std::size_t i) {
      return static_cast<std::size_t>(c.orientation) < i;
    };
    const std::vector<PoseCoupling>& all = weights_.couplings;
    for (auto c = std::lower_bound(all.begin(), all.end(), chunk.first, before);
         c != all.end() && static_cast<std::size_t>(c->orientation) < chunk.end; ++c) {
      const auto row = static_cast<Eigen::Index>(3 * (static_cast<std::size_t>(c->orientation) - chunk.first));
      const Vec3 inverse_sd = weights_.of<PointMeasurement>()[c->point].cwiseInverse();
      VectorXd r(3);
      MatrixXd beside(3, is_linearised ? set_.free_count() : 0);
      BlockRows out{r, is_linearised ? &beside : nullptr};
      residual_kind(kind_of<PointMeasurement>).write(scene, static_cast<std::size_t>(c->point), out);
      c->whiten(to.residuals.segment<3>(row), r.cwiseProduct(inverse_sd));
      if (is_linearised) c->whiten(to.jacobian.middleRows<3>(row), inverse_sd.asDiagonal() * beside);
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
  int threads_;
  MatrixXd gravity_;
  FixtureColumns columns_;
  EvaluatedPoses at_;
  std::vector<Chunk> chunks_;
  std::vector<Buffer> buffers_;
};

PointTable part_of(const PointTable& points, Eigen::Index first, Eigen::Index count) {
  return {points.joints.middleCols(first, count),
          points.measured.middleCols(first, count),
          {points.target.begin() + first, points.target.begin() + first + count}};
}

/// Points only, by the batch kernels, in parts of fixed size whose sums are taken in their order, whatever the threads.
class BatchPointMeasurements : public MeasurementCost {
 public:
  BatchPointMeasurements(const Chain& nominal, const ParameterSet& set, const PoseSet& data, const Weights& weights,
                         BlockLoss loss, int threads)
      : loss_(loss), threads_(threads) {
    const PointTable table = point_table(data);
    const Eigen::Matrix3Xd inverse = inverse_sd(weights);
    for (Eigen::Index first = 0; first == 0 || first < inverse.cols(); first += part_points) {
      const Eigen::Index count = std::min(part_points, inverse.cols() - first);
      BatchPoints points(nominal, set, part_of(table, first, count));
      BatchPoints::Weights plain = points.weights(inverse.middleCols(first, count));
      parts_.push_back({std::move(points), std::move(plain), inverse.middleCols(first, count)});
    }
  }

  double cost(ConstVectorRef x) override {
    parallel_for(parts_.size(), threads_, [&](std::size_t k) {
      Part& part = parts_[k];
      part.cost = loss_.loss == Loss::none ? part.points.cost(x, part.plain, part.scratch)
                                           : cost_of_blocks(loss_, 3, errors(part, x), nullptr);
    });
    return total_cost();
  }

  double linearise(ConstVectorRef x, NormalEquations& normal) override {
    parallel_for(parts_.size(), threads_, [&](std::size_t k) { linearise(parts_[k], x); });
    for (const Part& part : parts_) normal.matrix += part.normal.matrix, normal.gradient += part.normal.gradient;
    return total_cost();
  }

 private:
  static constexpr Eigen::Index part_points = 1024;

  struct Part {
    BatchPoints points;
    BatchPoints::Weights plain;
    Eigen::Matrix3Xd inverse, error{};
    BatchPoints::Scratch scratch{};
    double cost = 0.0;
    NormalEquations normal{};
  };

  void linearise(Part& part, ConstVectorRef x) const {
    if (loss_.loss == Loss::none) {
      part.cost = part.points.normal_equations(x, part.plain, part.normal.matrix, part.normal.gradient, part.scratch);
      return;
    }
    VectorXd root(part.inverse.size());
    part.cost = cost_of_blocks(loss_, 3, errors(part, x), &root);
    const Eigen::Matrix3Xd weighted = part.inverse.cwiseProduct(root.reshaped(3, part.inverse.cols()));
    part.points.normal_equations(x, part.points.weights(weighted), part.normal.matrix, part.normal.gradient,
                                 part.scratch);
  }

  static VectorXd errors(Part& part, ConstVectorRef x) {
    part.points.errors(x, part.error, part.scratch);
    return part.error.cwiseProduct(part.inverse).reshaped();
  }

  double total_cost() const {
    double sum = 0.0;
    for (const Part& part : parts_) sum += part.cost;
    return sum;
  }

  std::vector<Part> parts_;
  BlockLoss loss_;
  int threads_;
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
                                                       const PoseSet& data, const Weights& weights, BlockLoss loss,
                                                       int threads) {
  if (!has_only_points(nominal, set, data))
    return std::make_shared<GeneralMeasurements>(nominal, set, data, weights, loss, threads);
  if (has_full_covariances(data))
    return std::make_shared<FullCovariancePointMeasurements>(nominal, set, data, weights, loss);
  return std::make_shared<BatchPointMeasurements>(nominal, set, data, weights, loss, threads);
}

}  // namespace

MatrixXd prior_information(const ParameterSet& set) {
  const MatrixXd rows = prior_sqrt_information_of(set);
  return gram(rows);
}

NormalProblem pose_normal_problem(const Chain& nominal, const ParameterSet& set, const PoseSet& data,
                                  const Weights& weights, BlockLoss loss, int threads) {
  const auto measured =
      make_measurement_cost(nominal, set, data, weights, loss, threads);  // shared: a function must be copyable
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

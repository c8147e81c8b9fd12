// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/poses/pose_residuals.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <utility>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/parallel.hpp"
#include "kinfer/estimate/poses/point_fit.hpp"
#include "kinfer/kinematics/poses/batch_poses.hpp"

namespace kinfer {
namespace {

/// The parameter set for one mounting's evaluator: that mounting's base and tool take the place of the chain's;
/// parameters of other mountings have no effect.
ParameterSet parameters_of_mounting(ParameterSet set, const Chain& chain, int mounting) {
  if (mounting < 0) return set;
  const bool own_base = chain.mountings[mounting].base.has_value();
  for (Parameter& parameter : set.parameters) {
    auto* frame = std::get_if<FrameNumber>(&parameter.at);
    if (!frame) continue;
    if (frame->mounting == mounting)
      frame->mounting = -1;
    else if (frame->mounting < 0 && (frame->frame == SetupFrame::tool || own_base))
      parameter.at = GravityNumber{Field::x};  // affects no pose
  }
  return set;
}

/// Calls visit(mounting, rows) for −1 (the chain's own) and each further mounting with the rows measured there.
template <class Visit>
void for_each_mounting(const Chain& chain, const PoseSet& data, Visit visit) {
  const auto mountings = data.mounting.empty() ? 0 : static_cast<int>(chain.mountings.size());
  for (int mounting = -1; mounting < mountings; ++mounting) {
    std::vector<Eigen::Index> rows;
    for (Eigen::Index row = 0; row < data.rows(); ++row)
      if (data.mounting.empty() || data.mounting[row] == mounting) rows.push_back(row);
    visit(mounting, rows);
  }
}

/// `rows`: from prior_sqrt_information_of, computed once per problem.
void write_priors(const MatrixXd& rows, const VectorXd& nominal, ConstVectorRef x, VectorXd& r, MatrixXd* jacobian,
                  Eigen::Index row) {
  r.segment(row, rows.rows()) = rows * (x - nominal);
  if (jacobian) jacobian->middleRows(row, rows.rows()) = rows;
}

/// 1 / sd of every measured row, in the order of the blocks.
VectorXd row_weights(const Weights& weights) {
  Eigen::Index rows = 0, row = 0;
  for (const ResidualKind& kind : residual_kinds())
    rows += static_cast<Eigen::Index>(weights.of(kind.kind).size()) * kind.size;
  VectorXd inverse_sd(rows);
  for (const ResidualKind& kind : residual_kinds())
    for (const Vec3& sd : weights.of(kind.kind))
      for (int k = 0; k < kind.size; ++k) inverse_sd[row++] = 1.0 / sd[k];
  return inverse_sd;
}

/// Weighted rows of all measurements, block by block. Returns how many.
Eigen::Index write_blocks(const ResidualContext& scene, const VectorXd& inverse_sd,
                          const std::vector<PoseCoupling>& couplings, VectorXd& r, MatrixXd* jacobian) {
  const PoseSet& data = scene.data;
  BlockRows out{r, jacobian};
  for (const ResidualKind& kind : residual_kinds())
    for (std::size_t i = 0; i < kind.count(data); ++i, out.row += kind.size) kind.write(scene, i, out);
  r.head(out.row).array() *= inverse_sd.array();
  if (jacobian) jacobian->topRows(out.row).array().colwise() *= inverse_sd.array();
  const auto first_turn = static_cast<Eigen::Index>(3 * data.points.size());  // orientations follow the points
  for (const PoseCoupling& c : couplings) {
    const Eigen::Index turn = first_turn + 3 * c.orientation, point = 3 * c.point;
    c.whiten(r.segment<3>(turn), r.segment<3>(point));
    if (jacobian) c.whiten(jacobian->middleRows<3>(turn), jacobian->middleRows<3>(point));
  }
  return out.row;
}

/// Writes the rows of all measurements and socket distances.
using MeasuredRows = std::function<void(ConstVectorRef x, VectorXd& r, MatrixXd* jacobian)>;

/// Any kinds of measurements, block by block.
MeasuredRows general_rows(const Chain& nominal, const ParameterSet& set, const PoseSet& data, const Weights& weights,
                          int threads) {
  return [&nominal, &set, &data, threads, inverse_sd = row_weights(weights), &couplings = weights.couplings](
             ConstVectorRef x, VectorXd& r, MatrixXd* jacobian) {
    const Chain chain = unpack(set, nominal, x);
    const EvaluatedPoses at = evaluate_poses(chain, set, data, jacobian ? Derivative::yes : Derivative::no, threads);
    const FixtureColumns columns = fixture_columns(chain, set);
    const Eigen::Index row = write_blocks({chain, data, at, columns}, inverse_sd, couplings, r, jacobian);
    write_socket_distances(chain, columns, r, jacobian, row);
  };
}

/// Points only, by the batch kernels. The result must be copyable but the kernels' data are not: they are shared.
MeasuredRows batch_point_rows(const Chain& nominal, const ParameterSet& set, const PoseSet& data,
                              const Weights& weights) {
  const Eigen::Matrix3Xd inverse = inverse_sd(weights);
  auto points = std::make_shared<const BatchPoints>(nominal, set, point_table(data));
  auto lane_weights = std::make_shared<const BatchPoints::Weights>(points->weights(inverse));
  return [points, lane_weights, inverse](ConstVectorRef x, VectorXd& r, MatrixXd* jacobian) {
    BatchPoints::Scratch scratch;
    if (jacobian) {
      points->residuals(x, *lane_weights, r.head(inverse.size()), jacobian->topRows(inverse.size()), scratch);
    } else {
      Eigen::Matrix3Xd error;
      points->errors(x, error, scratch);
      r.head(inverse.size()) = error.cwiseProduct(inverse).reshaped();
    }
  };
}

/// The same for points with full covariances: the rows are whitened after the kernels.
MeasuredRows full_covariance_point_rows(const Chain& nominal, const ParameterSet& set, const PoseSet& data,
                                        const Weights& weights) {
  auto points = std::make_shared<const BatchPoints>(nominal, set, point_table(data));
  const Eigen::Matrix3Xd ones = Eigen::Matrix3Xd::Ones(3, points->points());
  auto unweighted = std::make_shared<const BatchPoints::Weights>(points->weights(ones));
  return
      [points, unweighted, by = whitening_matrices(data, weights)](ConstVectorRef x, VectorXd& r, MatrixXd* jacobian) {
        BatchPoints::Scratch scratch;
        const Eigen::Index rows = 3 * points->points();
        if (jacobian) {
          points->residuals(x, *unweighted, r.head(rows), jacobian->topRows(rows), scratch);
          whiten(by, jacobian->topRows(rows));
        } else {
          Eigen::Matrix3Xd error;
          points->errors(x, error, scratch);
          r.head(rows) = error.reshaped();
        }
        whiten(by, r.head(rows));
      };
}

MeasuredRows rows_of(const Chain& nominal, const ParameterSet& set, const PoseSet& data, const Weights& weights,
                     int threads) {
  if (!has_only_points(nominal, set, data)) return general_rows(nominal, set, data, weights, threads);
  return has_full_covariances(data) ? full_covariance_point_rows(nominal, set, data, weights)
                                    : batch_point_rows(nominal, set, data, weights);
}

/// On up to `threads` threads, a block of rows at a time.
template <class Body>
void for_each_block(std::span<const Eigen::Index> rows, int threads, Body body) {
  constexpr std::size_t size = 128;
  parallel_for((rows.size() + size - 1) / size, threads,
               [&](std::size_t b) { body(rows.subspan(size * b, std::min(size, rows.size() - size * b))); });
}

}  // namespace

Load load_at(const Chain& chain, const PoseSet& data, Eigen::Index row) {
  const auto column = [&](const MatrixXd& matrix) {
    return matrix.size() == 0
               ? std::span<const double>{}
               : std::span<const double>(matrix.col(row).data(), static_cast<std::size_t>(matrix.rows()));
  };
  Load load;
  if (!data.payload.empty()) load.payload = data.payload[row];
  if (!data.temperature.empty() && std::isfinite(data.temperature[row]))
    load.temperature_rise = data.temperature[row] - chain.reference_temperature;
  load.torques = column(data.torques);
  load.approach = column(data.approach);
  return load;
}

EvaluatedPoses evaluate_poses(const Chain& chain, const ParameterSet& set, const PoseSet& data, Derivative derivative,
                              int threads) {
  EvaluatedPoses at;
  evaluate_poses(chain, set, data, derivative, {}, at, threads);
  return at;
}

void evaluate_poses(const Chain& chain, const ParameterSet& set, const PoseSet& data, Derivative derivative,
                    const MatrixXd& gravity, EvaluatedPoses& at, int threads) {
  at.pose.resize(data.rows());
  if (derivative == Derivative::yes) at.twists.resize(data.rows());
  for_each_mounting(chain, data, [&](int mounting, const auto& rows) {
    const BatchPoses batch(with_mounting(chain, mounting), parameters_of_mounting(set, chain, mounting));
    for_each_block(rows, threads, [&](std::span<const Eigen::Index> block) {
      thread_local std::vector<PoseRow> inputs;  // kept between calls: runs at every step of every fit
      thread_local BatchPoses::Scratch scratch;
      inputs.clear();
      for (const Eigen::Index row : block) {
        PoseRow& input = inputs.emplace_back(PoseRow{data.joints.col(row).data(), load_at(chain, data, row)});
        if (gravity.size() > 0)
          input.load.gravity = {gravity.col(row).data(), static_cast<std::size_t>(gravity.rows())};
        input.pose = &at.pose[row];
        if (derivative == Derivative::yes) input.twists = &at.twists[row];
      }
      batch.evaluate(inputs, scratch);
    });
  });
}

MatrixXd gravity_torques_of_rows(const Chain& chain, const PoseSet& data, int threads) {
  const bool loaded = std::any_of(data.payload.begin(), data.payload.end(), [](double kg) { return kg != 0.0; });
  if (chain.masses.empty() && !loaded) return {};
  MatrixXd torques(static_cast<Eigen::Index>(chain.joints.size()), data.rows());
  for_each_mounting(chain, data, [&](int mounting, const auto& rows) {
    const Chain here = with_mounting(chain, mounting);
    for_each_block(rows, threads, [&](std::span<const Eigen::Index> block) {
      for (const Eigen::Index row : block)
        torques.col(row) = gravity_torques(here, data.joints.col(row), load_at(chain, data, row));
    });
  });
  return torques;
}

VectorXd weighted_residuals(const ResidualContext& scene, const Weights& weights) {
  const VectorXd inverse_sd = row_weights(weights);
  VectorXd r(inverse_sd.size());
  write_blocks(scene, inverse_sd, weights.couplings, r, nullptr);
  return r;
}

void write_socket_distances(const Chain& chain, const FixtureColumns& columns, VectorXd& r, MatrixXd* jacobian,
                            Eigen::Index row) {
  constexpr FixtureKind sockets = fixture_kind("socket");
  const Fixtures& around = chain.fixtures;
  for (const SocketDistance& known : around.socket_distances) {
    const Vec3 apart = around.sockets[known.a].xyz - around.sockets[known.b].xyz;
    const double length = apart.norm(), inverse_sd = 1.0 / std::max(known.sd, noise_free_sd);
    r[row] = inverse_sd * (known.distance - length);
    if (jacobian) {
      jacobian->row(row).setZero();
      const Vec3 along = length > 0.0 ? Vec3(apart / length) : Vec3::UnitX().eval();
      for (int k = 0; k < 3; ++k) {
        if (const auto column = columns.of(sockets, known.a)[k]; column >= 0)
          (*jacobian)(row, column) = -inverse_sd * along[k];
        if (const auto column = columns.of(sockets, known.b)[k]; column >= 0)
          (*jacobian)(row, column) = inverse_sd * along[k];
      }
    }
    ++row;
  }
}

Residuals pose_residuals(const Chain& nominal, const ParameterSet& set, const PoseSet& data, const Weights& weights,
                         int threads) {
  Residuals problem;
  problem.unknowns = set.free_count();
  Eigen::Index measured = 0;
  for (const ResidualKind& kind : residual_kinds()) {
    KINFER_EXPECT(weights.of(kind.kind).size() == kind.count(data), "{} weights of {}", weights.of(kind.kind).size(),
                  kind.count(data));
    problem.blocks.insert(problem.blocks.end(), kind.count(data), kind.size);
    measured += static_cast<Eigen::Index>(kind.count(data)) * kind.size;
  }
  const auto distances = static_cast<Eigen::Index>(nominal.fixtures.socket_distances.size());
  const Eigen::Index unknowns = problem.unknowns, rows = measured + distances + unknowns;
  problem.rows = rows;
  problem.evaluate = [write_measured = rows_of(nominal, set, data, weights, threads), unknowns, rows,
                      priors = prior_sqrt_information_of(set),
                      centre = nominal_of(set)](ConstVectorRef x, VectorXd& r, MatrixXd* jacobian) {
    r.resize(rows);
    if (jacobian) jacobian->resize(rows, unknowns);
    write_measured(x, r, jacobian);
    write_priors(priors, centre, x, r, jacobian, rows - unknowns);
  };
  return problem;
}

namespace {

enum class ErrorUnit { of_residual, metres };
std::vector<double> errors_of(const ResidualKind& kind, const Chain& chain, const PoseSet& data, ErrorUnit unit) {
  const ParameterSet nothing;
  const EvaluatedPoses at = evaluate_poses(chain, nothing, data, Derivative::no);
  const FixtureColumns columns = fixture_columns(chain, nothing);
  const ResidualContext scene{chain, data, at, columns};
  VectorXd residual = VectorXd::Zero(3);
  std::vector<double> errors(kind.count(data));
  for (std::size_t i = 0; i < errors.size(); ++i) {
    BlockRows out{residual, nullptr, 0};
    kind.write(scene, i, out);
    errors[i] = residual.head(kind.size).norm() * (unit == ErrorUnit::metres ? kind.metres(scene, i) : 1.0);
  }
  return errors;
}

}  // namespace

std::vector<double> residual_norms(MeasurementKind kind, const Chain& chain, const PoseSet& data) {
  return errors_of(residual_kind(kind), chain, data, ErrorUnit::of_residual);
}

std::vector<double> position_errors(MeasurementKind kind, const Chain& chain, const PoseSet& data) {
  return errors_of(residual_kind(kind), chain, data, ErrorUnit::metres);
}

std::vector<double> point_errors(const Chain& chain, const PoseSet& data) {
  return residual_norms(kind_of<PointMeasurement>, chain, data);
}

std::vector<double> orientation_errors(const Chain& chain, const PoseSet& data) {
  return residual_norms(kind_of<OrientationMeasurement>, chain, data);
}

}  // namespace kinfer

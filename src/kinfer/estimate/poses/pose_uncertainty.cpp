// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/poses/pose_uncertainty.hpp"

#include <cmath>
#include <limits>

#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/geometry/rotation.hpp"
#include "kinfer/kinematics/parameters.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

using Eigen::Index;

/// The parameters that the chain has, and what belongs to them of the model.
struct KnownParameters {
  ParameterSet set;
  MatrixXd root;
  VectorXd beyond;
};

KnownParameters known_parameters(const Chain& chain, const PredictionModel& model) {
  const auto addresses = addresses_by_name(chain);
  KnownParameters known;
  std::vector<Index> rows;
  for (std::size_t k = 0; k < model.parameters.size(); ++k) {
    const auto found = addresses.find(model.parameters[k]);
    if (found == addresses.end()) continue;
    known.set.parameters.push_back(parameter_at(chain, found->second, std::numeric_limits<double>::infinity()));
    rows.push_back(static_cast<Index>(k));
  }
  known.root = model.root(rows, Eigen::all);
  if (model.beyond.size() > 0) known.beyond = model.beyond(rows);
  return known;
}

}  // namespace

std::vector<PoseUncertainty> pose_uncertainties(const Chain& chain, const PredictionModel& model, const PoseSet& rows,
                                                int threads) {
  const KnownParameters known = known_parameters(chain, model);
  const EvaluatedPoses at = evaluate_poses(chain, known.set, rows, Derivative::yes, threads);
  const FieldRoots roots = roots_of(chain.field);
  const std::vector<PredictedPose> predicted = predicted_with_spread(chain, model, rows, threads);
  std::vector<PoseUncertainty> all;
  for (Index row = 0; row < rows.rows(); ++row) {
    const Chain mounted =
        with_mounting(chain, rows.mounting.empty() ? -1 : rows.mounting[static_cast<std::size_t>(row)]);
    const Mat3 world_R_base = mounted.base.pose().rotation;
    const MatrixXd by_root = at.twists[static_cast<std::size_t>(row)] * known.root;
    MatrixXd model_error = model_error_at(model, rows.joints.col(row));
    model_error.diagonal().head<3>().array() += displacement_variance(chain.field, roots, rows.joints.col(row));
    const auto block = [&](Index from) {
      const MatrixXd part = by_root.middleRows(from, 3);
      const Mat3 error = model_error.block<3, 3>(from, from);
      return Mat3(part * part.transpose() + world_R_base * error * world_R_base.transpose());
    };
    const auto& [pose, weight, shift, turn] = predicted[static_cast<std::size_t>(row)];
    // w (1 − w) d dᵀ of the mixture, and (1 − w)² d dᵀ of a truth with the corrections everywhere.
    all.push_back(
        {block(0) + (1.0 - weight) * shift * shift.transpose(), block(3) + (1.0 - weight) * turn * turn.transpose()});
  }
  return all;
}

Chain chain_with_corrections(const Chain& chain, const PredictionModel& model, double weight) {
  if (model.beyond.size() == 0 || weight == 1.0) return chain;
  const auto [set, root, beyond] = known_parameters(chain, model);
  Chain faded = unpack(set, chain, pack(set, chain) + (1.0 - weight) * beyond);
  faded.field.coefficients *= weight;
  return faded;
}

std::vector<PredictedPose> predicted_with_spread(const Chain& chain, const std::optional<PredictionModel>& model,
                                                 const PoseSet& rows, int threads) {
  const std::vector<Pose> near = evaluate_poses(chain, {}, rows, Derivative::no, threads).pose;
  std::vector<PredictedPose> predicted;
  for (const Pose& pose : near) predicted.push_back({pose});
  if (!model || model->beyond.size() == 0) return predicted;
  // The two differ by millimetres and milliradians: the pose between them is that of the parameters between them.
  const std::vector<Pose> far =
      evaluate_poses(chain_with_corrections(chain, *model, 0.0), {}, rows, Derivative::no, threads).pose;
  for (std::size_t i = 0; i < near.size(); ++i) {
    const double weight = correction_weight(*model, rows.joints.col(static_cast<Index>(i))), part = 1.0 - weight;
    const Vec3 turn = log_so3(far[i].rotation * near[i].rotation.transpose()),
               shift = far[i].position - near[i].position;
    predicted[i].pose = {exp_so3(part * turn) * near[i].rotation, near[i].position + part * shift};
    predicted[i].weight = weight, predicted[i].shift = shift, predicted[i].turn = turn;
  }
  return predicted;
}

std::vector<Pose> predicted_poses(const Chain& chain, const std::optional<PredictionModel>& model,
                                  const PoseSet& rows) {
  std::vector<Pose> poses;
  for (const PredictedPose& predicted : predicted_with_spread(chain, model, rows)) poses.push_back(predicted.pose);
  return poses;
}

MatrixXd covariance_root(ConstMatrixRef covariance) {
  // Scaled to unit variances first: parameters have very different units.
  const VectorXd sd = covariance.diagonal().cwiseMax(1e-300).cwiseSqrt();
  const MatrixXd scaled = sd.cwiseInverse().asDiagonal() * covariance * sd.cwiseInverse().asDiagonal();
  const SymmetricEigen eigen = symmetric_eigen(scaled);
  const MatrixXd root = sd.asDiagonal() * eigen.vectors * eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
  return triangular_factor(root.transpose()).transpose();
}

}  // namespace kinfer

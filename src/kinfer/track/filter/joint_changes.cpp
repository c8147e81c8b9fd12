// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/filter/joint_changes.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/track/model/thresholds.hpp"

namespace kinfer::track {
namespace {

using Change = Eigen::Matrix<double, 6, 1>;
using ChangeMatrix = Eigen::Matrix<double, 6, 6>;

/// By blocks of three rows.
ChangeMatrix inverse_of(const ChangeMatrix& a) {
  const Mat3 p = a.topLeftCorner<3, 3>(), r = a.topRightCorner<3, 3>(), q = a.bottomRightCorner<3, 3>();
  const Mat3 q_inverse = q.inverse();
  const Mat3 first = (p - r * q_inverse * r.transpose()).inverse();
  const Mat3 cross = -first * r * q_inverse;
  ChangeMatrix inverse;
  inverse << first, cross, cross.transpose(), q_inverse - q_inverse * r.transpose() * cross;
  return inverse;
}

/// How far a change exceeds its covariance, forgotten within a second.
void follow_excess(double& excess, const Vec3& change, const Mat3& covariance) {
  const double x = std::min(change.dot(covariance.inverse() * change) / 3.0, max_inflation);
  excess = std::max(0.0, excess + joint_change_gain * (x - 1.0 - excess));
}

}  // namespace

JointChanges::JointChanges(const FilterModel& model) {
  const Index rows = model.layout.rows();
  for (std::size_t j = 0; j < model.joints.size(); ++j) joints_.push_back({.rows = MatrixXd::Zero(rows, 6)});
  by_change_.assign(model.bodies.size(), Eigen::Matrix<double, 9, 6>::Zero());
  whitened_rows_ = MatrixXd::Zero(rows, 6);
}

void JointChanges::doubt(std::size_t joint, bool is_doubted) {
  joints_[joint].is_doubted = is_doubted;
  joints_[joint].rate = joints_[joint].force = 0.0;
}

bool JointChanges::doubts_any() const {
  return std::ranges::any_of(joints_, &Joint::is_doubted);
}

void JointChanges::form(const FilterModel& model, const ChainEvaluator& evaluator, const std::vector<bool>& is_measured,
                        bool is_base_still) {
  const auto measures = [&](std::size_t s) { return is_measured[2 * s] && is_measured[2 * s + 1]; };
  std::size_t measured = is_base_still ? 1 : 0;
  for (std::size_t s = 0; s < model.sensors.size(); ++s) measured += measures(s);
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const JointBranch& branch = model.joints[j];
    const auto beyond = static_cast<std::size_t>(std::ranges::count_if(branch.sensors, measures));
    Joint& joint = joints_[j];
    joint.is_told = beyond >= 2 && measured >= beyond + 2;
    if (!joint.is_told) continue;
    for (const std::size_t b : branch.bodies) {
      auto& by_change = by_change_[b];
      if (b == branch.bodies.front())
        by_change << Mat3::Identity(), Mat3::Zero(), Eigen::Matrix<double, 3, 6>::Zero(), Mat3::Zero(),
            Mat3::Identity();
      else
        by_change.noalias() =
            evaluator.by_parent(b).lazyProduct(by_change_[static_cast<std::size_t>(model.bodies[b].parent)]);
    }
    joint.rows.setZero();
    for (const std::size_t s : branch.sensors) {
      if (!measures(s)) continue;
      const auto& by_change = by_change_[static_cast<std::size_t>(model.sensors[s].body)];
      const Index row = sensor_rows * static_cast<Index>(s);
      joint.rows.middleRows<3>(row) = by_change.topRows<3>();
      joint.rows.middleRows<3>(row + 3) = by_change.bottomRows<3>();
    }
  }
}

void JointChanges::examine(ConstMatrixRef inverse, ConstVectorRef whitened, bool are_doubted) {
  const Index rows = whitened_rows_.rows(), all = inverse.rows();
  for (Joint& joint : joints_) {
    if (joint.is_doubted != are_doubted) continue;
    joint.distance = 0.0;
    if (!joint.is_told) continue;
    ChangeMatrix a = ChangeMatrix::Zero();
    Change b = Change::Zero();
    // L⁻¹ F row by row: a row of the constraints behind those of the sensors counts as well.
    for (Index i = 0; i < all; ++i) {
      Change row = Change::Zero();
      for (Index k = 0; k < std::min(i + 1, rows); ++k) row += inverse(i, k) * joint.rows.row(k).transpose();
      a += row * row.transpose();
      b += whitened[i] * row;
    }
    joint.covariance = inverse_of(a);
    const Change change = joint.covariance * b;
    joint.distance = b.dot(change);
    if (!joint.is_doubted) continue;
    follow_excess(joint.rate, change.head<3>(), joint.covariance.topLeftCorner<3, 3>());
    follow_excess(joint.force, change.tail<3>(), joint.covariance.bottomRightCorner<3, 3>());
  }
}

void JointChanges::widen(MatrixRef s) const {
  for (const Joint& joint : joints_) {
    if (!joint.is_doubted || !joint.is_told) continue;
    Change scale;
    scale << Vec3::Constant(std::sqrt(joint.rate)), Vec3::Constant(std::sqrt(joint.force));
    const ChangeMatrix q = scale.asDiagonal() * joint.covariance * scale.asDiagonal();
    for (Index j = 0; j < joint.rows.rows(); ++j) {
      const Change by = q * joint.rows.row(j).transpose();
      for (Index i = j; i < joint.rows.rows(); ++i) s(i, j) += joint.rows.row(i).dot(by);
    }
  }
}

}  // namespace kinfer::track

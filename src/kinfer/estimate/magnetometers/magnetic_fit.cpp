// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/magnetometers/magnetic_fit.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/estimate/magnetometers/heading_scan.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;
using FieldDerivative = Eigen::Matrix<double, 3, Eigen::Dynamic>;

constexpr int most_rounds = 20, least_rounds = 8, first_noise_update = 2;
constexpr double converged_rotation = 1e-5;  // [rad] of the rotations
constexpr double longest_step = 0.3;         // [rad]
constexpr double first_noise = 0.03;         // of the field, before there are residuals
constexpr double least_noise = 1e-4;  // of the field: what is less noisy is simulated, and its equations are singular
constexpr double first_hard_iron = 0.1;  // of the field
constexpr double first_soft_iron = 0.05;
constexpr double no_information = 1e-4;  // [1/rad²] keeps rotations that no magnetometer shows where they are

struct IronEquations {
  MatrixXd matrix;
  VectorXd right;
};

class MagneticLeastSquares {
 public:
  MagneticLeastSquares(const MagneticRecording& recording, const std::vector<SubtreeRotation>& rotations,
                       const IronPrior& least, ConstMatrixRef information)
      : recording_(recording), model_(recording, rotations), least_(least), information_(information) {
    iron_ = {std::max(least.hard_iron, first_hard_iron * recording.strength),
             std::max(least.soft_iron, first_soft_iron), least.misalignment};
    x_ = scan_headings(model_, information, iron_.hard_iron);
    for (const MagneticSeries& series : recording.sensors) {
      AutoregressiveNoise noise{.sd = first_noise * recording.strength, .weight = {}};
      for (std::size_t t = 0; t < recording.bins; ++t)
        noise.weight.push_back(t >= autoregressive_order && series.is_valid[t] ? 1.0 : 0.0);
      noise_.push_back(std::move(noise));
    }
  }

  std::optional<MagneticFit> run() {
    for (int i = 0; i < most_rounds; ++i) {
      if (i >= first_noise_update) update_noise();
      IronEquations normal = equations();
      normal.matrix.topLeftCorner(rotations(), rotations()) += information_;
      normal.right.head(rotations()) -= information_ * x_.rotation;
      const auto step = solve_spd(normal.matrix, normal.right), covariance_diagonal = variances(normal.matrix);
      if (!step || !covariance_diagonal) return std::nullopt;
      const double size = rotations() > 0 ? step->head(rotations()).cwiseAbs().maxCoeff() : 0.0;
      x_ = model_.retract(x_, std::min(1.0, longest_step / std::max(size, 1e-12)) * *step);
      if (i >= first_noise_update) update_iron(*covariance_diagonal);
      if (i >= least_rounds && size < converged_rotation) break;
    }
    return result();
  }

 private:
  Index rotations() const { return model_.rotations(); }

  static std::optional<VectorXd> variances(ConstMatrixRef matrix) {
    const auto inverse = invert_spd(matrix);
    return inverse ? std::optional<VectorXd>(inverse->diagonal()) : std::nullopt;
  }

  void update_noise() {
    for (std::size_t s = 0; s < noise_.size(); ++s) {
      std::vector<Vec3> residual(recording_.bins, Vec3::Zero());
      for (std::size_t t = 0; t < recording_.bins; ++t)
        if (recording_.sensors[s].is_valid[t]) residual[t] = model_.residual(x_, s, t);
      noise_[s] = estimate_noise(residual, recording_.sensors[s].is_valid);
      noise_[s].sd = std::max(noise_[s].sd, least_noise * recording_.strength);
    }
  }

  /// Of the measurements and the priors of iron and field; without the information of other instruments.
  IronEquations equations() const {
    const Index n = model_.unknowns();
    IronEquations normal{MatrixXd::Zero(n, n), VectorXd::Zero(n)};
    for (std::size_t s = 0; s < noise_.size(); ++s) add_series(normal, s);
    normal.matrix.diagonal().head(rotations()).array() += no_information;
    normal.matrix.diagonal().segment<3>(rotations()).array() += 1e-6 / (recording_.strength * recording_.strength);
    for (std::size_t s = 0; s < noise_.size(); ++s) {
      const Index first = model_.first_iron(s);
      const VectorXd value = iron_values(s);
      for (Index i = 0; i < iron_unknowns; ++i) {
        const double weight = 1.0 / (prior_sd(i) * prior_sd(i));
        normal.matrix(first + i, first + i) += weight;
        normal.right[first + i] -= weight * value[i];
      }
    }
    return normal;
  }

  void add_series(IronEquations& normal, std::size_t s) const {
    const AutoregressiveNoise& noise = noise_[s];
    const MagneticSeries& series = recording_.sensors[s];
    std::vector<FieldDerivative> derivative(recording_.bins);
    std::vector<Vec3> residual(recording_.bins, Vec3::Zero());
    for (std::size_t t = 0; t < recording_.bins; ++t) {
      if (!series.is_valid[t]) continue;
      MagneticPrediction p = model_.predict(x_, s, t);
      residual[t] = series.field[t] - p.value;
      derivative[t] = std::move(p.derivative);
    }
    const Index own = rotations() + 3 + iron_unknowns;
    MatrixXd matrix = MatrixXd::Zero(own, own);
    VectorXd right = VectorXd::Zero(own);
    for (std::size_t t = autoregressive_order; t < recording_.bins; ++t) {
      if (!(noise.weight[t] > 0.0)) continue;
      FieldDerivative j = derivative[t];
      Vec3 r = residual[t];
      for (std::size_t k = 0; k < autoregressive_order; ++k) {
        if (!(std::abs(noise.coefficients[k]) > 0.0)) continue;
        j -= noise.coefficients[k] * derivative[t - k - 1];
        r -= noise.coefficients[k] * residual[t - k - 1];
      }
      const double weight = noise.efficiency * noise.weight[t] / (noise.sd * noise.sd);
      matrix.noalias() += weight * j.transpose() * j;
      right.noalias() += weight * j.transpose() * r;
    }
    const Index shared = rotations() + 3, first = model_.first_iron(s);
    normal.matrix.topLeftCorner(shared, shared) += matrix.topLeftCorner(shared, shared);
    normal.matrix.block(first, 0, iron_unknowns, shared) += matrix.bottomLeftCorner(iron_unknowns, shared);
    normal.matrix.block(0, first, shared, iron_unknowns) += matrix.topRightCorner(shared, iron_unknowns);
    normal.matrix.block(first, first, iron_unknowns, iron_unknowns) +=
        matrix.bottomRightCorner(iron_unknowns, iron_unknowns);
    normal.right.head(shared) += right.head(shared);
    normal.right.segment(first, iron_unknowns) += right.tail(iron_unknowns);
  }

  double prior_sd(Index i) const { return i < 3 ? iron_.hard_iron : i < 9 ? iron_.soft_iron : iron_.misalignment; }

  /// b, then S in its basis.
  VectorXd iron_values(std::size_t s) const {
    VectorXd values(iron_unknowns);
    values.head<3>() = x_.hard_iron[s];
    for (std::size_t i = 0; i < 9; ++i) {
      const Mat3& basis = soft_iron_basis()[i];
      values[3 + static_cast<Index>(i)] = basis.cwiseProduct(x_.soft_iron[s]).sum() / basis.squaredNorm();
    }
    return values;
  }

  void update_iron(const VectorXd& variance) {
    const auto estimate = [&](double& sd, double least, Index from, Index to) {
      double squares = 0.0, observed = 0.0;
      for (std::size_t s = 0; s < noise_.size(); ++s) {
        const VectorXd values = iron_values(s);
        for (Index i = from; i < to; ++i) {
          squares += values[i] * values[i];
          observed += std::clamp(1.0 - variance[model_.first_iron(s) + i] / (sd * sd), 0.0, 1.0);
        }
      }
      if (observed > 0.0) sd = std::max(least, std::sqrt(squares / observed));
    };
    estimate(iron_.hard_iron, least_.hard_iron, 0, 3);
    estimate(iron_.soft_iron, least_.soft_iron, 3, 9);
    estimate(iron_.misalignment, least_.misalignment, 9, 12);
  }

  std::optional<MagneticFit> result() {
    update_noise();
    const auto covariance = invert_spd(equations().matrix);
    if (!covariance) return std::nullopt;
    const auto information = invert_spd(covariance->topLeftCorner(rotations(), rotations()));
    if (!information) return std::nullopt;
    const VectorXd from_others = covariance->topLeftCorner(rotations(), rotations()) * (information_ * x_.rotation);
    return MagneticFit{x_, *information, x_.rotation + from_others, iron_, noise_};
  }

  const MagneticRecording& recording_;
  MagneticModel model_;
  IronPrior least_, iron_;
  MatrixXd information_;
  MagneticUnknowns x_;
  std::vector<AutoregressiveNoise> noise_;
};

}  // namespace

std::optional<MagneticFit> fit_magnetometers(const MagneticRecording& recording,
                                             const std::vector<SubtreeRotation>& rotations, const IronPrior& least,
                                             ConstMatrixRef information) {
  if (recording.sensors.empty() || recording.bins <= 2 * autoregressive_order || !(recording.strength > 0.0))
    return std::nullopt;
  return MagneticLeastSquares(recording, rotations, least, information).run();
}

}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
// Errors of the instruments that are constant since the first row, and that the filter has followed from there: its
// innovations are as small as those of sound sensors, but not independent of them.
//
// Of a fault φ the filter's estimate is off by s φ, and its innovations by G φ (Willsky and Jones 1976): with Z the
// derivative of what the sensors measure by φ, H that of the prediction by the state, F the transition and K the gain
// that was used,
//
//   s ← F s,  G = Z − H s,  s ← s + K G,  b = Σ Gᵀ S⁻¹ ν,  A = Σ Gᵀ S⁻¹ G.
//
// Then φ̂ = A⁻¹ b. Faults: a turn of each sensor's mounting ((I + [θ]×) z, both instruments, [rad] in its frame); the
// time by which all gyroscopes are later than the accelerometers [s]; what all accelerometers read too much [1].
#pragma once

#include <array>

#include "kinfer/track/filter/update_system.hpp"
#include "kinfer/track/model/chain_state.hpp"

namespace kinfer::track {

/// b and A of one fault of three unknowns or of one, which then is the first.
struct FaultScore {
  Vec3 score = Vec3::Zero();
  Mat3 information = Mat3::Zero();
};

using TurnDerivative = Eigen::Matrix<double, 18, 3>;

/// Of both scale matrices of a sensor, row by row, by a turn of its mounting.
TurnDerivative scales_by_turn();

class ConstantFaults {
 public:
  explicit ConstantFaults(const FilterModel& model);

  /// A fault is a turn of each sensor, in their order, the gyroscopes' delay or the accelerometers' scale.
  std::size_t size() const { return sums_.size(); }
  std::size_t delay() const { return sums_.size() - 2; }
  std::size_t scale() const { return sums_.size() - 1; }
  static Index unknowns(std::size_t fault, std::size_t faults) { return fault + 2 < faults ? 3 : 1; }

  // ---- what the filter does to its state ----
  void predict(const FilterModel& model, const ChainState& before, double dt, ShownMeans means);
  /// After the system has been divided, with the gains that correct the state; `change`: of the predicted rows
  /// [1/s]; `estimated`: how many states are corrected.
  void update(const UpdateSystem& system, const ChainMeasurement& predicted, const VectorXd& change, double length,
              Index estimated);

  /// By one scalar measurement of the states `at` with these factors, of which the gain is `w` / `variance`.
  void update(const std::array<Index, 6>& at, const std::array<double, 6>& factor, int terms, const VectorXd& w,
              double variance, Index estimated);

  const MatrixXd& by_fault() const { return s_; }  ///< sᵀ: unknowns of all faults x estimated states
  MatrixXd& by_fault() { return s_; }

  /// The turn of a sensor is believed and part of the state: its error was `off` times the turn. `covariance`: of the
  /// belief by scores that count less by `excess`.
  void believe_turn(std::size_t sensor, const MatrixXd& off, const Mat3& covariance, double excess);

  // ---- the same over stretches of the log ----
  std::size_t stretches() const { return stretches_; }
  const FaultScore& of(std::size_t fault) const { return sums_[fault]; }
  const FaultScore& of(std::size_t fault, std::size_t stretch) const { return by_stretch_[stretch][fault]; }
  bool ends_stretch() const { return stretches_ > 0 && in_stretch_ <= 0.0; }  ///< with the last update
  double stretch_length() const { return stretch_length_; }                   ///< [s]
  /// [rad] rms by which the specific force has changed its direction in a sensor's frame.
  double force_scatter(std::size_t sensor) const;
  double observed() const { return observed_; }  ///< [s]

 private:
  static constexpr std::size_t most_stretches = 64;
  void form_signatures(const UpdateSystem& system, const ChainMeasurement& predicted, const VectorXd& change);
  void sum_up(double length);

  Index sensors_ = 0;
  MatrixXd s_, g_, information_, block_information_;  // sᵀ, Gᵀ L⁻ᵀ, A, of one block
  VectorXd block_score_;
  std::vector<Vec3> force_direction_;  // sums over the time observed
  std::vector<FaultScore> sums_;
  std::vector<std::vector<FaultScore>> by_stretch_;
  std::size_t stretches_ = 0;
  double stretch_length_, in_stretch_ = 0.0, observed_ = 0.0;
};

}  // namespace kinfer::track

// SPDX-License-Identifier: Apache-2.0
// Error-state extended Kalman filter on a chain (Schmidt 1966 for what is only considered): all sensors of a block of
// rows in one update.
//
// With W = P Hᵀ, S = H W + R = L Lᵀ and Y = W L⁻ᵀ the update is x += Y L⁻¹ν, P −= Y Yᵀ, except that considered states
// keep their value and covariance. Copyable; nothing is allocated after construction.
#pragma once

#include <memory>

#include "kinfer/track/filter/joint_changes.hpp"

namespace kinfer::track {

/// Mean of a block of rows, at their mean time.
struct BlockSample {
  Vec3 rate = Vec3::Zero(), force = Vec3::Zero();
  int rate_count = 0, force_count = 0;  ///< 0: not measured
};
struct BlockMeasurement {
  double time = 0.0, length = 0.0;   ///< [s] length: that the rows stand for
  std::vector<BlockSample> sensors;  ///< in the order of the model
};

/// Score and information of the time by which a sensor's measurements are later than they are taken to be.
struct LatenessScore {
  double score = 0.0, information = 0.0;  ///< [1/s], [1/s²]
};

/// How an update came out.
struct Innovations {
  VectorXd value;                 ///< measured minus predicted, rows of the sensors
  std::vector<double> leave_out;  ///< T of each sensor against all others, its expectation being `leave_out_rows`
  std::vector<int> rows;          ///< of each sensor that were measured: 0, 3 or 6; of sensors out of use too
  std::vector<double> of_joint;   ///< T of each joint, its expectation being `change_rows`; 0: not compared
  /// The same two before instruments that are far off are trusted less: what a change of it alone would explain.
  std::vector<double> unlimited, unlimited_of_joint;
  std::vector<LatenessScore> lateness;  ///< of each sensor, by its leave-one-out innovation
  double log_likelihood = 0.0;          ///< of this block
};

class ChainFilter {
 public:
  explicit ChainFilter(std::shared_ptr<const FilterModel> model);

  const FilterModel& model() const { return *model_; }
  const ChainState& state() const { return state_; }
  const MatrixXd& covariance() const { return p_; }
  const Innovations& innovations() const { return innovations_; }

  /// Starts in a posture; `fast`: covariance of the fast states. What is known of sensors and geometry is kept.
  void start(const ChainState& state, ConstMatrixRef fast);

  void predict(double time);
  void update(const BlockMeasurement& block);

  /// One scalar measurement h x = value of the estimated states, given by the indices of h that are not zero. Its noise
  /// may be part of the error of one state already, which is none of h.
  struct ScalarRow {
    std::array<Index, 6> at{};
    std::array<double, 6> factor{};
    int terms = 0;
    double innovation = 0.0, variance = 1.0;
    Index noisy_state = -1;         ///< −1: none
    double noise_covariance = 0.0;  ///< of that state's error with the noise
  };
  void update(const ScalarRow& row);
  /// Of its innovation: that of the measurement and that of the states.
  double variance(const ScalarRow& row) const;

  void set_base(BaseMode mode);

  /// Moves a joint position (of a revolute or prismatic joint) and states how well it is known there.
  void place(Index position, double value, double sd);

  /// [s] Since when all positions follow from the rows: the last start or placing.
  double placed_at() const { return placed_; }

  /// Forgets what is unknown of a joint position and of its zero: it counts from here.
  void declare_known(Index position);

  /// Leaves a sensor out of all updates (or takes it in again).
  void use_sensor(std::size_t sensor, bool is_used) { is_used_[sensor] = is_used; }
  bool uses_sensor(std::size_t sensor) const { return is_used_[sensor]; }

  /// A joint in doubt has a change of its own in every update: angular velocity and force beyond it follow from those
  /// before it no better than they do.
  void doubt_joint(std::size_t joint, bool is_doubted) { changes_.doubt(joint, is_doubted); }
  bool doubts_joint(std::size_t joint) const { return changes_.is_doubted(joint); }

  /// Uses the sensors, and doubts the joints, that `other` does.
  void judge_as(const ChainFilter& other);

  /// Factor on the variance of an instrument's measurements, as its innovations ask for; at least 1.
  InsLevel inflation(std::size_t sensor) const { return inflation_[sensor]; }
  /// The median over the sensors in use, of the larger one of each: how far the motion is from what the chain explains.
  double common_inflation() const { return common_inflation_; }

 private:
  Index zero_state(Index position) const;
  void forget(Index state);
  void add_posture_walk(double dt);
  void form_rows(const BlockMeasurement& block);
  void follow_change();
  void score_lateness(std::size_t sensor, const Eigen::Matrix<double, sensor_rows, 1>& weighted,
                      const Eigen::Matrix<double, sensor_rows, sensor_rows>& information);
  void form_sensor_rows(const BlockMeasurement& block, std::size_t sensor);
  void form_soft_rows(double length);
  struct SteadyVelocity {
    double velocity = 0.0, duration = 0.0;  // [m/s] or [rad/s], [s] since it has been about that
  };
  struct RestOdds {
    double speed, creep, steadiness;  // [m/s] or [rad/s] of a joint that moves; of one that rests; of a steady one
  };
  bool rests(SteadyVelocity& steady, Index position, const RestOdds& odds, double length) const;
  bool shows_acceleration(Index position);
  void multiply();  // W and S
  bool factorise();
  void invert();
  bool allow_joint_changes();
  bool limit_outliers();
  void examine_changes();
  void examine();
  void adapt_noise();
  double distance_of_unused(const BlockMeasurement& block, std::size_t sensor);
  void correct();
  void bound();
  void mirror();

  std::shared_ptr<const FilterModel> model_;
  ChainState state_;
  MatrixXd p_;
  ChainEvaluator evaluator_;
  std::vector<bool> is_used_;
  VectorXd last_value_, change_;  // predicted rows of the last update, their rate of change
  double last_update_ = -1e9;
  JointChanges changes_;
  std::vector<InsLevel> inflation_;
  std::vector<SteadyVelocity> steady_;  // of each prismatic joint, then of each revolute one between sensors
  Innovations innovations_;
  // Buffers of an update: sensors' rows first, then soft constraints.
  Index rows_ = 0;
  VectorXd residual_, noise_, error_, whitened_;
  MatrixXd h_, w_, s_, kept_, inverse_, unused_w_;
  MatrixXd accelerations_;         // information about those of joints and base
  std::vector<bool> is_measured_;  // of each triple of rows
  std::vector<double> leave_out_;  // of each triple: squared leave-one-out innovation over its expectation
  std::vector<double> ordered_;    // buffer of medians
  double common_inflation_ = 1.0;
  double placed_ = 0.0;
};

}  // namespace kinfer::track

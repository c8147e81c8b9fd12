// SPDX-License-Identifier: Apache-2.0
// Error-state extended Kalman filter on a chain (Schmidt 1966 for what is only considered): all sensors of a block of
// rows in one update.
//
// Considered states keep their value and covariance in an update. Copyable; nothing is allocated after construction.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "kinfer/track/filter/ball_headings.hpp"
#include "kinfer/track/filter/constant_faults.hpp"
#include "kinfer/track/filter/instrument_levels.hpp"
#include "kinfer/track/filter/joint_changes.hpp"
#include "kinfer/track/filter/limb_turns.hpp"
#include "kinfer/track/filter/mean_rates.hpp"
#include "kinfer/track/filter/soft_rows.hpp"

namespace kinfer::track {

/// Mean of a block of rows, at their mean time.
struct BlockSample {
  Vec3 rate = Vec3::Zero(), force = Vec3::Zero();
  int rate_count = 0, force_count = 0;       ///< 0: not measured
  double angular_acceleration = 0.0;         ///< [rad/s²] from the first to the last block of a mean
  double rate_time = 0.0, force_time = 0.0;  ///< [s] mean time of its samples after the block's: some rows lack it
};
struct BlockMeasurement {
  double time = 0.0, length = 0.0;   ///< [s] length: that the rows stand for
  std::vector<BlockSample> sensors;  ///< in the order of the model
};

class ChainFilter {
 public:
  explicit ChainFilter(std::shared_ptr<const FilterModel> model);

  const FilterModel& model() const { return *model_; }
  const ChainState& state() const { return state_; }
  const MatrixXd& covariance() const { return p_; }
  const Innovations& innovations() const { return innovations_; }

  /// Starts in a posture; `fast`: covariance of the fast states. What is known of sensors and geometry is kept, but
  /// that biases may have walked since the last update.
  void start(const ChainState& state, ConstMatrixRef fast);

  void predict(double time);
  void update(const BlockMeasurement& block);
  /// Both for each of these rows; ln of their likelihood.
  double run(std::span<const BlockMeasurement> rows);

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

  /// Positions of unknown zeros are stated from where they are now, at what the user states of them, with its standard
  /// deviation [rad]. Without a statement: at the value that they happen to have. Once.
  void count_from_start(Index position, std::optional<double> stated, double sd);
  bool counts_from_start() const { return counts_from_start_; }

  /// A position of an unknown zero stood `turn` further on at the start, known to `sd` [rad]; what is stated of it
  /// stays, but for `lost_sd`, by which it has turned unseen.
  void turn_start(Index position, double turn, double sd, double lost_sd);

  /// The body's axis lies on the base (UnknownAxis) such that gravity, which lies along `from` in the joint's frame
  /// there as the state has it, lies along `to`; nothing else is known of it.
  void place_axis(std::size_t body, const Vec3& from, const Vec3& to);
  /// The same beyond a joint on the base that stands `turn` further on: gravity in the body stays as it is.
  void keep_gravity(std::size_t body, double turn);

  /// How the limb that begins with the body is turned on its segment is known from here on: by so much more, to `sd`
  /// [rad]. The position of its first joint is as uncertain as the tilt of the base makes it.
  void turn_limb(std::size_t body, double turn, double sd);
  /// Nothing is known of that.
  void forget_turn(std::size_t body);
  bool knows_turn(std::size_t body) const { return limb_turns_.is_known(body); }
  /// As of LimbTurns.
  double tilt_of(const UnknownTurn& turn) const { return LimbTurns::tilt(*model_, state_, p_, turn); }
  bool shows_turn(const UnknownTurn& turn) const { return LimbTurns::are_shown(*model_, state_, p_, turn); }

  /// Unseen points are estimated, or considered: as long as it is open where joints stand that they are multiplied
  /// with.
  void estimate_points(bool are_estimated) { estimates_points_ = are_estimated; }

  /// States a position otherwise, with another standard deviation [rad] or [m]; what is correlated with it goes along
  /// (Jeffrey's rule). Where a linearisation begins.
  void suppose(Index position, double value, double sd);

  /// Moves a joint's velocity to where a sensor's angular velocity [rad/s] shows it; specific forces are quadratic in
  /// it. Where a linearisation begins.
  void suppose_velocity(Index position, std::size_t sensor, const Vec3& rate);

  /// [s] Since when all positions follow from the rows: the last start or placing.
  double placed_at() const { return placed_; }

  /// A joint position counts from where it stands: what is unknown of it is forgotten, on a still base that of its zero
  /// as well.
  void count_from_here(Index position);

  /// Leaves a sensor out of all updates (or takes it in again).
  void use_sensor(std::size_t sensor, bool is_used) { is_used_[sensor] = is_used; }
  bool uses_sensor(std::size_t sensor) const { return is_used_[sensor]; }

  /// A joint in doubt has a change of its own in every update: angular velocity and force beyond it follow from those
  /// before it no better than they do.
  void doubt_joint(std::size_t joint, bool is_doubted) { changes_.doubt(joint, is_doubted); }
  bool doubts_joint(std::size_t joint) const { return changes_.is_doubted(joint); }
  bool doubts_any_joint() const { return changes_.doubts_any(); }

  /// Adds to what is unknown of states in a row, from the first one on.
  void widen(Index first, ConstMatrixRef covariance);

  /// Uses the sensors, and doubts the joints, that `other` does.
  void judge_as(const ChainFilter& other);

  /// Factors on the variances of the instruments, as their innovations ask for.
  const InstrumentLevels& levels() const { return levels_; }

  /// The heading of a body's spherical joint is considered until motion has shown it for a while.
  void consider_heading(std::size_t body) { headings_.consider(body); }
  void free_heading(std::size_t body, double sd);
  const Vec3& up_in_ball(std::size_t body) const { return headings_.up(body); }
  bool considers_heading(std::size_t body) const { return headings_.is_considered(body); }
  void show_heading(std::size_t body) { headings_.show(body); }
  /// [rad²] of that heading.
  double heading_variance(std::size_t body) const { return headings_.variance(body, p_); }

  /// Squared distance of an instrument's three biases from those handed over, in the variance that they had before any
  /// row, that of sensors of this grade, and what they may have walked since; its expectation is at most 3.
  InsLevel bias_distance(std::size_t sensor) const;

  /// A sensor was turned by N(mean, covariance) [rad] in its frame since the first row: that is taken out of the
  /// estimate, and is part of the sensor's scale matrices from here on. By scores that count less by `excess`.
  void believe_turn(std::size_t sensor, const Vec3& mean, const Mat3& covariance, double excess);

  const ConstantFaults& constant_faults() const { return constant_faults_; }
  ConstantFaults& constant_faults() { return constant_faults_; }

 private:
  Index zero_state(Index position) const;
  void forget(Index state);
  double shared_noise(const ScalarRow& row) const;
  void add_posture_walk(double dt);
  void let_biases_walk(double gap);
  void widen_bias_distance(double dt);
  double time_since_update() const;
  Index estimated() const { return estimates_points_ ? model_->layout.first_geometry : model_->layout.first_point; }
  void follow_change();
  void add_what_means_miss(double dt, const BlockMeasurement& block);
  void form_rows(const BlockMeasurement& block);
  void form_sensor_rows(const BlockMeasurement& block, std::size_t sensor);
  void relinearise(const BlockMeasurement& block);
  bool allow_joint_changes();
  void examine_changes();
  void examine_unused(const BlockMeasurement& block);
  double distance_of_unused(const BlockMeasurement& block, std::size_t sensor);
  void correct(double length);
  void bound();
  void mirror();

  std::shared_ptr<const FilterModel> model_;
  ChainState state_, predicted_;  // the second: a buffer of an update
  MatrixXd p_;
  ChainEvaluator evaluator_;
  std::vector<bool> is_used_;
  VectorXd last_value_, change_;          // predicted rows of the last update, their rate of change
  VectorXd change_of_change_;             // from the last update to this one
  std::optional<double> last_update_{};   // [s]
  ShownMeans shown_ = ShownMeans::rates;  // by the last block
  SoftRows soft_rows_;
  JointChanges changes_;
  InstrumentLevels levels_;
  BallHeadings headings_;
  LimbTurns limb_turns_;
  ConstantFaults constant_faults_;
  MeanRates mean_rates_;
  Innovations innovations_;
  UpdateSystem system_;
  VectorXd error_, column_;  // buffers of an update
  MatrixXd unused_w_;
  double placed_ = 0.0;
  bool counts_from_start_ = false, estimates_points_ = false;
  VectorXd bias_variance_;  // of each sensor's biases without the rows: gyroscope, accelerometer
};

}  // namespace kinfer::track

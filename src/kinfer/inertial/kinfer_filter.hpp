// The house's orientation filter: gyro integration, corrected by a Kalman filter with full covariance whose states are
// the orientation error, the horizontal velocity, the gyro bias and the gyro's scale and cross-axis errors.
//
// Tilt is told by the velocity: specific force is turned into the world and integrated; a sensor that is carried about
// has a bounded speed, so a velocity that runs away is a tilt error. This is the low pass of specific force in an
// almost inertial frame (Laidig and Seel, VQF, Information Fusion 91, 2023) with gains that the covariance chooses, and
// with the speed that counts as bounded learned from the motion. Gyro bias and scale follow, in motion too, through the
// covariance; at rest the gyro itself tells the bias. The magnetometer tells heading only, and only while its field has
// the learned strength and dip.
//
// World: x east, y (magnetic) north, z up; without magnetometer the heading of the start is 0 by the smallest turn that
// puts "up" upward. A sample stands for the time since the sample before: its rate is the mean rate of that interval.
// Streams: one object per sensor, copyable, 3 kB; covariance and corrections run once per update_period.
#pragma once

#include "kinfer/inertial/filter_input.hpp"
#include "kinfer/inertial/magnetic_reference.hpp"
#include "kinfer/inertial/rest.hpp"

namespace kinfer {

struct KinferFilterOptions {
  MagnetometerUse magnetometer = MagnetometerUse::automatic;
  double update_period = 0.05;  ///< [s] between corrections; smaller costs time and gains nothing

  double gyro_noise = 5e-4;    ///< [rad/√s] random walk of the angle; larger trusts specific force more
  double turn_noise = 1e-3;    ///< [rad/√rad] error per angle turned that no bias or scale explains
  double bias_sd = 8.7e-3;     ///< [rad/s] (0.5 °/s) of the bias at the start
  double bias_drift = 1.7e-5;  ///< [rad/s/√s]; larger forgets a bias faster
  double scale_sd = 2e-3;      ///< of the gyro's scale and cross-axis errors, assumed constant; 0: none
  double rest_noise = 3e-4;    ///< [rad/√s] likewise, of the rate at rest as a reading of the bias

  double start_tilt_sd = 0.1;        ///< [rad] of the first tilt, read off one sample that may be in motion
  double start_heading_sd = 1.0;     ///< [rad] of the first heading; the first fields are averaged where it is large
  double acceleration_noise = 0.02;  ///< [m/s/√s] random walk of the velocity
  double speed = 0.7;                ///< [m/s] that the sensor may have at least; larger trusts the gyro longer
  double speed_factor = 2.0;         ///< or this times the rms speed of late, if that is more
  double speed_memory = 5.0;         ///< [s] over which that rms is taken
  double speed_time = 0.15;          ///< [s] correlation time of the speed
  double rest_speed = 0.01;          ///< [m/s] at rest

  double field_noise = 0.35;        ///< [rad·√s] (20°) of magnetic heading; larger trusts the gyro longer
  double longest_hold = 0.1;        ///< [s] of missing rates that are bridged by their neighbours
  double blind_noise = 0.3;         ///< [rad/√s] turn per time while the rate is unknown (missing or clipped)
  double blind_acceleration = 3.0;  ///< [m/s²·√s] per time while the specific force is unknown
  double bias_gate = 5e-3;          ///< [rad/s] (0.3 °/s) more than this, beyond 5 sd, from the bias is no rest
  double longest_doubt = 10.0;      ///< [s] of such stillness after which it is believed all the same
  RestOptions rest{};
  MagneticOptions magnetic{};
};

/// Error states: rotation in the world 0-2, horizontal velocity 3-4, gyro bias 5-7, scale matrix by rows 8-16.
constexpr int kinfer_states = 17;
using KinferVector = Eigen::Matrix<double, kinfer_states, 1>;
using KinferCovariance = Eigen::Matrix<double, kinfer_states, kinfer_states>;

/// What the filter believes, apart from how well it knows it.
struct KinferBelief {
  Quat world_q_sensor = Quat::Identity();
  Eigen::Vector2d velocity{0.0, 0.0};  ///< [m/s] horizontal; bounded, not absolute
  Vec3 bias = Vec3::Zero();            ///< [rad/s]
  Mat3 scale = Mat3::Zero();           ///< true rate = (1 + scale) (rate - bias)
};

/// belief ⊕ error, with the rotation error on the world's side; and the error between two beliefs.
KinferBelief corrected(const KinferBelief& belief, const KinferVector& error);
KinferVector difference(const KinferBelief& to, const KinferBelief& from);

/// How errors at the start of an update period become errors at its end: rotation += by_constants [bias; scale],
/// velocity += lift (rotation_y, -rotation_x), and variances that are added.
struct KinferTransition {
  Eigen::Matrix<double, 3, 12> by_constants = Eigen::Matrix<double, 3, 12>::Zero();
  double lift = 0.0;  ///< [m/s per rad]
  KinferVector noise = KinferVector::Zero();
};

class KinferFilter {
 public:
  explicit KinferFilter(const KinferFilterOptions& options = {});

  /// Takes the next row of the sensor; times must rise. Rows that say nothing are passed over.
  void add(const InsSample& sample);

  const Quat& orientation() const { return belief_.world_q_sensor; }  ///< sensor to world
  const KinferBelief& belief() const { return belief_; }
  const KinferCovariance& covariance() const { return covariance_; }
  bool at_rest() const { return rest_.at_rest(options_.rest); }
  bool started() const { return started_; }

  /// The parts of add(), for a smoother that keeps what happens between them.
  void integrate(const InsSample& sample);  ///< gyro to orientation; sums for the update
  bool update_is_due() const;
  KinferTransition predict();  ///< belief and covariance to the end of the period
  void correct();              ///< by velocity, rest and magnetometer; begins the next period

  /// Replaces what it believes, not how well: for a start that is known from elsewhere.
  void believe(const KinferBelief& belief) { belief_ = belief; }

 private:
  /// Sums since the last update.
  struct Period {
    double elapsed = 0.0, turned = 0.0;                                      // [s], [rad]
    Vec3 velocity_gain = Vec3::Zero();                                       // ∫ R f dt [m/s]
    Mat3 rotation = Mat3::Zero();                                            // ∫ R dt
    Eigen::Matrix<double, 3, 9> turn = Eigen::Matrix<double, 3, 9>::Zero();  // ∫ R (scale entries' effect) dt
    Vec3 field = Vec3::Zero();                                               // ∫ R m dt
    double field_time = 0.0;
    Vec3 rate = Vec3::Zero();                    // ∫ rate dt
    double blind_turn = 0.0, blind_force = 0.0;  // [s] without rate, without specific force
  };

  void start(const InsSample& sample);
  void turn_and_sum(const InsSample& sample, const Vec3& rate, double dt);
  void bridge_gap(const InsSample& sample, double dt);
  void correct_one(int state, double error, double variance, KinferVector& sum);
  void correct_velocity(bool at_rest, KinferVector& sum);
  void correct_bias(KinferVector& sum);
  void correct_heading(KinferVector& sum);
  bool rest_fits_bias() const;

  KinferFilterOptions options_;
  KinferBelief belief_;
  KinferCovariance covariance_ = KinferCovariance::Zero();
  RestDetector rest_;
  MagneticReference magnetic_;
  Period period_;
  Vec3 last_rate_ = Vec3::Zero(), last_force_world_ = Vec3::Zero();
  Vec3 previous_mean_rate_ = Vec3::Zero();  ///< of the period before
  bool previous_was_still_ = false, started_ = false;
  double time_ = 0.0, usual_dt_ = 0.0, mean_square_speed_ = 0.0;
};

}  // namespace kinfer

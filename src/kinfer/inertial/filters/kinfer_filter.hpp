// SPDX-License-Identifier: Apache-2.0
// kinfer's orientation filter: gyro integration with an error-state Kalman filter (full covariance) whose states are
// the orientation error, the horizontal velocity, the gyro bias and the gyro's scale and cross-axis errors.
//
// Tilt is observed through the velocity: specific force is transformed to the world and integrated; the speed of the
// sensor is bounded, so a diverging velocity indicates a tilt error. This is the low pass of specific force in an
// almost inertial frame (Laidig and Seel, VQF, Information Fusion 91, 2023), with gains from the covariance and a speed
// bound estimated from the motion. Gyro bias and scale are corrected through the covariance, in motion too; at rest the
// bias is measured directly by the gyro. The magnetometer corrects heading only, and only while the field has the
// reference strength and dip.
//
// World: x east, y (magnetic) north, z up; without magnetometer the initial orientation is the smallest rotation that
// levels the sensor. Online: one object per sensor, copyable, 3 kB; covariance and corrections run once per
// update_period.
#pragma once

#include "kinfer/inertial/filters/magnetic_reference.hpp"
#include "kinfer/inertial/filters/magnetometer_use.hpp"
#include "kinfer/inertial/rest/rest.hpp"

namespace kinfer {

/// What the rate of a sample is taken for. The orientations differ by half an interval between samples: 1.2° at 40 Hz
/// and 100 °/s.
enum class RateSample {
  mean_since_previous,  ///< as of sensors that integrate, and as BROAD's reference was aligned
  at_its_time,          ///< as identified chains take it; rates between samples are the means of both
};

struct KinferFilterOptions {
  MagnetometerUse magnetometer = MagnetometerUse::automatic;
  RateSample rate_sample = RateSample::mean_since_previous;
  double update_period = 0.05;  ///< [s] between corrections; smaller costs time without benefit

  double gyro_noise = 5e-4;      ///< [rad/√s] angle random walk; larger trusts specific force more
  double rotation_noise = 1e-3;  ///< [rad/√rad] error per rotation angle not explained by bias or scale
  Vec3 bias = Vec3::Zero();      ///< [rad/s] initial
  double bias_sd = 8.7e-3;       ///< [rad/s] (0.5 °/s) of that
  double bias_drift = 1.7e-5;    ///< [rad/s/√s] bias random walk; larger forgets a bias faster
  double scale_sd = 2e-3;        ///< gyro scale and cross-axis errors, assumed constant; 0: not estimated
  double rest_noise = 3e-4;      ///< [rad/√s] noise of the rate at rest as a measurement of the bias

  double start_tilt_sd = 0.1;        ///< [rad] initial tilt, from one sample that may be in motion
  double start_heading_sd = 1.0;     ///< [rad] initial heading; large: the first fields are averaged
  double acceleration_noise = 0.02;  ///< [m/s/√s] velocity random walk
  double speed = 0.7;                ///< [m/s] lower limit of the speed bound; larger trusts the gyro longer
  double speed_factor = 2.0;         ///< the bound is this times the recent rms speed, if that is larger
  double speed_memory = 5.0;         ///< [s] averaging time of that rms
  double speed_time = 0.15;          ///< [s] correlation time of the velocity
  double rest_speed = 0.01;          ///< [m/s] velocity standard deviation at rest

  double field_noise = 0.35;           ///< [rad·√s] (20°) of magnetic heading; larger trusts the gyro longer
  double max_hold = 0.1;               ///< [s] longest gap in the rates that is bridged by the neighbouring samples
  double outage_rotation_noise = 0.3;  ///< [rad/√s] angle random walk while the rate is unknown (missing or clipped)
  double outage_acceleration = 3.0;    ///< [m/s²·√s] velocity random walk while the specific force is unknown
  double bias_gate = 5e-3;             ///< [rad/s] (0.3 °/s) beyond these sd: rates farther from the bias are not rest
  double rest_gate = 5.0;              ///< [sd] of the bias
  double moment_gate = 2.0;            ///< [sd] likewise, of stillness shorter than `min_rest_duration`; larger takes
                                       ///< slow rotations for rests. Set on simulated drives that begin in motion
  double moment_bias_sd = 1.0;       ///< [rad/s] of the bias beside which such stillness may be a rest before a longer
                                     ///< rest has told it; larger: any
  double max_rest_rejection = 10.0;  ///< [s] after which such a rest is accepted nevertheless
  RestOptions rest{};
  MagneticOptions magnetic{};
};

/// Error states: rotation in the world 0-2, horizontal velocity 3-4, gyro bias 5-7, scale matrix row by row 8-16.
constexpr int kinfer_states = 17;
using KinferErrorState = Eigen::Matrix<double, kinfer_states, 1>;
using KinferCovariance = Eigen::Matrix<double, kinfer_states, kinfer_states>;

/// State estimate of the filter (without its covariance).
struct KinferEstimate {
  Quat world_q_sensor = Quat::Identity();
  Eigen::Vector2d velocity{0.0, 0.0};  ///< [m/s] horizontal; bounded, not absolute
  Vec3 bias = Vec3::Zero();            ///< [rad/s]
  Mat3 scale = Mat3::Zero();           ///< true rate = (1 + scale) (rate - bias)
};

/// estimate ⊕ error, with the rotation error in world coordinates; and the error between two estimates.
KinferEstimate corrected(const KinferEstimate& estimate, const KinferErrorState& error);
KinferErrorState difference(const KinferEstimate& to, const KinferEstimate& from);

/// Error propagation over one update period: rotation += rotation_by_gyro_errors [bias; scale], velocity +=
/// velocity_by_tilt (rotation_y, -rotation_x), plus process noise variances.
struct KinferTransition {
  Eigen::Matrix<double, 3, 12> rotation_by_gyro_errors = Eigen::Matrix<double, 3, 12>::Zero();
  double velocity_by_tilt = 0.0;  ///< [m/s per rad]
  KinferErrorState noise = KinferErrorState::Zero();
};

class KinferFilter {
 public:
  explicit KinferFilter(const KinferFilterOptions& options = {});

  /// Processes the next sample; times must increase. Samples without usable measurements are skipped.
  void add(const InsSample& sample);

  const Quat& orientation() const { return estimate_.world_q_sensor; }  ///< sensor to world
  const KinferEstimate& estimate() const { return estimate_; }
  const KinferCovariance& covariance() const { return covariance_; }
  bool at_rest() const { return rest_.at_rest(options_.rest); }
  bool started() const { return started_; }

  /// The steps of add(), for a smoother that stores intermediate results.
  void integrate(const InsSample& sample);  ///< integrates the gyro and accumulates the sums for the update
  bool update_is_due() const;
  KinferTransition predict();  ///< estimate and covariance to the end of the period
  void correct();              ///< by velocity, rest and magnetometer; starts the next period

  /// Replaces the state estimate but not the covariance: for a known initial state.
  void set_estimate(const KinferEstimate& estimate) { estimate_ = estimate; }

 private:
  /// Sums since the last update.
  struct Period {
    double elapsed = 0.0, turned = 0.0;                                      // [s], [rad]
    Vec3 velocity_gain = Vec3::Zero();                                       // ∫ R f dt [m/s]
    Mat3 rotation = Mat3::Zero();                                            // ∫ R dt
    Eigen::Matrix<double, 3, 9> turn = Eigen::Matrix<double, 3, 9>::Zero();  // ∫ R (scale entries' effect) dt
    Vec3 field = Vec3::Zero();                                               // ∫ R m dt
    double field_time = 0.0;
    Vec3 angular_velocity = Vec3::Zero();          // ∫ rate dt
    double rate_outage = 0.0, force_outage = 0.0;  // [s] without rate, without specific force
  };

  void start(const InsSample& sample);
  void integrate_sample(const InsSample& sample, const Vec3& angular_velocity, double dt);
  void bridge_gap(const InsSample& sample, double dt);
  void update_state(int state, double error, double variance, KinferErrorState& sum);
  void correct_velocity(bool at_rest, KinferErrorState& sum);
  void correct_bias(KinferErrorState& sum);
  void correct_heading(KinferErrorState& sum);
  bool rest_agrees_with_bias() const;

  KinferFilterOptions options_;
  KinferEstimate estimate_;
  KinferCovariance covariance_ = KinferCovariance::Zero();
  RestDetector rest_;
  MagneticReference magnetic_;
  Period period_;
  Vec3 last_rate_ = Vec3::Zero(), last_force_world_ = Vec3::Zero();
  Vec3 previous_mean_rate_ = Vec3::Zero();  ///< of the previous period
  bool previous_was_still_ = false, started_ = false, rest_has_told_bias_ = false;
  double time_ = 0.0, typical_dt_ = 0.0, mean_square_speed_ = 0.0;
};

}  // namespace kinfer

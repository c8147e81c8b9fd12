// SPDX-License-Identifier: Apache-2.0
// Input and unknowns of a continuous-time fit of a machine.
//
// Time-varying unknowns: each joint position as a quintic spline; for a moving root also its angular velocity and
// specific force, so that a moving base needs no integration and cannot drift. Global parameters: the joint geometry,
// the root's specific force if it is at rest, and each INS' biases and scale matrices, measurement = (I + S) truth + b.
// Magnetometers are not fitted here: what they tell about azimuths is a fact (estimate/magnetometers).
#pragma once

#include "kinfer/base/constants.hpp"
#include "kinfer/estimate/continuous/model/chain_propagation.hpp"
#include "kinfer/estimate/continuous/model/clipped_blocks.hpp"
#include "kinfer/estimate/continuous/model/facts.hpp"
#include "kinfer/estimate/continuous/model/measurement_blocks.hpp"
#include "kinfer/estimate/continuous/model/mount_compliance.hpp"

namespace kinfer {

/// Standard deviations of one measurement.
struct InsNoise {
  double angular_velocity = 1.0;  ///< [rad/s]
  double force = 1.0;             ///< [m/s²]
};

/// Measurements of one INS, by intervals of the grid.
struct InsMeasurements {
  std::vector<InsBlock> angular_velocity, force;
  InsNoise noise;                                    ///< as weighted by the fit
  InsNoise noise_floor;                              ///< the instrument's own noise: lower bound of the above
  std::vector<InsMountLoad> mount_load{};            ///< load on its mount; empty if mounts are rigid
  InsClippedBlocks clipped_rate{}, clipped_force{};  ///< bounds, where the instrument clips
};

/// Clock error of a sensor: a measurement logged at t was taken at t + offset + drift (t − middle of the grid).
struct InsClock {
  double offset = 0.0;  ///< [s]
  double drift = 0.0;   ///< [s/s]
};

/// Systematic errors of one INS.
struct InsErrors {
  Vec3 gyroscope_bias = Vec3::Zero(), accelerometer_bias = Vec3::Zero();
  Mat3 gyroscope_scale = Mat3::Zero(), accelerometer_scale = Mat3::Zero();  ///< S
  InsClock clock{};
  Mat3 tilt = Mat3::Zero();  ///< [rad per m/s²] of its mount (ins_mount)
};

/// Prior standard deviations of the errors of an INS; matrices, clocks and tilts with 0 are not estimated.
struct InsErrorPrior {
  double gyroscope_bias = 0.0, accelerometer_bias = 0.0, gyroscope_scale = 0.0, accelerometer_scale = 0.0;
  double clock_offset = 0.0, clock_drift = 0.0;
  double tilt = 0.0;
};

/// Factor that all instruments of a kind share: the log was divided by it before the fit. What is left of it has a
/// prior of mean 0 beside those of each instrument; a standard deviation of 0: none is left.
struct InsCommonScale {
  double factor = 1.0, sd = 0.0;

  bool is_none() const { return sd <= 0.0; }
};

struct InsCommonScales {
  InsCommonScale gyroscope{}, accelerometer{};

  bool is_none() const { return gyroscope.is_none() && accelerometer.is_none(); }
};

/// Factors on the prior standard deviations of one INS' scale matrices.
struct InsScaleFactor {
  double gyroscope = 1.0, accelerometer = 1.0;
};

/// Bias instability of an INS: deviation of the biases from their constants as a first-order Gauss-Markov process per
/// axis, constant over each time segment of the grid. Standard deviations of 0: none.
struct BiasProcess {
  double rate_sd = 0.0;   ///< [rad/s]
  double force_sd = 0.0;  ///< [m/s²]
  double time = 100.0;    ///< [s] correlation time

  bool is_none() const { return rate_sd <= 0.0 && force_sd <= 0.0; }
};

struct InsProblem {
  SplineGrid grid;
  bool root_at_rest = true;
  std::vector<InsMeasurements> sensors;
  InsErrorPrior prior;
  std::vector<InsScaleFactor> scale_factors{};  ///< one a sensor; empty: 1
  InsCommonScales common{};
  BiasProcess bias_process{};
  double gravity = standard_gravity;  ///< [m/s²] norm of the root's specific force if it is at rest
  double gravity_sd = 0.03;           ///< [m/s²] covers gravity anywhere on Earth
  double point_sd = 3.0;              ///< [m] weak prior: keeps unobservable points near the sensors
  double rotation_sd = 1.0;           ///< [rad] weak prior: keeps an unobservable azimuth at its initial value
  std::size_t clock_reference = 0;    ///< sensor whose clock is the reference
  std::vector<double> anchor;         ///< prior mean of each joint's first coefficient: fixes an unobservable constant
  std::vector<double> anchor_sd{};    ///< [rad] or [m] standard deviations of the same; empty: weak, 3 each
  InsFacts facts{};                   ///< external measurements
};

struct InsUnknowns {
  MatrixXd spline_coefficients;  ///< dimensions x coefficients: [root angular velocity, root force] if it moves, joints
  InsBodies bodies;
  Vec3 root_force = Vec3::Zero();  ///< [m/s²] if the root is at rest
  std::vector<InsErrors> errors;   ///< one per sensor
  MatrixXd bias_process{};  ///< [gyroscope, accelerometer] of each sensor x time segments; empty: constant biases
  InsFactUnknowns facts{};
};

/// Intervals from the first to the last in which some sensor measures that moves with a spline dimension.
struct MeasuredSpan {
  Eigen::Index begin = 0, end = 0;

  bool holds(Eigen::Index interval) const { return begin <= interval && interval < end; }
};

/// Index of each unknown.
struct InsLayout {
  Eigen::Index spline_dimensions = 0;          ///< spline dimensions
  Eigen::Index global_parameters = 0;          ///< number of global parameters
  Eigen::Index root_force = -1;                ///< first of three global parameters; −1: absent
  std::vector<Eigen::Index> body, error;       ///< first global parameter of each body and sensor
  std::vector<Eigen::Index> spline_dimension;  ///< first spline dimension of each body's joint; −1: none
  Eigen::Index bias_process = 0;               ///< unknowns per time segment: six per sensor, or none
  std::vector<MeasuredSpan> measured;          ///< of each spline dimension
  std::vector<bool> only_accelerates;          ///< of each: measured by its second derivative alone
  bool has_matrices = false, has_clocks = false, has_tilts = false;
  Eigen::Index errors_each = 0;                    ///< unknowns per sensor: [b_g, b_a, S_g, S_a, clock, tilt]
  Eigen::Index clock_error = -1, tilt_error = -1;  ///< offsets in these; −1: absent
  Eigen::Index facts = -1;     ///< first unknown of the facts: points, touched points, closures, the surveyor's frame
  Eigen::Index closures = -1;  ///< first unknown of the closures
};
InsLayout layout_of(const InsProblem& problem, const InsBodies& bodies);

/// An increment of all unknowns.
struct InsStep {
  MatrixXd spline_coefficients;  ///< dimensions x coefficients
  VectorXd border;               ///< global parameters
  MatrixXd bias_process;         ///< unknowns x time segments
};

/// Prior on the global parameters: cost and normal equations (diagonal except for gravity and common scales).
struct GlobalParameterPrior {
  double cost = 0.0;
  MatrixXd matrix;
  VectorXd right;  ///< minus gradient
};
GlobalParameterPrior global_parameter_prior(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x);

}  // namespace kinfer

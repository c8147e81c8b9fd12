// Everything that a continuous-time fit of a machine rests on, and everything that it finds.
//
// In time: each joint's reading as a quintic spline; where the root moves, its angular rate and specific force too, so
// that a moving base costs nothing and drifts nowhere. For good: the joints' geometry, the root's specific force and
// magnetic field where it stands still, and each INS' biases and scale matrices, reading = (I + S) truth + b.
#pragma once

#include "kinfer/estimate/ins_blocks.hpp"
#include "kinfer/estimate/ins_chain.hpp"
#include "kinfer/estimate/ins_facts.hpp"
#include "kinfer/estimate/ins_mount.hpp"

namespace kinfer {

/// Standard deviations of one row of a block; of the magnetic field: of an interval's mean.
struct InsNoise {
  double rate = 1.0;   ///< [rad/s]
  double force = 1.0;  ///< [m/s²]
  double field = 1.0;
};

/// What one INS said, by intervals of the grid.
struct InsReadings {
  std::vector<InsBlock> rate, force, field;  ///< field: empty where it is not used
  InsNoise noise;                            ///< as the fit weighs them
  InsNoise least;                            ///< what the instrument has even where the model is perfect
  std::vector<InsBending> bending{};         ///< of its mount; empty where mounts are rigid
};

/// How a sensor's clock errs: a reading that is logged at t shows the truth at t + offset + drift (t − the grid's
/// middle).
struct InsClock {
  double offset = 0.0;  ///< [s]
  double drift = 0.0;   ///< [s/s]
};

/// Systematic errors of one INS.
struct InsErrors {
  Vec3 rate_bias = Vec3::Zero(), force_bias = Vec3::Zero(), field_bias = Vec3::Zero();
  Mat3 rate_matrix = Mat3::Zero(), force_matrix = Mat3::Zero();  ///< S
  InsClock clock{};
  Mat3 tilt = Mat3::Zero();  ///< [rad per m/s²] of its mount (ins_mount)
};

/// One sigma of what an INS may be wrong by; matrices, clocks and tilts of 0 are not estimated.
struct InsErrorPrior {
  double rate_bias = 0.0, force_bias = 0.0, field_bias = 0.0, rate_matrix = 0.0, force_matrix = 0.0;
  double clock_offset = 0.0, clock_drift = 0.0;
  double tilt = 0.0;
};

/// How the biases of an INS wander about their constants: Gauss-Markov processes, each axis by itself, constant over a
/// stretch of the grid. Standard deviations of 0: they do not.
struct InsWander {
  double rate_sd = 0.0;   ///< [rad/s]
  double force_sd = 0.0;  ///< [m/s²]
  double time = 100.0;    ///< [s] in which a wandering bias forgets

  bool is_none() const { return rate_sd <= 0.0 && force_sd <= 0.0; }
};

struct InsProblem {
  SplineGrid grid;
  bool root_stands_still = true;
  std::vector<InsReadings> sensors;
  InsErrorPrior prior;
  InsWander wander{};
  double gravity = 9.80665;         ///< [m/s²] size of the root's force where it stands still
  double gravity_sd = 0.03;         ///< gravity on Earth is within this
  double point_sd = 3.0;            ///< [m] keeps what no signal tells near the sensors
  double turn_sd = 1.0;             ///< [rad] keeps an azimuth that no signal tells where it started
  std::size_t clock_reference = 0;  ///< sensor whose clock is the machine's
  std::vector<double> anchor;       ///< of each joint's first coefficient: a constant that no signal tells stays there
  InsFacts facts{};                 ///< what else is known
};

struct InsUnknowns {
  MatrixXd band;  ///< channels x coefficients: [root rate, root force] where it moves, then joints
  InsBodies bodies;
  Vec3 root_force = Vec3::Zero();  ///< [m/s²] where the root stands still
  Vec3 root_field = Vec3::Zero();
  std::vector<InsErrors> errors;  ///< one a sensor
  MatrixXd wander{};              ///< [rate, force] of each sensor x stretches; empty: biases are constant
  InsFactUnknowns facts{};
};

/// Where each unknown stands.
struct InsLayout {
  Eigen::Index channels = 0;                      ///< of the band
  Eigen::Index border = 0;                        ///< unknowns that hold for good
  Eigen::Index root_force = -1, root_field = -1;  ///< first of three in the border; −1: not there
  std::vector<Eigen::Index> body, error;          ///< first unknown of each body and sensor in the border
  std::vector<Eigen::Index> channel;              ///< first of each body's joint; −1: none
  Eigen::Index wander = 0;                        ///< unknowns of each stretch: six a sensor, or none
  bool has_field = false, has_matrices = false, has_clocks = false, has_tilts = false;
  Eigen::Index errors_each = 0;  ///< unknowns a sensor: [b_g, b_a, S_g, S_a, b_m, clock, tilt]
  Eigen::Index field_error = -1, clock_error = -1, tilt_error = -1;  ///< where they begin among these; −1: not there
  Eigen::Index facts = -1;  ///< first of what facts make unknown: places, touched points, the surveyor\'s frame
};
InsLayout layout_of(const InsProblem& problem, const InsBodies& bodies);

/// A change of everything unknown.
struct InsStep {
  MatrixXd band;    ///< channels x coefficients
  VectorXd border;  ///< what holds for good
  MatrixXd wander;  ///< unknowns x stretches
};
InsUnknowns changed(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, const InsStep& step);

/// Prior information on the border: cost, and its Gauss-Newton terms (diagonal but for gravity) where asked for.
struct BorderPrior {
  double cost = 0.0;
  MatrixXd matrix;
  VectorXd right;  ///< minus gradient
};
BorderPrior border_prior(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x);

}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
// Thresholds of the diagnosis of a log. Set on half of the machines and seeds of `./dev study log_faults`; the other
// half and the measured logs are reported apart (docs/development/results.md).
#pragma once

#include <cstddef>

namespace kinfer::identify {

/// [nats] By which another unit or another map of axes must explain the instruments better than what the file says.
/// Larger misses faults of sensors that hardly rotate. Sound logs reach 16 (a pendulum of 8 s), faults 50 to 4000.
inline constexpr double min_map_gain = 25.0;
/// The same for other axes than those of the file, before the neighbours are asked: with other axes the segment tree
/// must not get longer. Sound logs reach 240 (all joints of an arm moved at once), faults 200 to 4000.
inline constexpr double min_axes_gain = 85.0;

/// Maps that a sensor's own instruments favour, of which the neighbours choose one. Larger: slower. Drives of 30 to
/// 260 m/s² had the true one third at most.
inline constexpr std::size_t most_favoured_maps = 8;
/// [1/s] Independent rows of a pair's fit, as many as of a section (inertial/diagnosis). Larger: the neighbours count
/// more beside the sensor's own instruments. Right and wrong maps differ by 0.2 to 40 nats a row.
inline constexpr double independent_rows_a_second = 10.0;

/// [nats] By which the segment tree must get shorter with other axes of a sensor that shares no joint with any other by
/// those of the file. Smaller: chance maps the axes of loose sensors. Violent drives of machines of 3 to 7 joints: 1500
/// to 9000 for a true map (30 s), sound sensors 0.
inline constexpr double min_neighbours_axes_gain = 500.0;
/// Sensors without a joint that the neighbours are asked about; more are another machine. Larger: slower.
inline constexpr std::size_t most_asked_sensors = 3;

/// [nats] Most that one sensor says for or against a unit of all. Larger: one odd sensor speaks for a log of two.
inline constexpr double max_sensor_vote = 200.0;

/// [nats] By which the best map must lead the next one to be applied. Smaller leads: the fault is said, the cure is not
/// certain.
inline constexpr double min_map_lead = 6.0;

/// [nats per section] By which a map must explain a sensor better than no rotation at all. Larger: misses faults of
/// sensors that hardly tilt. A sensor waved by hand has 0.5, one that only slews 1.4, others 5 to 40.
inline constexpr double min_gain_per_section = 1.0;
/// The same where two instruments of the sensor agree and the third one alone is to be the odd one, and its gain over
/// the axes that the file says. Sound logs reach 3.1 and 94 (all joints moved at once), faults 160 and more.
inline constexpr double min_gain_per_section_alone = 3.0, min_map_gain_alone = 130.0;

/// Rows in a stretch of copies, and share of a logger's rows that are copies from which a log is refused. Larger:
/// shorter copies count twice. Chance repeats no row of six noisy channels even once in a thousand; rows that a logger
/// sent twice are a few.
inline constexpr std::size_t min_copied_rows = 50;
inline constexpr double max_copied_share = 0.1;

/// [rad/s] A larger mean rate at the quietest moment is no bias. Larger: slow rotations are taken for biases.
inline constexpr double max_quiet_rate = 0.1;

/// [s] Shorter lags are within what filters inside sound sensors do (measured: up to 16 ms), and the refinement of an
/// identification does not mind them. Larger misses shorter lags.
inline constexpr double min_reported_lag = 0.022;

/// [nats] Gain of a lag in the recording. Sound logs in which all joints move together, which no single circle
/// describes, reach 35 with lags of 30 to 60 ms (240 logs); lags of 40 ms have 127 to 440. Larger misses lags of short
/// logs.
inline constexpr double min_lag_gain = 60.0;
/// Part of that gain that one half of the recording may lose: lags of 40 ms lose up to 0.08 of it there.
inline constexpr double max_half_lag_loss = 0.2;
/// Part of that gain that another lag may have. Engines that shake a sensor at rest have many lags of similar gains,
/// half a period apart; a sensor that moves has one. Larger: vibration passes for a lag.
inline constexpr double max_rival_lag_gain = 0.5;
/// [s] Standard deviation of a lag: 0.7 to 1.6 ms for those of 40 ms, 3.7 ms and more in such sound logs.
inline constexpr double max_lag_sd = 2.5e-3;

/// Share of the rows that are copies, or on straight lines between others. Sound logs: below 0.02.
inline constexpr double max_repeated_share = 0.2;

/// [rad] Angles between up and field beyond which the field points out of the ground, as in the southern hemisphere;
/// and between which nothing is said: near the equator, or iron.
inline constexpr double upward_field = 1.05, downward_field = 1.75;

/// Correlation of vertical rates, and the rate shared [rad/s], from which two sensors have the same vertical or
/// opposite ones. Sensors of machines reach 0.7 to 1.0; -0.5 of a wrist and 0.01 rad/s of a pendulum say nothing.
inline constexpr double same_vertical = 0.7, min_vertical_rate = 0.02;

/// [nats per row] By which the segment tree must get shorter when a sensor's vertical is turned over. Sound logs: below
/// 0.
inline constexpr double min_sign_gain = 0.1;
/// [nats per row] By which a negated accelerometer must explain a sensor better than a reversed gyroscope does where
/// other gyroscopes of the log are reversed. Larger: misses a negated accelerometer among reversed gyroscopes.
inline constexpr double likely_sign_lead = 1.0;

/// Median angle between the vertical of Euler angles in the gyroscope's columns and the accelerometer's: [rad], and its
/// share of what angles of zero, or a constant vertical, leave. Rates: 0.79 and more (120 simulated logs, iiwa, UR5,
/// knee); Euler angles: 0.25 and less.
inline constexpr double max_attitude_error = 0.25, max_attitude_share = 0.45;

/// ln of the prior odds that all accelerometers of a log share a scale error: a calibration that was left out, or 1 g
/// that was taken for 10 m/s². Larger finds more of them.
inline constexpr double log_force_scale_odds = -2.0;
/// Size of that error, evenly on a logarithmic scale. Smaller ones hide in what gravity is on Earth; a larger one is
/// another unit.
inline constexpr double least_force_scale = 1e-3, largest_force_scale = 0.3;
/// [m/s²] By which one accelerometer's reading of gravity may be off, biases of 20 mg and scale errors of 3 % among
/// them.
inline constexpr double least_reading_error = 2e-3, largest_reading_error = 0.5;

/// [nats] By which gyroscopes that all read a factor too much or too little, or a clock that runs so fast or slow, must
/// explain the sensors better than what the file says, and better than no rotation. Larger misses them in short logs.
/// Clocks of 0.1 to 3 times: 490 to 870 (an excavator of 53 s). None is found in 40 simulated sound logs, nor in the
/// measured ones (pendulum, DIODEM, iiwa, knee, bicycle, lower body).
inline constexpr double min_rate_factor_gain = 60.0;
/// ln of a factor: the fit itself finds one nearer to 1, and finds it better.
inline constexpr double fitted_log_factor = 0.15;
/// Prior standard deviation of what is left of the factor for the fit.
inline constexpr double rate_factor_sd = 0.05;

/// [rad/s] rms rate from which a sensor may be the copy of another one. Larger: overlooks copies of gentle drives.
inline constexpr double min_duplicate_rate = 0.02;

}  // namespace kinfer::identify

// SPDX-License-Identifier: Apache-2.0
// Thresholds of decisions on INS recordings that are no options: value, effect of a larger one, and the data on which
// it was set. Those that a caller may change are members of the option structs (RestOptions, ActivityOptions,
// ClockOptions, JointSignalOptions, SegmentMotionOptions, the filters' options); those of rests stand in rest/rest.hpp.
#pragma once

#include <cstddef>

namespace kinfer::inertial {

// --- gaps and the common clock (segment_motion)

/// [s] Longest gap across which rows count as measured (linear interpolation). Larger: more rows, of which some are
/// invented; smaller: short outages cost rows. Data: not recorded.
inline constexpr double max_gap = 0.1;
/// [s] Longest gap that is interpolated before a filter runs. Larger: fast motion in the gap becomes an orientation
/// error; smaller: the filter restarts more often. Data: not recorded.
inline constexpr double max_filter_gap = 0.5;
/// Rows of the common clock above which its period is a multiple of the sensors' period. Larger: more memory. Data:
/// not recorded.
inline constexpr double max_clock_rows = 80000.0;
/// [s] Longest such period. Larger: fast motion is lost; smaller: long recordings cost time. The spacing of the
/// motion's spline knots.
inline constexpr double max_clock_period = 0.05;
/// Periods of the sensor in one period of the common clock above which samples are averaged instead of interpolated.
/// Larger: noise aliases. Definition: halfway between one sample and two.
inline constexpr double min_averaging_ratio = 1.5;
/// Usable rows below which a sensor or a recording is refused. Larger: short recordings are refused. Data: not
/// recorded.
inline constexpr std::size_t min_rows = 100;
/// Rows in which all sensors measure below which a recording is refused. Larger: sensors that hardly overlap are
/// refused. Definition: as many as a pair fit needs.
inline constexpr std::size_t min_common_rows = 50;
/// Of SegmentMotionOptions::stationary_rate: a smoothed angular velocity above it is motion. Larger: the first motion
/// is found later. Data: not recorded.
inline constexpr double first_motion_factor = 2.0;

/// Of the rows: the largest accelerations of a segment, spikes too small to be flagged and shocks, that are left out
/// when it is judged whether it is stationary. Larger: a short movement is overlooked. Set on a simulated log with 13
/// spikes a minute, which are 1.5 % of the smoothed rows.
inline constexpr double max_shock_share = 0.02;

// --- gyro bias (headings)

/// [rad/s] (5 °/s per axis) Gyro bias up to which an initial rest is accepted. Larger: a slow rotation at the start is
/// taken as bias; smaller: the bias of a poor gyro is missed. Data: three times the bias of cheap gyros.
inline constexpr double max_initial_gyro_bias = 0.09;

// --- clocks (clock_offset, sensor_clocks)

/// [s] Overlap of two loggers below which a lag is not tried. Larger: fewer chance agreements, but short overlaps are
/// refused. Data: not recorded.
inline constexpr double min_overlap = 10.0;
/// Correlation of two loggers above which their offset is accepted. Larger: more loggers stay unsynchronised; smaller:
/// chance agreements. Data: not recorded.
inline constexpr double min_logger_correlation = 0.3;
/// [s/s] Largest drift between two clocks that is tried: ceramic resonators are within 5000 ppm. Larger takes more
/// time.
inline constexpr double largest_clock_drift = 6e-3;
/// [s/s] Standard deviation of quartz clocks, and drift from which a clock is the odd one among others: three of them.
inline constexpr double usual_clock_drift = 1e-4, odd_clock_drift = 3e-4;
/// [s] Distance of independent samples of angular velocity, and [nats] by which a drift must explain a window better
/// than none. Larger: smaller drifts are left to the fit, which finds up to 500 ppm. Set on excavators of 53 s: 500 ppm
/// and more are found, and no drift on machines whose clocks agree (all four, two scripts).
inline constexpr double independent_rate_time = 0.25, min_drift_gain = 8.0;
/// [nats] Mutual information of two sensors that move together. Larger: fewer sensors are synchronised; smaller: chance
/// agreements. Data: not recorded.
inline constexpr double min_agreement = 0.15;
/// Comparison windows per pair. Larger: better drift, more time. Data: not recorded.
inline constexpr std::size_t max_windows = 12;
/// Of the recording's length: distance of two windows from which their offsets give a drift. Larger: less noise, fewer
/// pairs of windows. Data: not recorded.
inline constexpr double min_window_distance = 0.25;

// --- regular sampling behind the time stamps (sampling_grid)

/// Rows below which no grid is fitted. Larger: short recordings keep their stamps. Data: not recorded.
inline constexpr std::size_t min_grid_rows = 64;
/// Quantile of the steps between rows that is a usual long one, also where rows come in packets of up to 30, and the
/// factor on it from which a step is a gap, behind which the phase of the grid is new. Larger: shorter gaps count as
/// late packets. Data: definition.
inline constexpr double usual_step_quantile = 0.97, gap_over_usual_step = 5.0;
/// [nats] and [standard deviations] Log likelihood ratio of the signals from which regular times replace the stamps.
/// Larger: more stamps are kept. A paired test over windows: 1 in 30 000 by chance at 4 standard deviations.
inline constexpr double min_time_gain = 10.0, min_time_gain_sd = 4.0;
/// [s] and share of the period: scatter of the stamps about the grid below which they are regular. Larger: less jitter
/// is mended. 0.02 of a period at 200 Hz and 10 rad/s² is 1 mrad/s, the noise of a good gyro.
inline constexpr double min_time_scatter = 2e-5, min_time_scatter_share = 0.01;

// --- joint signals

/// |cos(pitch)| below which Euler rates are bounded (1.1° from gimbal lock). Larger: rates are wrong in a wider band;
/// smaller: noise is amplified up to its reciprocal. Data: not recorded.
inline constexpr double min_pitch_cosine = 0.02;

// --- sensor grade

/// [rad/s], [m/s²], - Standard deviations below which a figure no longer distinguishes grades: noise of a rest's mean,
/// variation of gravity on Earth, noise of the estimated scale. Larger: good sensors are not distinguished. Data: not
/// recorded.
inline constexpr double rest_rate_floor = 2e-4, gravity_floor = 0.02, scale_floor = 5e-4;
/// Of the preset's noise density: lower limit of the measured one. Larger: closer to the preset. Guards against rests
/// that a logger has filled with constants. Data: not recorded.
inline constexpr double min_density_share = 0.1;
/// [s] Length of an excerpt for the gyro's scale error, number of excerpts, and length of a recording that is not
/// divided. Longer excerpts: the smoother takes drift for scale. Data:
/// simulated recordings of ten minutes and an hour (docs/methods/long_logs.md).
inline constexpr double scale_excerpt = 60.0, undivided_duration = 120.0;
inline constexpr std::size_t scale_excerpts = 5;

}  // namespace kinfer::inertial

// SPDX-License-Identifier: Apache-2.0
// Thresholds of the continuous-time fit.
// What half and double of those in KINFER_THRESHOLD do to the figures: docs/development/thresholds.md.
#pragma once

#include <array>
#include <cstddef>

#include "kinfer/base/threshold.hpp"

namespace kinfer::identify {

/// [rad] Standard deviation from which an azimuth is unobservable; larger reports fewer. Data not recorded.
KINFER_THRESHOLD(identify, max_azimuth_sd, 0.1);

/// [rad] Axis deviation of a relaxed joint from which it is reported; larger reports fewer. Data not recorded.
inline constexpr double min_reported_axis_deviation = 0.01;

/// [rad/√s], [m/s^1.5] Noise densities of the quietest instruments: fibre gyroscopes have 3·10⁻⁷ rad/√s (0.001 °/√h),
/// servo accelerometers 10⁻⁵. Simulated sensors without noise have 10⁻¹⁴, and the normal equations of such a fit are
/// beyond the arithmetic's precision.
inline constexpr double least_rate_density = 3e-7, least_force_density = 1e-5;
/// Multiples of them that are taken one after another until the arithmetic holds the equations; larger loses accuracy.
/// Of simulated sensors without noise, excavators and arms need the first, telescopes the last.
inline constexpr std::array least_noises{1.0, 10.0, 100.0};

/// Residual noise over noise floor from which a sensor is reported; larger reports fewer. Data not recorded.
inline constexpr double max_sensor_misfit = 3.0;

/// Residual noise over noise floor above which a rigid chain is not valid at full bandwidth and the low-frequency
/// motion is fitted; larger keeps the full bandwidth more often. Set on measured chains with rigid and with soft mounts
/// (DIODEM).
KINFER_THRESHOLD(identify, max_rigid_chain_misfit, 3.0);

/// [s] Clock offset of a fit above which the clocks are corrected and the fit repeated before its bandwidth is limited.
/// Data not recorded.
inline constexpr double max_clock_offset = 1e-3;

/// [rad] Standard deviation of an azimuth by gyroscopes and accelerometers above which it is sought on the whole circle
/// and the magnetometers are asked; larger keeps more machines free of both. The misalignment of magnetometers alone is
/// as large.
inline constexpr double min_weak_azimuth_sd = 3e-3;

/// [rad] The same above which it is that of the weak priors, which say nothing. Between level ground, 0.5 rad and more,
/// and a slope of a degree, 0.02 rad.
inline constexpr double max_azimuth_prior_sd = 0.2;

/// ln of the prior odds that one instrument's scale errors are larger than its grade says; larger finds more. Of
/// simulated sound recordings (four machines, industrial and consumer grade) none exceeds it; errors of 10 prior sd
/// reach ln odds of 57 to 68.
inline constexpr double log_deviant_scale_odds = -7.0;

/// Largest prior standard deviation of an instrument's scale errors, as a share of the measurement, and of the angle
/// [rad] between its axes and the housing: three times what data sheets of uncalibrated consumer sensors state (3 %).
/// Larger takes joints of the wrong type for errors of instruments.
inline constexpr double largest_scale_sd = 0.1;

/// Largest estimate: three such standard deviations. A unit or a range beyond it is found before the fit (diagnosis).
inline constexpr double largest_scale = 3.0 * largest_scale_sd;

/// The same of a factor that all gyroscopes share, which may be the clock's: simulated clocks run up to twice as fast.
inline constexpr double largest_common_scale_sd = 1.0;

/// Largest estimate of that factor; smaller than its inverse, it is impossible, too.
inline constexpr double largest_common_factor = 3.0;

/// [1] regression dilution of an axis that turns: its factor is known to a hundredth then, beside the clock's. Set on
/// excavator, crane and six-axis arm with time stamps times 1.05 and 2.
inline constexpr double turning_dilution = 0.01;

/// [rad per m/s²] Smallest prior of a mount's compliance: 0.1 mrad under the sensor's own weight, which is negligible.
inline constexpr double min_mount_compliance = 1e-5;

/// Factor on the other joints' median gain above which a joint is relaxed; larger relaxes fewer. Data not recorded.
KINFER_THRESHOLD(identify, min_gain_ratio_to_others, 1.3);

/// [Hz] Passband in which it is decided which joints are relaxed. Data not recorded.
KINFER_THRESHOLD(identify, trial_cutoff, 1.0);

/// [s] Smaller clock errors are harmless and not corrected. Data not recorded.
inline constexpr double min_clock_offset = 2e-4;

/// [m] A direction in which a point of the refined geometry has a larger standard deviation is unobservable; smaller
/// reports more of them. Data not recorded.
KINFER_THRESHOLD(identify, max_point_sd, 0.3);

/// Decrease of the sum of log residuals from which a revolute joint is relaxed to a spherical one. Two additional
/// spline dimensions absorb 0.35 of it by chance; to be justified by the Bayesian information criterion (Schwarz 1978)
/// on a minute of low-frequency motion they need about 2. Larger relaxes fewer joints.
KINFER_THRESHOLD(identify, min_relaxation_gain, 2.0);

/// Standard deviations of a clock error after one step from which the fit is repeated with free clocks; smaller repeats
/// more often. Data not recorded.
inline constexpr double clock_suspicion = 4.0;

/// Standard deviations of a clock error from which the free clocks are kept; smaller keeps more. Data not recorded.
KINFER_THRESHOLD(identify, clock_certainty, 6.0);

/// Share of surveyed points and tape lengths that are wrong: another point, a digit, a target that moved. Larger doubts
/// more of them.
inline constexpr double wrong_fact_prior = 0.01;

/// Log odds from which such a fact is wrong, and from which it is this one: 20 to 1.
inline constexpr double clear_fact_log_odds = 3.0;

}  // namespace kinfer::identify

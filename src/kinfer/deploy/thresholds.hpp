// SPDX-License-Identifier: Apache-2.0
// Thresholds of verification, comparison and compensation. The data on which they were set are not recorded.
#pragma once

namespace kinfer::deploy::thresholds {

/// [1] rms error over the instrument's noise: above it, a calibration is no longer valid. Larger accepts worse ones.
inline constexpr double noise_ratio = 3.0;
/// [1] error with base and tool refitted over the unmodified one: below it, the frames were moved. For an unknown
/// instrument only.
inline constexpr double refit_ratio = 0.5;
/// Measured numbers beyond the unknowns of base and tool from which a refit tells moved frames from a changed robot.
/// Table 3's robot with one joint bent by 0.1 degrees, twelve sets of poses: of those that no frame can explain 13 of
/// 120 are called moved at 3 (four points), 1 at 6, none at 9 and more.
inline constexpr int least_redundancy = 6;
inline constexpr double least_point_sd = 1e-8;  ///< [m] floor of the instrument's noise

/// Probability that any unchanged parameter is called changed (Holm).
inline constexpr double changed_risk = 0.01;
inline constexpr int compared_poses = 200;  ///< samples of the joint ranges at which two tools are compared

/// [1] tolerances: a corrected base further off shows that the instrument used another world frame.
inline constexpr double frames_apart = 3.0;
inline constexpr int joints_for_full_pose = 6;  ///< with fewer, only the tool point is compensated

/// [1] of the reach of the fitted rows: joint positions farther from these count as outside the measured region. Of the
/// fitted rows 5 % have a distance above 1.
inline constexpr double outside_distance = 1.5;

}  // namespace kinfer::deploy::thresholds

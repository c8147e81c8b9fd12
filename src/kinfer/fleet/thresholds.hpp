// SPDX-License-Identifier: Apache-2.0
// Thresholds of the fleet's room: risks that the user can be told, and sizes below which nothing is concluded.
#pragma once

namespace kinfer::fleet::thresholds {

/// [1] Probability that a fleet in which nothing is unusual has a deviation listed, over all its numbers (Bonferroni).
inline constexpr double fleet_risk = 0.05;

/// [1] Expected false alarms of all control charts of one fleet together.
inline constexpr double chart_risk = 0.05;

/// [rows] A robust spread of fewer is too uncertain to judge a row by: the relative error of 1.4826 MAD is 1.17 / √n.
inline constexpr int smallest_fleet = 10;

/// [1] Efficiency of the median absolute deviation for Gaussian data (Rousseeuw and Croux 1993): a robust spread of n
/// rows is as uncertain as a standard deviation of 0.37 n rows.
inline constexpr double robust_efficiency = 0.37;

/// [checks] A series of fewer has no history to compare with: the first three give the mean and its spread.
inline constexpr int shortest_series = 4;

/// [standard deviations] Half of the smallest lasting change that the control chart is tuned to (Page 1954: one sigma).
inline constexpr double chart_allowance = 0.5;

/// [robots] More add nothing to a prior of some tens of parameters, but cost time: an even sample is taken.
inline constexpr int largest_sample = 200;

/// [robots] Fewer than these with informative data make no population.
inline constexpr int fewest_robots = 2;

/// [1] Share of the population's robots that count in full; one that is farther off weighs less by its squared
/// distance.
inline constexpr double population_share = 0.999;

/// [robots] Weight of the nominal values beside the mean of the robots.
inline constexpr double nominal_robots = 1.0;

}  // namespace kinfer::fleet::thresholds

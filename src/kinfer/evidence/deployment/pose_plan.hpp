// SPDX-License-Identifier: Apache-2.0
// Which poses to measure, and the calibration accuracy to expect from them.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "kinfer/linalg/types.hpp"

namespace kinfer {

enum class Criterion {
  tool,   ///< mean square error of the tool over the workspace (I-optimal)
  worst,  ///< largest error of the tool over the workspace (G-optimal)
  d,      ///< volume of the parameters' uncertainty (D-optimal)
  a,      ///< sum of their variances (A-optimal)
  e,      ///< variance of their least certain combination (E-optimal)
};
/// As of --criterion: "tool", "worst", "d", "a", "e"
std::string_view name(Criterion criterion);
std::optional<Criterion> criterion_named(std::string_view name);

/// Expected tool error over the workspace after a calibration with this number of poses [m].
struct ExpectedError {
  int poses = 0;
  double rms = 0.0, worst = 0.0;
};

struct PosePlan {
  Criterion criterion = Criterion::tool;
  MatrixXd joints;               ///< dof x poses, [rad] or [m], ordered for short travel
  std::vector<int> candidates;   ///< candidate index of each pose, where the poses were chosen from a list
  int parameters = 0, rank = 0;  ///< free parameters, and how many combinations of them are identifiable from any poses
  /// O1-O5 of the poses (existing ones included) over the identifiable combinations, scaled by noise and
  /// tolerance: geometric mean of the singular values over √poses (Borm, Menq 1991), inverse condition number
  /// (Driels, Pathre 1990), smallest singular value (Nahvi et al. 1994), noise amplification (Nahvi, Hollerbach 1996),
  /// inverse sum of inverses (Sun, Hollerbach 2008).
  std::array<double, 5> observability{};
  ExpectedError expected, existing, random;  ///< with the plan; with the existing rows only; with as many random poses
  double rms_lower_bound =
      0.0;  ///< [m] lower bound over all choices of as many candidates; for criterion `tool`, else 0
  std::vector<ExpectedError> planned_curve, random_curve;  ///< by number of poses
  std::vector<int> redundant_rows;                         ///< existing rows with almost no information
  double noise = 0.0;                                      ///< [m] of the instrument, per axis, at a typical pose
  double travel = 0.0, travel_unordered = 0.0;             ///< [rad] sum of the largest joint motion between poses
};

}  // namespace kinfer

// Which poses to measure, and what they are expected to be worth.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "kinfer/linalg/types.hpp"

namespace kinfer {

/// What a calibration from so many poses is expected to leave: error of the tool over the workspace [m].
struct ExpectedError {
  int poses = 0;
  double rms = 0.0, worst = 0.0;
};

struct PosePlan {
  std::string criterion;
  MatrixXd joints;               ///< dof x poses, [rad] or [m], in the order of least travel
  std::vector<int> candidates;   ///< of each pose, where it was chosen from a list
  int parameters = 0, rank = 0;  ///< free parameters, and how many combinations any poses could tell
  /// O1-O5 of the poses (existing ones included) over the combinations that can be told, in units of noise and
  /// tolerance: geometric mean of the singular values over √poses (Borm, Menq 1991), inverse condition number
  /// (Driels, Pathre 1990), smallest singular value (Nahvi et al. 1994), noise amplification (Nahvi, Hollerbach 1996),
  /// inverse sum of inverses (Sun, Hollerbach 2008).
  std::array<double, 5> observability{};
  ExpectedError expected, existing, random;  ///< with the plan; with the existing rows alone; with as many random poses
  double least_rms = 0.0;  ///< [m] no choice of as many of the candidates leaves less; for criterion `tool`, else 0
  std::vector<ExpectedError> planned_curve, random_curve;  ///< by number of poses
  std::vector<int> superfluous;                            ///< existing rows that tell hardly anything
  double noise = 0.0;                                      ///< [m] of the instrument, per axis, at a typical pose
  double travel = 0.0, travel_as_chosen = 0.0;             ///< [rad] sum of the largest joint motion between poses
};

}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
// Rests of a stream of positions: joints of a robot or points of a tracker.
#pragma once

#include <string>
#include <vector>

#include "kinfer/linalg/types.hpp"

namespace kinfer {

struct Rest {
  std::string name{};             ///< of a row with a name; else empty
  double begin = 0.0, end = 0.0;  ///< [s]; both 0 for a list without time
  VectorXd mean{};                ///< over its rows
  VectorXd scatter{};             ///< standard deviation of a row; 0 where there is one row only
  int first_row = 0, rows = 1;
};

/// Rests of a stream with strictly increasing `time` [s]; `values`: dimensions x rows, in one unit each. A window of
/// 0.25 s rests if its spread belongs to the lower of the two groups into which the spreads of all windows divide (Otsu
/// 1979, on their logarithms). Rests last at least `shortest` [s].
std::vector<Rest> find_rests(const std::vector<double>& time, const MatrixXd& values, double shortest = 0.5);

/// A list: each row is a rest, consecutive rows of one name, or of equal `keys` columns, are one. `keys`: any
/// dimensions x rows; empty: names alone.
std::vector<Rest> rests_of_list(const MatrixXd& values, const std::vector<std::string>& names, const MatrixXd& keys);

}  // namespace kinfer

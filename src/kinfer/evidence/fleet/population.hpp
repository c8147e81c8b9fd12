// SPDX-License-Identifier: Apache-2.0
// The distribution of the joint parameters over the robots of one type, as a prior for the next robot of it.
#pragma once

#include <string>
#include <vector>

#include "kinfer/linalg/types.hpp"

namespace kinfer {

struct PopulationPrior {
  std::vector<std::string> names{};  ///< joint parameters as in robot files
  VectorXd nominal{}, tolerance{};   ///< n, SI: of the data sheet
  VectorXd mean{};                   ///< n, SI
  MatrixXd covariance{};             ///< n x n, SI, positive definite: of one robot about the mean, and of the mean
  int robots = 0;
  double pseudo_robots = 0.0;  ///< weight of the uncorrelated covariance that the robots' own is shrunk towards
};

}  // namespace kinfer

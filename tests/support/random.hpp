// SPDX-License-Identifier: Apache-2.0
// Random vectors and matrices for tests.
#pragma once

#include "kinfer/geometry/random.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer::test {

/// Unit variance along each axis.
inline Vec3 random_vector(Rng& rng) {
  return normal_vector(rng);
}

/// Unit variance of each entry.
inline MatrixXd random_matrix(Eigen::Index rows, Eigen::Index cols, std::uint64_t seed) {
  Rng rng(seed);
  return MatrixXd::NullaryExpr(rows, cols, [&] { return rng.normal(); });
}

}  // namespace kinfer::test

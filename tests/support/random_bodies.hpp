// SPDX-License-Identifier: Apache-2.0
// Bodies of the continuous-time fit with random orientations of the axis, drawn in the parent first.
#pragma once

#include "kinfer/estimate/continuous/model/chain_propagation.hpp"
#include "support/random.hpp"

namespace kinfer::test {

inline Mat3 random_rotation(Rng& rng) {
  return exp_so3(random_vector(rng));
}

inline InsBody random_revolute_body(int parent, int sensor, Rng& rng) {
  const Mat3 parent_R_axis = random_rotation(rng), child_R_axis = random_rotation(rng);
  return revolute_body(parent, sensor, parent_R_axis, child_R_axis);
}

inline InsBody random_prismatic_body(int parent, int sensor, Rng& rng) {
  const Mat3 parent_R_axis = random_rotation(rng), child_R_axis = random_rotation(rng);
  return prismatic_body(parent, sensor, parent_R_axis, child_R_axis);
}

}  // namespace kinfer::test

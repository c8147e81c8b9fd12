// SPDX-License-Identifier: Apache-2.0
// A crane whose azimuths nothing tells.
#pragma once

#include "kinfer/base/rng.hpp"
#include "kinfer/estimate/continuous/model/problem.hpp"
#include "support/random_bodies.hpp"

namespace kinfer::test {

/// A house that rotates about its first joint with a boom on it, and an arm behind the boom.
struct Crane {
  InsProblem problem;
  InsUnknowns x;
  InsLayout layout;

  explicit Crane(const Vec3& boom_axis_in_joint = Vec3::UnitX()) {
    Rng rng(3);
    problem.grid = {.begin = 0.0, .period = 0.1, .intervals = 12};
    problem.sensors.resize(4);
    x.bodies = {{.sensor = 0}};
    for (int b = 1; b < 4; ++b) {
      x.bodies.push_back(random_revolute_body(b - 1, b, rng));
      x.bodies.back().point_in_parent = random_vector(rng);
      x.bodies.back().point_in_child = random_vector(rng);
    }
    x.bodies[2].parent_R_axis = x.bodies[1].child_R_axis * frame_with_z_along(boom_axis_in_joint);
    x.errors.resize(4);
    layout = layout_of(problem, x.bodies);
    x.spline_coefficients = random_matrix(layout.spline_dimensions, problem.grid.coefficients(), 5);
    x.root_force = 9.8 * x.bodies[1].parent_R_axis.col(2);  // the first axis is vertical
  }
};

inline constexpr InsAzimuth boom{1, 2};

}  // namespace kinfer::test

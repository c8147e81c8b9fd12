// SPDX-License-Identifier: Apache-2.0
// The problem on which kernels and searches are measured: paper 2's robot (d6 = 225 mm), its 24 parameters, table 3's
// errors, 50 poses without noise.
#pragma once

#include "kinfer/calibrate/parameters/parameter_sets.hpp"
#include "kinfer/kinematics/batch/chain_plan.hpp"
#include "support/robots.hpp"

namespace kinfer::bench {
using namespace calibrate;

constexpr int poses = 50, particles = 200;

struct Paper2Case {
  Chain nominal = test::er20(0.225);
  PoseSet data = test::measured(test::with_table3_errors(nominal), test::paper2_poses(poses, test::noise_free));
  ParameterSet set = paper_dh_parameters(nominal, {}).value();
  PointTable table;
  VectorXd start = pack(set, nominal);
  MatrixXd swarm;  ///< 24 x particles, about the start

  Paper2Case() {
    table.joints = data.joints;
    table.measured.resize(3, poses);
    for (int i = 0; i < poses; ++i) table.measured.col(i) = data.points[i].position;
    swarm = start.replicate(1, particles);
    Rng rng(1);
    for (double& v : swarm.reshaped()) v += 1e-3 * rng.uniform(-1, 1);
  }
};

inline const Paper2Case& paper2_case() {
  static const Paper2Case made;
  return made;
}

}  // namespace kinfer::bench

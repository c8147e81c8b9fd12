// SPDX-License-Identifier: Apache-2.0
// Simulated measurements of further instruments at the poses of a set, with known truth and noise.
#pragma once

#include <cmath>

#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "support/random.hpp"
#include "support/robots.hpp"

namespace kinfer::test {

inline Vec3 noise(Rng& rng, double sd) {
  return sd * random_vector(rng);
}

/// The joint positions of the set, without measurements.
inline PoseSet readings_of(const PoseSet& set) {
  PoseSet bare;
  bare.joint_names = set.joint_names, bare.joints = set.joints, bare.payload = set.payload;
  bare.temperature = set.temperature, bare.torques = set.torques, bare.approach = set.approach;
  bare.mounting = set.mounting, bare.line = set.line;
  return bare;
}

inline std::vector<Pose> true_poses(const Chain& truth, const PoseSet& set) {
  return evaluate_poses(truth, {}, set, Derivative::no).pose;
}

/// Tool points by a tracker, with the loads and mountings of the rows.
inline void measure_points(PoseSet& set, const Chain& truth, const Instrument& instrument, Rng rng) {
  const std::vector<Pose> poses = true_poses(truth, set);
  for (int row = 0; row < set.rows(); ++row) {
    const Vec3 p = poses[row].position;
    set.points.push_back({row, -1, p + noise(rng, position_sd(instrument, p)), {}});
  }
}

/// Each row's distance to every anchor of the truth.
inline void measure_distances(PoseSet& set, const Chain& truth, double sigma, Rng rng) {
  const std::vector<Pose> poses = true_poses(truth, set);
  for (int row = 0; row < set.rows(); ++row)
    for (int a = 0; a < static_cast<int>(truth.fixtures.anchors.size()); ++a) {
      const int mounting = set.mounting.empty() ? -1 : set.mounting[row];
      const Vec3 anchor = with_mounting(truth, mounting).base.pose() * truth.fixtures.anchors[a];
      set.distances.push_back({row, a, (poses[row].position - anchor).norm() + sigma * rng.normal()});
    }
}

/// Ball-bars between row 2k and row 2k + 1.
inline void measure_pairs(PoseSet& set, const Chain& truth, double sigma, Rng rng) {
  const std::vector<Pose> poses = true_poses(truth, set);
  for (int row = 0; row + 1 < set.rows(); row += 2)
    set.pairs.push_back({row, row + 1, (poses[row].position - poses[row + 1].position).norm() + sigma * rng.normal()});
}

inline void measure_tilts(PoseSet& set, const Chain& truth, double sigma, Rng rng) {
  const std::vector<Pose> poses = true_poses(truth, set);
  for (int row = 0; row < set.rows(); ++row)
    set.tilts.push_back({row, -(poses[row].rotation.transpose() * truth.gravity) + noise(rng, sigma)});
}

/// Joint positions that bring the true tool point to `goal(row)`, as near as the joints allow: a few Newton steps on
/// the position alone from the given joint positions, with a little noise at the end.
template <class Goal>
void touch(PoseSet& set, const Chain& truth, const Goal& goal, double sigma, Rng rng) {
  const PoseEvaluator evaluator(truth, {});
  for (int row = 0; row < set.rows(); ++row) {
    VectorXd q = set.joints.col(row);
    const Vec3 wanted = goal(row) + noise(rng, sigma);
    for (int step = 0; step < 60; ++step) {
      const Vec3 off = wanted - evaluator.pose(q).position;
      if (off.norm() < 1e-12) break;
      const MatrixXd j = jacobian(truth, q).topRows<3>();
      const Mat3 damped = j * j.transpose() + 1e-6 * Mat3::Identity();
      const VectorXd by = j.transpose() * damped.inverse() * off;
      q += by * std::min(1.0, 0.3 / (by.norm() + 1e-300));
    }
    set.joints.col(row) = q;
  }
}

}  // namespace kinfer::test

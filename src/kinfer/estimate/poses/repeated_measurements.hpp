// SPDX-License-Identifier: Apache-2.0
// Measurements of one quantity at one commanded pose, again and again: the error of the model is common to them.
//
// With the variance r² of each row and p² of the model at a pose, m rows of it have the covariance r² I + p² 11ᵀ, whose
// inverse maps 1 to 1 / (r² + m p²). A parameter changes the residuals of all of them alike, so that they say as much
// of it as m independent ones of the variance r² + m p².
#pragma once

#include <array>
#include <vector>

#include "kinfer/kinematics/chain.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// The set with the commanded pose of each row.
PoseSet with_commanded_poses(PoseSet data, const Chain& chain);

/// The state of each row, numbered in the order of their first rows: rows of one state have the pose, the mounting, the
/// payload and the temperature [K] in common. `poses`: the pose of each row.
std::vector<int> states_of_rows(const PoseSet& data, const std::vector<int>& poses);

/// Of one kind: the group of each measurement, numbered in the order of their first ones, and their sizes. Those of one
/// group have the state of their rows and the fixture or target in common. Empty:
/// nothing was repeated.
struct RepeatedMeasurements {
  std::vector<int> group;
  std::vector<double> size;

  bool empty() const { return group.empty(); }
  double size_of(std::size_t measurement) const { return size[static_cast<std::size_t>(group[measurement])]; }
};

/// Ball-bars are never repeated: they belong to two poses.
std::array<RepeatedMeasurements, measurement_kinds> repeated_measurements(const PoseSet& data);

}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
// Weygers and Kok (IEEE Sensors Journal 20(14), 2020), for comparison: the relative orientation of two sensors on
// neighbouring segments, from their gyroscopes and from the acceleration of the joint's centre, which both must see
// alike in the world,
//
//   0 = R₁ (f₁ + K₁ r₁) − R₂ (f₂ + K₂ r₂),  K = [ω̇×] + [ω×]²,
//
// in an error-state filter of both orientations, R ← exp(η) R. No axis, no other joint and no gravity are used. Biases
// and centres r are those of the identified chain; ω̇ is a difference of neighbouring rows.
#pragma once

#include <vector>

#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/measurement/ins/ins_row.hpp"

namespace kinfer::study::track_study {

class PairwiseFilters {
 public:
  explicit PairwiseFilters(const TrackingModel& model);

  void add(const InsRow& row);

  /// parent_R_child of a joint at the last row but one; NaN: a joint that does not connect two sensors about one
  /// centre.
  Mat3 rotation(std::size_t joint) const;

 private:
  struct Sensor {
    Mat3 world_R_sensor = Mat3::Identity();
    Vec3 rate = Vec3::Zero(), change = Vec3::Zero(), force = Vec3::Zero();  // corrected by the biases; ω̇
    Vec3 mean_rate = Vec3::Zero();                                          // since the row before
    double rate_sd = 0.0, force_sd = 0.0, change_sd = 0.0;                  // of one row
  };
  struct Pair {
    std::size_t parent = 0, child = 0;
    Vec3 in_parent = Vec3::Zero(), in_child = Vec3::Zero();  // the centre
    Mat3 world_R_parent = Mat3::Identity(), world_R_child = Mat3::Identity();
    Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Identity();
    bool is_used = false, has_started = false;
  };

  void update(Pair& pair, double dt) const;

  const TrackingModel& model_;
  std::vector<Sensor> sensors_;
  std::vector<Pair> pairs_;  // of each joint
  InsRow before_, last_;
  int rows_ = 0;
};

}  // namespace kinfer::study::track_study

// SPDX-License-Identifier: Apache-2.0
// The relations that a revolute joint imposes on the measurements of two sensors without any orientation, and their
// parameters with a change at a split of the recording (see remount.hpp).
#pragma once

#include <array>
#include <vector>

#include "kinfer/inertial/segment_motion.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer::identify {

/// Common form of the two relations: |v_a| = |v_b|, v = constant + effect · p, p a parameter of the sensor (j or r).
struct MountRelation {
  double huber_threshold = 0.0;  // Huber threshold of a residual
  double minimum = 0.0;          // residual rms of an ideal joint
  bool is_direction = false;     // p is a direction
  double min_change = 0.0;       // smallest significant change of p
  double prior_weight = 0.0;     // prior weight (in rows) of p = 0, for unobservable directions
};
inline constexpr MountRelation gyro_relation{.huber_threshold = 0.02,
                                             .minimum = 0.0005,
                                             .is_direction = true,
                                             .min_change = 0.03,
                                             .prior_weight = 0.0};  // [rad/s], [rad]
inline constexpr MountRelation force_relation{.huber_threshold = 0.2,
                                              .minimum = 0.015,
                                              .is_direction = false,
                                              .min_change = 0.03,
                                              .prior_weight = 0.05};  // [m/s²], [m]

struct RelationRow {
  Vec3 constant = Vec3::Zero();
  Mat3 jacobian = Mat3::Zero();
};
using RelationRows = std::vector<RelationRow>;

/// One sensor's part of a relation at the evaluated rows.
RelationRows relation_rows(const SegmentMotion& m, const std::vector<std::size_t>& at, const MountRelation& relation,
                           double gravity);

/// Parameters of the two sensors, before and after the split; equal if they are not separate.
using SplitParameters = std::array<std::array<Vec3, 2>, 2>;  // [sensor][part]

struct SplitSensors {
  bool first = false, second = false;
};

struct SplitFit {
  SplitParameters p;
  double rms = 0.0;  // [rad/s] or [m/s²], residuals clipped at five scales
};

class PairRelation {
 public:
  PairRelation(const RelationRows& a, const RelationRows& b, const MountRelation& relation)
      : rows_of_sensors_{&a, &b}, relation_(relation) {}

  /// Best parameters with a change of the given sensors at row `split`.
  SplitFit fit(std::size_t split, SplitSensors split_sensors) const;

  /// The least residual rms with the second sensor's direction in that part of the fit across what it is: near the
  /// fit's own where the part does not determine it.
  double rms_across(const SplitFit& fit, std::size_t split, std::size_t part) const;

 private:
  std::vector<Vec3> starts() const;
  double residual(const SplitParameters& p, std::size_t row, std::size_t part) const;
  double rms(const SplitParameters& p, std::size_t split) const;

  /// Levenberg-Marquardt with Huber's weights.
  SplitFit fit_from(const SplitParameters& p, std::size_t split, SplitSensors split_sensors) const;
  void accumulate(const SplitParameters& p, std::size_t split, SplitSensors split_sensors, MatrixXd& matrix,
                  VectorXd& right) const;
  SplitParameters updated(SplitParameters p, const VectorXd& step, SplitSensors split_sensors) const;

  std::array<const RelationRows*, 2> rows_of_sensors_;
  MountRelation relation_;
};

}  // namespace kinfer::identify

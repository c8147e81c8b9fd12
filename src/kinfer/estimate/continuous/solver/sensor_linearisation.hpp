// SPDX-License-Identifier: Apache-2.0
// One sensor's measurements in one interval as whitened, robustly weighted residual rows with their Jacobian.
//
// The gyroscope does not depend on points, nor either instrument on the errors of the other: so the rows come in two
// parts, each with its own columns.
#pragma once

#include "kinfer/estimate/continuous/model/interval_motion.hpp"
#include "kinfer/estimate/continuous/model/mount_compliance.hpp"
#include "kinfer/estimate/continuous/solver/block_residual.hpp"

namespace kinfer {

/// The rows of one instrument: its measurements and its bounds.
struct SensorRows {
  std::vector<Eigen::Index> band;    ///< of each spline column: i·dimensions + dimension in the interval, ascending
  std::vector<Eigen::Index> border;  ///< of each further column: its global parameter
  MatrixXd jacobian;                 ///< transposed: columns x rows
  VectorXd residual;
  VectorXd weight;        ///< robust weight of each row, by which jacobian and residual are multiplied
  Eigen::Index used = 0;  ///< rows of this interval

  // First columns of each group; unused if the group is absent or held.
  Eigen::Index rotational = 0, translational = 0, bias = 0, matrix = 0, tilt = 0, clock = 0;
};

/// One sensor, interval by interval. The constructor's arguments must outlive it.
class SensorLinearisation {
 public:
  SensorLinearisation(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                      const IntervalMotion& motion, std::size_t body, LinearisationScope scope);

  /// The interval at which `motion` stands.
  void move_to(Eigen::Index interval);

  const std::array<SensorRows, 2>& parts() const { return parts_; }

 private:
  /// One block: its row i is Σ weight(i, node) · (prediction at the node).
  struct WeightedBlock {
    const InstrumentMeasurements& instrument;
    SensorRows& part;
    NodeMatrix weight;
    std::array<Mat3, block_nodes> by_state;  // derivative of the prediction with respect to the segment's state
    Eigen::Index first, rows;                // of its rows in the part, three per row of the block
  };
  void append_global_columns(const InsPath& path);
  void update_sensor_states(Eigen::Index interval);
  void add_rows(const InstrumentMeasurements& instrument, Eigen::Index interval);
  void put_spline_columns(const WeightedBlock& block);
  void put_global_columns(const WeightedBlock& block, const Eigen::Ref<const MatrixXd>& by_unknowns,
                          Eigen::Index column);
  void put_errors(const WeightedBlock& block);
  void put_clock(const WeightedBlock& block, const BlockResidual& by_shift, Eigen::Index interval);
  Mat3 scaled(const InstrumentMeasurements& instrument) const;

  const InsProblem& problem_;
  const InsLayout& layout_;
  const InsUnknowns& x_;
  const IntervalMotion& motion_;
  std::size_t body_, sensor_;
  LinearisationScope scope_;
  std::array<SensorRows, 2> parts_;  // gyroscope, accelerometer
  std::vector<InstrumentMeasurements> instruments_;
  InsErrors errors_;
  std::array<MountDerivative, block_nodes> on_mount_;
};

}  // namespace kinfer

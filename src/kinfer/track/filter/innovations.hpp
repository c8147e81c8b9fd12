// SPDX-License-Identifier: Apache-2.0
// How an update came out: each sensor's innovation given all others, what a change of it alone would explain, and by
// what time it seems late.
#pragma once

#include <vector>

#include "kinfer/track/filter/update_system.hpp"

namespace kinfer::track {

using SensorVector = Eigen::Matrix<double, sensor_rows, 1>;
using SensorMatrix = Eigen::Matrix<double, sensor_rows, sensor_rows>;

/// vᵀ m⁻¹ v.
double squared_distance(SensorVector v, SensorMatrix m);

/// Score and information of the time by which a sensor's measurements are later than they are taken to be.
struct LatenessScore {
  double score = 0.0, information = 0.0;  ///< [1/s], [1/s²]
};

/// Score and information of a turn of a sensor's mounting, in the sensor's frame: turned by θ it measures (I + [θ]×) z.
struct TurnScore {
  Vec3 score = Vec3::Zero();        ///< [1/rad]
  Mat3 information = Mat3::Zero();  ///< [1/rad²]
};

struct Innovations {
  VectorXd value;                 ///< measured minus predicted, rows of the sensors
  std::vector<double> leave_out;  ///< T of each sensor against all others, its expectation being `leave_out_rows`
  std::vector<int> rows;          ///< of each sensor that were measured: 0, 3 or 6; of sensors out of use too
  std::vector<double> of_joint;   ///< T of each joint, its expectation being `change_rows`; 0: not compared
  /// The same two before instruments that are far off are trusted less: what a change of it alone would explain.
  std::vector<double> unlimited, unlimited_of_joint;
  std::vector<LatenessScore> lateness;  ///< of each sensor, by its leave-one-out innovation
  std::vector<TurnScore> turn;          ///< likewise
  double log_likelihood = 0.0;          ///< of this block
  /// Of each instrument, gyroscope and accelerometer of a sensor in turn: T over its expectation.
  std::vector<double> of_instrument;

  explicit Innovations(const FilterModel& model);
};

/// Leave-one-out innovations from the factorised system: with u = S⁻¹ν the innovation of sensor i given all others is
/// [(S⁻¹)_ii]⁻¹u_i, with covariance [(S⁻¹)_ii]⁻¹. `predicted`: by which the system was formed; `change`: of the
/// predicted rows [1/s].
void examine_sensors(const UpdateSystem& system, const std::vector<bool>& is_used, const ChainMeasurement& predicted,
                     const VectorXd& change, Innovations& innovations);

}  // namespace kinfer::track

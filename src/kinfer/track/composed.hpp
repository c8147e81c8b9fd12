// SPDX-License-Identifier: Apache-2.0
// Tracking without the chain: each sensor's orientation by a filter of its own, without magnetometer, and each joint's
// position from the orientations of its two sensors. What a tracker on the whole chain must not be worse than.
//
// Headings of two such filters have nothing in common. Each joint therefore has the difference δ of its two sensors'
// headings, a random walk that the joint's axis measures where it is inclined: seen from both sides, a and b, its
// horizontal parts agree (Laidig, Lehmann, Begin and Seel, EMBC 2019), to stray_angle / sin(inclination). Slowly,
// because a tight constraint turns the errors of axes into heading.
#pragma once

#include <complex>
#include <vector>

#include "kinfer/evidence/tracking/track_state.hpp"
#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/inertial/filters/kinfer_filter.hpp"
#include "kinfer/measurement/ins/ins_row.hpp"
#include "kinfer/track/options.hpp"

namespace kinfer::track {

/// The child's axis as both orientations place it across the parent's, y = y₁ + i y₂, over the last seconds, each row
/// by the variance that is expected of it. An error of the identified axis stays the same in the parent, or turns with
/// the child: y = a + b exp(iq). What neither explains is the error of the orientations, and the axis' own stray.
class AxisSpread {
 public:
  /// `across`: y [rad], `position`: q [rad], `expected`: variance of y per direction [rad²], over `dt` [s].
  void add(const Eigen::Vector2d& across, double position, double expected, double dt);

  /// By which the variance of y about a + b exp(iq) exceeds what was expected; at least 1.
  double excess() const;

 private:
  std::complex<double> across_{}, turn_{}, product_{};  // means of y, of exp(iq) and of y exp(−iq), by weight
  double square_ = 0.0;                                 // mean of |y|², by weight
  double weight_ = 0.0, watched_ = 0.0;                 // mean of 1 / expected variance; [s]
};

/// Copyable. Displacements of prismatic joints are unknown (NaN): orientations do not determine them.
class ComposedFilters {
 public:
  explicit ComposedFilters(const TrackingModel& model, const TrackOptions& options = {});

  void add(const InsRow& row);

  /// At the time of the last row; alarms and innovations are empty.
  const TrackState& state() const { return state_; }

  /// [rad²] by which the heading of a joint's child in its parent may have drifted since the start.
  double drift(std::size_t joint) const { return joints_[joint].drift; }
  /// [rad²] per direction, of the rotation between a joint's sensors but for its heading: as their filters
  /// and the accelerometers' errors make it, times the excess of what they see of a revolute joint's axis.
  double tilt_variance(std::size_t joint) const;
  /// Up, in the frame of the joint's parent sensor.
  Vec3 vertical(std::size_t joint) const;

 private:
  /// A joint's sensors and the difference of their headings: rotation of the child's world into the parent's.
  struct Joint {
    int index = 0;  // into the model's joints
    int parent_sensor = -1, child_sensor = -1;
    double heading = 0.0, heading_variance = 0.0;  // [rad], [rad²]
    double drift = 0.0;                            // [rad²] of both filters' headings since the start
    double filters_variance = 0.0;                 // [rad²] of both headings, as the filters state it
    AxisSpread axis{};
    bool started = false;
  };

  void update_joint(Joint& joint, double dt);
  void let_heading_drift(Joint& joint, double dt);
  void watch_axis(Joint& joint, double dt);
  Mat3 rotation_covariance(const Joint& joint) const;
  double across_variance(const Joint& joint) const;
  Mat3 shrunk(const Joint& joint, const Mat3& relative) const;
  Mat3 relative_rotation(const Joint& joint) const;
  void start_heading(Joint& joint);
  void measure_heading(Joint& joint, double dt);
  void read_positions(const Joint& joint);
  void read_rotation(const Joint& joint, const Mat3& relative);
  void read_tool();

  TrackingModel model_;
  TrackOptions options_;
  std::vector<KinferFilter> filters_;
  std::vector<double> accelerometer_tilt_;  // [rad²] per direction, of each sensor, by its accelerometer's errors
  std::vector<Vec3> rate_;                  // [rad/s] of each sensor, without bias
  std::vector<Joint> joints_;
  TrackState state_;
};

}  // namespace kinfer::track

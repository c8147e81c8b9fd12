// SPDX-License-Identifier: Apache-2.0
// Do no harm: the position of a joint by the chain and that by the orientations of its two sensors alone are averaged
// by their variances,
//   q = q_chain + w (q_composed − q_chain),  w = P_chain / (P_chain + P_composed)
// Where the chain fits, its variance is so much the smaller that w is zero. Where it does not, the filter's instruments
// are trusted less and its variance says so; the errors of both are mostly independent, and the mean is better than
// either.
#pragma once

#include <optional>

#include "kinfer/evidence/tracking/track_state.hpp"
#include "kinfer/track/composed.hpp"

namespace kinfer::track {

class JointFusion {
 public:
  explicit JointFusion(const TrackingModel& model);

  /// What may be averaged; other joints are left alone.
  struct Usable {
    const std::vector<bool>& is_sound;    ///< of each sensor
    const std::vector<bool>& is_settled;  ///< of each joint: not one of several starts that are still possible
    const std::vector<std::optional<double>>& heading_sd;  ///< [rad] of each spherical joint that motion shows
  };

  /// Averages joints of `chain`, the state of the filter, with those of `composed` at the same time; positions that
  /// count from the start stay continuous.
  void apply(const TrackingModel& model, const ComposedFilters& composed, const Usable& usable, TrackState& chain);

  /// After a start the positions count from elsewhere.
  void reset();

  /// Share of the composed position in that of any joint, the largest.
  double largest_share() const;

 private:
  /// What is added to the heading of the child in the parent by the composed filters, where one of both counts from
  /// the start.
  struct Offset {
    bool is_set = false;
    double value = 0.0, variance = 0.0;  // [rad], [rad²]
    double common = 0.0;                 // [rad²] error of the chain's position that the offset has taken over
    double drift = 0.0;                  // [rad²] of the composed filters when it was last updated
    double wander = 0.0, age = 0.0;      // [rad²] mean square of the chain's heading about it; [s]
  };
  struct Joint {
    int parent_sensor = -1, child_sensor = -1;  // −1: a body without a sensor
    int first_body = 0, last_body = 0;
    double share = 0.0;
    bool is_new = true;  // no position has been stated since the start
    Offset offset{};
  };

  void fuse(const TrackingModel& model, const ComposedFilters& composed, double dt, std::size_t j, TrackState& chain);
  void fuse_ball(const TrackingModel& model, const ComposedFilters& composed, double dt, std::size_t j,
                 std::optional<double> heading_sd, TrackState& chain);
  void widen_heading(const TrackingModel& model, std::size_t j, const Vec3& up, double variance,
                     TrackState& chain) const;
  static void begin_or_improve(Offset& offset, double measured, double chain_variance, double drift);
  static double follow(Offset& offset, double measured, double chain_variance, double just_started, double drift,
                       double dt);
  static void approach(Joint& joint, double chain_variance, double composed_variance, double dt);

  std::vector<Joint> joints_;
  double time_ = 0.0;
  bool has_begun_ = false;
};

}  // namespace kinfer::track

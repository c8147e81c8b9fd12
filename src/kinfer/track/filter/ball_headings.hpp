// SPDX-License-Identifier: Apache-2.0
// The headings of spherical joints: their rotations about the vertical, which gravity does not show and only the
// acceleration of the joint's centre does, seen from both sides.
//
// Until the parent moves a heading is considered, not estimated (Schmidt 1966): at rest the products of two sensors'
// noise pass for information about it. From then on its corrections are watched. Their sum S over a second has an
// expected square D, the fall of the heading's variance. One linearisation over an angle S leaves S²/2 at most, and a
// sum beyond two standard deviations says that the accelerations' errors last: both are added to the variance.
#pragma once

#include <vector>

#include "kinfer/track/model/chain_state.hpp"

namespace kinfer::track {

class BallHeadings {
 public:
  explicit BallHeadings(const FilterModel& model);

  /// From here on the heading of a body's spherical joint is considered, until it has been shown.
  void consider(std::size_t body);
  bool is_considered(std::size_t body) const;
  /// Likewise, of a heading that counted from the start and is so uncertain [rad] now.
  void free(std::size_t body, double sd, MatrixXd& p);
  /// After a start.
  void reset();
  /// This update's motion shows it.
  void show(std::size_t body);

  /// Before and after an update, `error` being its correction and `gain` its Y: corrects both them and the covariance
  /// (of which the lower half is valid).
  void begin_update(const FilterModel& model, const ChainState& state, const MatrixXd& p);
  void limit_correction(VectorXd& error) const;
  void end_update(const Eigen::Ref<const MatrixXd>& gain, const VectorXd& error, double time, MatrixXd& p);

  /// [rad²] of the heading at the last update.
  double variance(std::size_t body, const MatrixXd& p) const;
  /// Up, in the rotating frame of a body's spherical joint, at the last update.
  const Vec3& up(std::size_t body) const { return find(body).up; }

 private:
  struct Ball {
    std::size_t body = 0;
    Index first = 0;          // its first rotation among the states; the others follow at `position_states`
    Vec3 up = Vec3::UnitZ();  // in its rotating frame
    bool is_considered = false;
    int shown = 0;        // updates that showed it
    double before = 0.0;  // [rad²] before the update
    bool is_watched = false;
    double sum = 0.0, expected = 0.0, since = -1.0;  // S [rad], D [rad²], [s]; negative: not yet
  };

  const Ball& find(std::size_t body) const;
  Ball& find(std::size_t body);
  static double variance(const Ball& ball, const MatrixXd& p);
  static void widen(const Ball& ball, double variance, MatrixXd& p);
  static void watch(Ball& ball, double correction, double time, MatrixXd& p);

  std::vector<Ball> balls_;
  std::vector<Mat3> world_R_body_;
};

}  // namespace kinfer::track

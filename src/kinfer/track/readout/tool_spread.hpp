// SPDX-License-Identifier: Apache-2.0
// How errors of the filter's states move the tool: its derivatives by joint positions and by the chain's geometry.
#pragma once

#include <span>

#include "kinfer/geometry/pose.hpp"
#include "kinfer/track/filter/chain_filter.hpp"

namespace kinfer::track {

/// base_T_body of every body, and the covariance of a tool on one of them; buffers of its own.
class ToolSpread {
 public:
  ToolSpread(const FilterModel& model, const TrackingTool& tool);

  /// Nothing is allocated by either. place: the pose; spread: its standard deviations too. `unknown` [rad]: of each
  /// body by how much the zero of its joint may be off beyond the covariance, about a revolute joint's axis or a
  /// spherical joint's vertical; empty: none.
  void place(const FilterModel& model, const ChainState& state);
  void spread(const FilterModel& model, const ChainState& state, const MatrixXd& covariance,
              std::span<const double> unknown = {});

  const Pose& tool() const { return tool_; }  ///< base_T_tool
  const Vec3& position_sd() const { return position_sd_; }
  const Vec3& rotation_sd() const { return rotation_sd_; }

 private:
  void set_pose(const FilterModel& model, const ChainState& state, std::size_t b);
  Eigen::Matrix<double, 6, 1> by_unknown_position(const FilterModel& model, const ChainState& state,
                                                  std::size_t b) const;
  void add_column(Index state, const Vec3& shift, const Vec3& turn);
  void add_body(const FilterModel& model, std::size_t b);

  TrackingTool carried_;
  std::vector<bool> leads_to_tool_;  // of each body
  std::vector<Pose> bodies_;
  std::vector<ParentSide> parent_sides_;  // of each body's joint
  Pose tool_;
  Vec3 position_sd_ = Vec3::Zero(), rotation_sd_ = Vec3::Zero();
  std::vector<Index> index_;  // of the states with a derivative
  Eigen::Matrix<double, 6, Eigen::Dynamic> derivative_;
};

}  // namespace kinfer::track

// What kind of joint two segments share, by the shortest description of their relative motion (Rissanen 1978): a
// freedom is worth its parameters where its channel carries more than the instruments' errors, counted on the number of
// independent samples instead of all of them.
#pragma once

#include <array>
#include <span>

#include "kinfer/evidence/identification.hpp"
#include "kinfer/identify/segment_order.hpp"

namespace kinfer {

struct JointTypeOptions {
  double rate_noise = 3e-3;          ///< [rad/s] relative rate that INS at rest against each other may show
  double least_share = 0.02;         ///< of the sensors' rates that scale and orientation errors come to, at least
  double largest_share = 0.1;        ///< likewise at most: soft mounts
  double certainty = 2.5;            ///< times the errors, below which nothing counts as motion
  double acceleration_noise = 0.03;  ///< [m/s²] residual of a rigid pair: biases that turn, tilts
};

struct JointTypeEvidence {
  FoundJointType type = FoundJointType::revolute;
  std::array<double, 3> rates{};          ///< [rad/s] rms of the relative rate, principal directions, largest first
  std::array<double, 3> accelerations{};  ///< [m/s²] likewise of the residual at the common point
  double rate_error = 0.0;                ///< [rad/s] what errors come to
  double off_plane_rate = 0.0;  ///< [rad/s] rms that two axes, one fixed in each segment, leave of the relative rate
  Vec3 axis_in_parent = Vec3::UnitZ();  ///< of turning or sliding; of a universal joint the one that is fixed there
  Vec3 axis_in_child = Vec3::UnitZ();   ///< likewise
};

/// Of every pair of the tree, in its order (one for each segment but the root). `motion` with headings that agree.
std::vector<JointTypeEvidence> joint_types(const RecordedMotion& motion, const SegmentTree& tree,
                                           const JointTypeOptions& options = {});

/// n (1 − r) / (1 + r), r the correlation of neighbours: how many independent samples a series is worth; at least 1.
double effective_samples(std::span<const double> series);

}  // namespace kinfer

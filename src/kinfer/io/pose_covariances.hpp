// Full covariances of measured points and orientations: six columns each, "p_cov_xx" to "p_cov_zz", and nine for how
// both go together, "pr_cov_xx" to "pr_cov_zz": the point's axis first, the turn's second.
#pragma once

#include "kinfer/io/pose_columns.hpp"

namespace kinfer {

/// Names of xx, xy, xz, yy, yz, zz of a covariance: "p" the tool point, "r" its orientation about the world's axes,
/// else a target.
std::array<std::string, 6> covariance_names(const std::string& of);

/// Names of xx, xy, xz, yx … zz of the covariance of the tool point with its orientation.
std::array<std::string, 9> cross_covariance_names();

/// Gives the measured points and orientations of `set` the covariances that the file has for them.
void read_covariances(PoseColumns& columns, PoseSet& set);

}  // namespace kinfer

// Full covariances of measured points and orientations: six columns each, "p_cov_xx" to "p_cov_zz".
#pragma once

#include "kinfer/io/pose_columns.hpp"

namespace kinfer {

/// Names of xx, xy, xz, yy, yz, zz of a covariance: "p" the tool point, "r" its orientation about the world's axes,
/// else a target.
std::array<std::string, 6> covariance_names(const std::string& of);

/// Gives the measured points and orientations of `set` the covariances that the file has for them.
void read_covariances(PoseColumns& columns, PoseSet& set);

}  // namespace kinfer

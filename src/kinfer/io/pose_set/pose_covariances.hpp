// SPDX-License-Identifier: Apache-2.0
// Full covariances of measured points and orientations: six columns each, "p_cov_xx" to "p_cov_zz", and nine of their
// cross-covariance, "pr_cov_xx" to "pr_cov_zz": the point's axis first, the rotation's second.
#pragma once

#include "kinfer/io/pose_set/pose_columns.hpp"
#include "kinfer/io/pose_set/pose_sheet.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// Names of xx, xy, xz, yy, yz, zz of a covariance: "p" the tool point, "r" its orientation about the world's axes,
/// else a target.
std::array<std::string, 6> covariance_names(const std::string& of);

/// Names of xx, xy, xz, yx … zz of the covariance of the tool point with its orientation.
std::array<std::string, 9> cross_covariance_names();

/// Reads the covariances in the file into the measured points and orientations of `set`.
void read_covariances(PoseColumns& columns, PoseSet& set);

enum class CovarianceQuantity { lengths, angles };
/// Writes the covariance of one measurement under covariance_names(of).
void write_covariance(PoseSheet& sheet, const std::string& of, int row, const Mat3& covariance,
                      CovarianceQuantity quantity);
void write_cross_covariance(PoseSheet& sheet, int row, const Mat3& covariance);

}  // namespace kinfer

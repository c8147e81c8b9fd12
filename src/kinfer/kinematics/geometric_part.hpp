// SPDX-License-Identifier: Apache-2.0
// The part of a chain that a model of rigid links and ideal joints can hold, and how large the rest is.
#pragma once

#include <string_view>
#include <vector>

#include "kinfer/kinematics/chain.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer {

/// Kinds of numbers beyond the frames of the joints.
enum class NonGeometricKind { gain, coupling, compliance, torque_compliance, backlash, harmonics, expansion, field };
std::string_view name(NonGeometricKind kind);

/// A kind of numbers in which a chain differs from a reference.
struct NonGeometricDifference {
  NonGeometricKind kind = NonGeometricKind::gain;
  int joints = 0;                ///< that differ; 0 of the expansion and of the field
  double rms = 0.0;              ///< [m] distance by which it moves the tool point over the given joint positions
  double max = 0.0;              ///< [m]
  bool depends_on_load = false;  ///< on measured torques or the temperature: rms and max are unknown, 0
};

struct GeometricPart {
  Chain chain;                                      ///< frames of `corrected`, all else of the reference
  std::vector<NonGeometricDifference> differences;  ///< empty: `chain` is `corrected`
  double rms = 0.0, max = 0.0;                      ///< [m] of all together
};

/// `reference`: a chain with the same joints. `q`: dof x n, joint positions [rad] or [m] at which the differences are
/// evaluated, with every joint approached in its positive direction.
GeometricPart geometric_part(const Chain& corrected, const Chain& reference, const MatrixXd& q);

}  // namespace kinfer

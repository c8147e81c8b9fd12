// SPDX-License-Identifier: Apache-2.0
// Rotations of sub-trees that agree best with the magnetometers, found on the whole circle: a local search could end
// half a turn away.
#pragma once

#include "kinfer/estimate/magnetometers/magnetic_model.hpp"

namespace kinfer {

/// Rotations, field and hard iron, soft iron zero; to about ten degrees. `information` [1/rad²]: of the rotations about
/// 0, from other instruments. `hard_iron`: standard deviation in the unit of the field.
MagneticUnknowns scan_headings(const MagneticModel& model, ConstMatrixRef information, double hard_iron);

}  // namespace kinfer

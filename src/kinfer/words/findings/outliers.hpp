// SPDX-License-Identifier: Apache-2.0
// Measurements, outliers and undetermined parameters of a calibration in words.
#pragma once

#include <string>
#include <vector>

#include "kinfer/evidence/calibration/estimate.hpp"

namespace kinfer::words {

/// "position", "ball in socket", "distance", "ball-bar length", "distance from the plane", "orientation"
std::string measured_quantity(MeasurementKind kind);

/// All kinds of measurements, for help texts: "positions, orientations, …".
std::string measured_kinds();

/// "the point lies 4.213 mm from where the model has it (84 sigma)"; several are joined by semicolons.
std::string outlier_reasons(const std::vector<OutlierReason>& reasons);

/// The reasons; "held out: " before those of a held-out row.
std::string sentence(const Outlier& outlier);

std::string sentence(const UndeterminedGroup& group);

/// The sentences of all groups, in alphabetical order.
std::vector<std::string> undetermined_sentences(const Identifiability& identifiability);

}  // namespace kinfer::words

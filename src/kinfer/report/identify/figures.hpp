// SPDX-License-Identifier: Apache-2.0
// Figures of the identification report, as HTML; empty where the evidence holds nothing to draw.
#pragma once

#include <string>

#include "kinfer/evidence/identification/identification_evidence.hpp"

namespace kinfer::report {

/// Segments, INS, axes, unobservable directions.
std::string identified_machine_drawing(const IdentificationEvidence& evidence);
std::string tree_drawing(const IdentificationEvidence& evidence);      ///< tree of the segments
std::string residual_drawing(const IdentificationEvidence& evidence);  ///< rms of the motion and of its residual
std::string trace_drawings(const IdentificationEvidence& evidence);    ///< predicted and measured signals

}  // namespace kinfer::report

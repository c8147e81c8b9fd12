// SPDX-License-Identifier: Apache-2.0
// Sections of the identification report below the first screen.
#pragma once

#include "kinfer/evidence/identification/identification_evidence.hpp"
#include "kinfer/report/parts/html.hpp"

namespace kinfer::report {

/// "ins1–ins2"
std::string joint_label(const JointEstimate& joint);

html::Section joints_section(const IdentificationEvidence& evidence);
html::Section order_section(const IdentificationEvidence& evidence);
html::Section dh_section(const IdentificationEvidence& evidence);
html::Section fit_section(const IdentificationEvidence& evidence);
html::Section unobservable_section(const IdentificationEvidence& evidence);
html::Section recording_section(const IdentificationEvidence& evidence);  ///< findings about the recording
html::Section update_section(const IdentificationEvidence& evidence);  ///< what changed since the chain that is updated
html::Section search_section(const IdentificationEvidence& evidence);

}  // namespace kinfer::report

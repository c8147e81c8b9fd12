// SPDX-License-Identifier: Apache-2.0
// What speaks against using a joint.
#pragma once

#include <string>

#include "kinfer/evidence/identification/identification.hpp"

namespace kinfer::words {

/// "use", "use with care", "do not use", "unknown"
std::string joint_usability_text(JointUsability usability);

std::string doubt_sentence(const JointDoubt& doubt);

/// "the type of ins2-ins3 is uncertain: ...", or how likely all types are right where no joint alone is doubtful; empty
/// where all types are certain.
std::string uncertain_types_sentence(const Identification& result);

/// "ins1-ins2, ins2-ins3 may be used; ins3-ins4: ...": which joints stay usable where others do not; empty where all
/// joints have the same verdict.
std::string usable_part_sentence(const Identification& result);

/// The first reason against each joint that must not be used, one sentence each.
std::vector<std::string> refused_joint_sentences(const Identification& result);

}  // namespace kinfer::words

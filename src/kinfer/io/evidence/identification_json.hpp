// SPDX-License-Identifier: Apache-2.0
// evidence.json of an identification (docs/formats.md).
#pragma once

#include <string>

#include "kinfer/evidence/identification.hpp"
#include "kinfer/evidence/provenance.hpp"

namespace kinfer {

std::string format_identification_evidence(const Identification& found, const Provenance& provenance);

/// One line for `--json`: the verdict and the headline figures.
std::string format_identification_headline(const Identification& found);

}  // namespace kinfer

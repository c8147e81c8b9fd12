// evidence.json of an identification (docs/formats.md).
#pragma once

#include <string>

#include "kinfer/evidence/identification.hpp"
#include "kinfer/evidence/provenance.hpp"

namespace kinfer {

std::string identification_json(const Identification& found, const Provenance& provenance);

/// One line for `--json`: the verdict and the headline figures.
std::string identification_headline_json(const Identification& found);

}  // namespace kinfer

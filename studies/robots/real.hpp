// SPDX-License-Identifier: Apache-2.0
// Robots of public measured sets (docs/development/methods/calibrate.md names the sources). Errors on held-out rows.
#pragma once

#include <string>

namespace kinfer::study::robots_study {

/// `folder`: value of KINFER_DATA; `only`: ur10, mukca, positioner or fr3; empty: all.
void real_robots(const std::string& folder, const std::string& only);

}  // namespace kinfer::study::robots_study

// SPDX-License-Identifier: Apache-2.0
// Robots measured by others (docs/development/methods/calibrate.md names the public sources). Errors on rows that were
// not fitted.
#pragma once

#include <string>

namespace kinfer::study {

/// `folder`: what KINFER_DATA says; `only`: ur10, mukca, positioner or fr3; empty: all.
void real_robots(const std::string& folder, const std::string& only);

}  // namespace kinfer::study

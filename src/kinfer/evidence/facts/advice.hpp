// SPDX-License-Identifier: Apache-2.0
// Recommendations: what to measure or do next, and the expected benefit.
#pragma once

#include <string>

namespace kinfer {

struct Advice {
  std::string what;  ///< "Add poses near x 0.9, y -0.2, z 1.1 m"
  std::string why;   ///< "the model is least certain there: 0.12 mm"
};

}  // namespace kinfer

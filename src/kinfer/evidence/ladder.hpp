// The ladder of models that were tried, simple to rich, and why one of them was chosen.
#pragma once

#include <string>

#include "kinfer/evidence/fit.hpp"

namespace kinfer {

struct ModelRung {
  std::string name;       ///< "geometry", "geometry + gravity"
  TrainHoldout position;  ///< [m]
  bool chosen = false;
  std::string reason;  ///< why it was chosen or refused, in words
};

}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
// Model selection: which non-geometric terms reduced the held-out errors.
#pragma once

#include <string>
#include <vector>

#include "kinfer/evidence/fit_errors.hpp"

namespace kinfer {

/// One candidate model term, tested (or skipped) on top of the terms accepted before it.
struct SelectionStep {
  std::string name{};                  ///< "geometry", "gravity", "gear", …
  std::string description{};           ///< description: "compliance of each joint under gravity"
  ErrorStatistics train{}, holdout{};  ///< [m] by cross-validation over the fitted rows; n = 0 where it was skipped
  int parameter_count = 0,
      determined_count = 0;  ///< number of parameters it adds, and how many of them the data determine
  bool selected = false;
  bool skipped = false;                                ///< not tested: the data do not excite its parameters
  std::vector<std::string> undetermined_parameters{};  ///< its parameters that the data do not determine
  std::string reason{};                                ///< why it was accepted, rejected or skipped, in one sentence
};

struct ModelSelection {
  std::vector<SelectionStep> model_terms{};
  std::string selected{};  ///< the selected model: "geometry + gravity"
};

}  // namespace kinfer

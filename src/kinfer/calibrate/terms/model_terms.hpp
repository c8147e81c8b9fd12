// SPDX-License-Identifier: Apache-2.0
// Non-geometric model terms: the candidates for model selection, each with the parameters that it frees.
#pragma once

#include <string>
#include <vector>

#include "kinfer/calibrate/calibrate.hpp"

namespace kinfer::calibrate {

/// A group of parameters that are accepted or rejected together.
struct ModelTerm {
  std::string name{};         ///< "gravity"
  std::string description{};  ///< description
  Chain nominal{};            ///< the chain with the added structure (harmonics, couplings, masses), values zero
  std::vector<Parameter> parameters{};  ///< the parameters that it frees, with priors about zero or the file's value
  std::string skipped{};                ///< why it cannot be tested with these data; empty: it can
};

/// Names of all non-geometric terms, in the order in which they are tested.
std::vector<std::string> model_term_names();

/// The term of that name on top of `nominal`, for these rows. `fitted` is the best fit so far; the gear spectrum is
/// computed from its residuals.
ModelTerm make_model_term(const Chain& nominal, const std::string& name, const CalibrationTask& task,
                          const PoseSet& rows, const Estimate& fitted);

}  // namespace kinfer::calibrate

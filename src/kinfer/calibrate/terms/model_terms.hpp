// SPDX-License-Identifier: Apache-2.0
// Non-geometric model terms: the candidates for model selection, each with the parameters that it frees.
#pragma once

#include <span>
#include <vector>

#include "kinfer/calibrate/terms/gear_harmonics.hpp"
#include "kinfer/evidence/calibration/estimate.hpp"
#include "kinfer/evidence/calibration/model_selection.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::calibrate {

/// A candidate: the chain with the structure that the term adds, and the parameters that it frees.
struct ModelTerm {
  Chain nominal{};                          ///< with the added structure (harmonics, couplings, masses), values zero
  std::vector<Parameter> parameters{};      ///< with priors about zero or the file's value
  MissingData missing = MissingData::none;  ///< why it cannot be tested with these data
  bool masses_approximate = false;
};

/// What a term is made from.
struct TermInputs {
  const Tolerances& tolerances;
  const PoseSet& rows;
  std::vector<SpectralLine> lines{};  ///< of residuals, for the term of these
};

/// One row per term of numbers (a displacement field is none: calibrate/functions); a new term is a new row here, its
/// name in evidence, its words in words.
struct TermMaker {
  Term term;
  ModelTerm (*make)(const Chain& nominal, const TermInputs& inputs);
};

/// In the order in which the terms are tested.
std::span<const TermMaker> term_makers();

/// The term on top of `nominal`.
ModelTerm make_model_term(Term term, const Chain& nominal, const TermInputs& inputs);

}  // namespace kinfer::calibrate

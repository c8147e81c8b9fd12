// SPDX-License-Identifier: Apache-2.0
// Everything that the weighing of the terms about one geometry found out: candidates, what the data say of them, the
// model that consists of the supported ones, and its proof.
#pragma once

#include <optional>
#include <vector>

#include "kinfer/calibrate/terms/candidate_terms.hpp"
#include "kinfer/calibrate/terms/holdout_errors.hpp"
#include "kinfer/calibrate/terms/relevance.hpp"
#include "kinfer/evidence/calibration/estimate.hpp"
#include "kinfer/evidence/calibration/model_selection.hpp"

namespace kinfer::calibrate {

/// A model fitted to all rows, and its held-out errors: by interpolation (random folds), and by extrapolation (splits
/// along the principal directions of the joint positions).
struct ProvedModel {
  TermModel model;
  Estimate fit;
  HoldoutErrors interpolation, extrapolation;
};

/// Comparisons of a model without and with a term.
struct TermProof {
  Term term{};
  ErrorChange interpolation{}, extrapolation{};
  Decision decision = Decision::accepted;
};

struct WeighedTerms {
  CandidateTerms candidates;
  std::vector<RelevanceGroup> groups;
  std::vector<TermsAtNoise> linearised;
  std::vector<GroupRelevance> relevance;  ///< of each group; factor 0 where held-out errors speak against its term
  Estimate with_all;                      ///< the fit of all candidates: where the fit of what is left begins
  ProvedModel relevant;
  std::vector<TermProof> accepted, refused;

  bool has(Term term) const;
  bool is_refused(Term term) const;
  std::vector<double> factors() const;
};

}  // namespace kinfer::calibrate

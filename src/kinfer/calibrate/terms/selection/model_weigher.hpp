// SPDX-License-Identifier: Apache-2.0
// One fit with all terms that the data could tell about a geometry, the size of each group of parameters by the
// marginal likelihood, and the proof of the result by held-out errors.
#pragma once

#include <optional>
#include <vector>

#include "kinfer/calibrate/terms/selection/weighed_geometry.hpp"
#include "kinfer/calibrate/terms/selection/weighed_terms.hpp"
#include "kinfer/calibrate/terms/term_reach.hpp"
#include "kinfer/estimate/poses/bundle.hpp"

namespace kinfer::calibrate {

/// Splits along the principal directions of the joint positions, of a part of many rows.
std::vector<Split> splits_beyond(const PoseSet& rows);

class ModelWeigher {
 public:
  /// Keeps references to both.
  ModelWeigher(const SelectionData& data, const Estimate& geometry);

  /// The fit of the relevant terms but spectral lines.
  const Estimate& fit_without_lines();

  WeighedModel run();

  /// Held-out errors of a model beyond the fitted poses.
  HoldoutErrors extrapolation_of(const Estimate& fit) const;

 private:
  /// Weighs the groups of all candidates about the fit of all, or of geometry, and fits what is left. Returns the
  /// latter.
  Estimate weigh_all();

  /// Also of the residuals of gears alone: other terms may have taken what further harmonics would explain better.
  std::vector<SpectralLine> lines_of(const Estimate& fitted) const;
  Estimate fit_gears_alone(const PoseSet& rows) const;
  void fit_relevant();
  BundleOptions at_optimum() const;
  HoldoutErrors held_out(const Estimate& fit, const ParameterSet& set, const std::vector<Split>& splits) const;

  /// Held-out errors of the model without the refused terms and without `term`, from the fits with all of them.
  ProvedModel reduced(std::optional<Term> term) const;

  /// Refuses the terms that held-out errors speak against, the most harmful first, and fits what is left.
  void prove(const ProvedModel& plain);

  /// The term without which held-out errors are lowest, where they speak against it or against the whole model. Keeps
  /// the comparisons of all terms.
  std::optional<TermProof> most_harmful(const ProvedModel& plain);

  /// Geometry with the terms that hold everywhere, without the others; without those that make held-out ends of the
  /// joint space worse. None where the whole model holds everywhere.
  std::optional<Estimate> fit_for_everywhere(const ProvedModel& plain) const;

  /// The model with all terms of that reach, where held-out ends of the joint space do not speak against these.
  ProvedModel extended(const ProvedModel& model, TermReach reach) const;

  /// With the series of the present model as they are: they end at the measured positions by themselves.
  Estimate fit_beside_series(const Chain& start, const ParameterSet& set) const;

  const SelectionData& data_;
  const Estimate& geometry_;
  std::vector<Split> extrapolation_splits_;
  WeighedTerms terms_;
  std::optional<Estimate> fit_without_lines_;
};

}  // namespace kinfer::calibrate

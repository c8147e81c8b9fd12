// The model ladder: geometry first, then what cross-validation shows to help on rows that were not fitted.
//
// A rung is taken when the held-out errors fall by more than chance explains, the worst of them does not rise, and the
// model is no worse on the other half of the poses when it is fitted on one half alone, cut along the joints' main
// directions: terms that only interpolate would send a pose astray where the joints were not excited. Training errors
// always fall and decide nothing.
#pragma once

#include "kinfer/calibrate/figures.hpp"

namespace kinfer {

struct Climbed {
  Estimate fit;                  ///< of all rows, by the chosen model
  std::vector<Estimate> unseen;  ///< one a split: the chosen model fitted on the split's train rows
  Ladder ladder;
  std::vector<Outlier> wrong;  ///< rows that no model is judged by, the same for every rung
};

/// Climbs from `geometry`, the fit of all `rows`; `splits` are of these rows. AutoModel tries every rung, NamedModel
/// takes just the named ones, whatever the held-out errors say.
Climbed climb(const CalibrateTask& task, const PoseSet& rows, const Estimate& geometry,
              const std::vector<Split>& splits, const CalibrateOptions& options, const Observer& observer);

}  // namespace kinfer

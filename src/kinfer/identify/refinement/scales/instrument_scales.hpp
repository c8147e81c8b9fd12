// SPDX-License-Identifier: Apache-2.0
// Instruments that read too much or too little: scale errors beyond what their grade says, found and fitted.
#pragma once

#include "kinfer/identify/refinement/fits/refinement_fits.hpp"

namespace kinfer::identify {

/// An instrument whose scale matrix is larger than its prior says.
struct DeviantScale {
  std::size_t sensor = 0;
  InsInstrument instrument = InsInstrument::gyroscope;
  double sd = 0.0;        ///< most likely, of its elements
  double log_odds = 0.0;  ///< against its prior
};

/// A sensor whose gyroscope and accelerometer have axes that are turned against each other. Which of them is along the
/// housing no measurement tells.
struct TurnedAxes {
  std::size_t sensor = 0;
  double sd = 0.0;        ///< most likely, of the elements of both matrices
  double log_odds = 0.0;  ///< against the priors
};

struct ScaleReview {
  std::vector<DeviantScale> deviant;
  std::vector<TurnedAxes> turned;
  double common_sd = 0.0;        ///< most likely, of a factor that all gyroscopes share; 0: none
  double common_log_odds = 0.0;  ///< against none

  bool empty() const { return deviant.empty() && turned.empty() && common_sd <= 0.0; }
  bool is_alike(const ScaleReview& other) const;  ///< of the same instruments
};

/// Frees the scales that the recording contradicts the priors of, and fits again. Where a rigid chain does not explain
/// the motion even then, what the scales absorbed may be mounts that deflect: then all stays as it was.
ScaleReview refit_deviant_scales(const RefinementTask& task, RefinementFit& fitted, const Observer& observer);

}  // namespace kinfer::identify

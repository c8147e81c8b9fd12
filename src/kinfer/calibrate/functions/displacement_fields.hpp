// SPDX-License-Identifier: Apache-2.0
// Displacement fields: what moves the tool as a smooth function of all joint positions, as a Gaussian process.
//
// Its size and the distances over which it changes are those that maximise the marginal likelihood. Bayes factors are
// integrated over the size, so what the data do not support is no field.
#pragma once

#include <optional>

#include "kinfer/calibrate/functions/beside_functions.hpp"

namespace kinfer::calibrate {

/// Whether a field can be fitted: enough rows that show the tool's position, of one tool, and no differences of rows.
bool allows_field(const PoseSet& rows);

struct FoundField {
  Chain chain;                     ///< that of the estimate, with the field
  double log_evidence_gain = 0.0;  ///< log marginal likelihood with a field minus without, minus the prior odds
  int values = 0, determined = 0;  ///< numbers of the field, and how many of them the data determine
};

/// The best field for the residuals of `fitted`, whatever the data say of it. The rows must allow one.
FoundField find_field(const Estimate& fitted, const PoseSet& rows, const std::optional<Instrument>& instrument,
                      int threads = 1);

/// Fits the field that `start` has, with its size, together with the free parameters of `set` and series that it has;
/// the covariance is that of the parameters with the field as found, the standard deviations of the values are those
/// whatever it is. `start` as for fit_bundle.
Estimate fit_with_field(const Chain& start, const ParameterSet& set, const PoseSet& rows,
                        const std::optional<Instrument>& instrument, const BundleOptions& options,
                        const Observer& observer = {});

}  // namespace kinfer::calibrate

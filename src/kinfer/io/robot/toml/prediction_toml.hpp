// SPDX-License-Identifier: Apache-2.0
// The [prediction] table of chain.toml: what the uncertainty of predicted poses is computed from. SI throughout.
#pragma once

#include <optional>
#include <string>

#include "kinfer/evidence/calibration/prediction_model.hpp"
#include "kinfer/io/text/toml_reader.hpp"

namespace kinfer {

std::string format_prediction_toml(const PredictionModel& model);

/// Nothing where the file has no such table; `dof`: of the chain.
std::optional<PredictionModel> read_prediction(TableReader& file, int dof, FirstError& first_error);

}  // namespace kinfer

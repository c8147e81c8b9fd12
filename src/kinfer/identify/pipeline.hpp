// SPDX-License-Identifier: Apache-2.0
// Identification of an unknown machine from an INS recording: segment tree -> joint types -> chain, link by link, by
// paper 1's bacterial programming or its memetic successor -> refinement by the continuous-time fit.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/identify/options.hpp"

namespace kinfer::identify {

/// An error if no chain can be identified: fewer than two sensors, or a sensor or joint that never moves; or if the
/// options are inconsistent.
Result<Identification> identify_machine(const InsRecording& recording, const IdentifyOptions& options, const Rng& rng,
                                        const Observer& observer = {});

}  // namespace kinfer::identify

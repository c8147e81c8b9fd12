// SPDX-License-Identifier: Apache-2.0
// evidence.json of `track` (docs/formats.md, kinfer-evidence/1), written and read. SI throughout.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/tracking/track_run.hpp"

namespace kinfer {

/// The run with the sentences and provenance that its evidence.json holds.
TrackRun track_evidence(const TrackRun& run, const Provenance& provenance);

std::string format_track_run(const TrackRun& run);

/// Error: the path of the first value that is missing or of another type, and what was expected.
Result<TrackRun> read_track_run(std::string_view text);

/// JSON Schema of what is written.
nlohmann::ordered_json track_schema();

}  // namespace kinfer

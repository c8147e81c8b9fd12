// SPDX-License-Identifier: Apache-2.0
// The report on a run of the tracker.
#pragma once

#include "kinfer/evidence/tracking/track_run.hpp"
#include "kinfer/report/parts/page.hpp"

namespace kinfer::report {

Page track_page(const TrackRun& run);

}  // namespace kinfer::report

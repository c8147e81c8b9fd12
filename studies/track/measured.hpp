// SPDX-License-Identifier: Apache-2.0
// Real chains with a reference of their own: five segments moved by hand before cameras, an arm of seven axes and the
// forearm of another one with encoders. Identified by default options and tracked; skipped where the data are absent.
#pragma once

#include <string>

namespace kinfer::study::track_study {

/// Prints a row for each log: rms angle between tracked and measured relative orientations of neighbouring segments,
/// one constant rotation on each side fitted; in brackets that of the composed filters and of pairwise ones. `folder`:
/// of the data (KINFER_DATA); `only`: sets to run, empty: all.
void track_measured(const std::string& folder, const std::string& only);

}  // namespace kinfer::study::track_study

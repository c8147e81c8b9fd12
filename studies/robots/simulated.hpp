// SPDX-License-Identifier: Apache-2.0
// Simulated robots: tracker noise 10 µm + 5 µm/m and 50 poses unless said otherwise; errors on 300 held-out poses.
#pragma once

namespace kinfer::study::robots_study {

void simulated_robots();

}  // namespace kinfer::study::robots_study

// SPDX-License-Identifier: Apache-2.0
// Coverage of `kinfer identify` over machines and seeds, as two sweeps: what a user would run, on all cores.
#pragma once

namespace kinfer::study {

/// identify sweep [SEEDS [FOLDER [GRADE]]]
int run_identify_sweep(int argc, char** argv);

}  // namespace kinfer::study

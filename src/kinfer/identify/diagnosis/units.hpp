// SPDX-License-Identifier: Apache-2.0
// Units that a log does not state: of its clock, of specific force and of the magnetic field, by the size that they
// must have.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/identify/diagnosis/mended_log.hpp"

namespace kinfer::identify {

/// Times in ms, µs or ns become seconds; a clock that counts rows gets the rate at which the gyroscopes fit the
/// accelerometers best, and is said to be a guess.
void mend_clocks(MendedLog& log, int threads);

/// An error if a sensor's specific force holds no gravity: free acceleration cannot be mended.
Result<void> mend_forces(MendedLog& log);

void mend_fields(MendedLog& log);

}  // namespace kinfer::identify

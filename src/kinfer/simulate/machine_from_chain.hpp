// SPDX-License-Identifier: Apache-2.0
// Converts an identified chain into a simulated machine, to try out an excitation before recording it.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/simulate/machine.hpp"

namespace kinfer {

/// `chain` as `identify` writes it: a moving joint "A-B", or the last of its positions "A-B 1", "A-B 2", … (universal
/// and spherical joints), is followed by the fixed frame of sensor "B". The sensor that no joint leads to is the root.
/// An error for any other chain.
Result<Machine> make_machine(const Chain& chain);

}  // namespace kinfer

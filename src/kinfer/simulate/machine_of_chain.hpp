// An identified chain as a machine that can be driven in simulation: to rehearse a drive before it is made.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/simulate/machine.hpp"

namespace kinfer {

/// `chain` as `identify` writes it: a moving joint "A-B" is followed by the fixed frame of sensor "B". The sensor that
/// no joint leads to is the root. An error where the chain is not of that kind.
Result<Machine> machine_of_chain(const Chain& chain);

}  // namespace kinfer

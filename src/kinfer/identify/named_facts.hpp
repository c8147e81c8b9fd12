// Facts about a machine, which speak of sensors and joints by name, in the terms of the continuous-time fit.
#pragma once

#include <string>

#include "kinfer/base/result.hpp"
#include "kinfer/estimate/ins_problem.hpp"
#include "kinfer/measurement/machine_facts.hpp"

namespace kinfer {

/// `sensors`: names by index. An error says which fact speaks of what does not exist, lies outside the recording, or
/// needs a base that stands still.
Result<InsFacts> named_facts(const MachineFacts& facts, const std::vector<std::string>& sensors,
                             const InsBodies& bodies, const SplineGrid& grid, bool root_stands_still);

}  // namespace kinfer

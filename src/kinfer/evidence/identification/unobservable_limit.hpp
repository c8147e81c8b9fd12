// SPDX-License-Identifier: Apache-2.0
// From which uncertainty a number of an identification counts as unobservable: one limit for the forecast, the report
// and the terminal.
#pragma once

namespace kinfer {

/// [m], [rad] Standard deviation from which a direction counts as unobservable: about that of its prior. Smaller
/// excludes more directions from the forecast. Data not recorded.
inline constexpr double unobservable_sd = 0.5;

}  // namespace kinfer

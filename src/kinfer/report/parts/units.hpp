// SPDX-License-Identifier: Apache-2.0
// Factors from SI to the units of the report.
#pragma once

namespace kinfer::report {

inline constexpr double mm = 1e3;    ///< per metre
inline constexpr double mrad = 1e3;  ///< per radian

}  // namespace kinfer::report

// SPDX-License-Identifier: Apache-2.0
// chain_dh.csv: the identified chain as canonical DH rows with one sigma each (docs/formats.md), in m and rad.
#pragma once

#include <string>

#include "kinfer/evidence/identification/identification.hpp"

namespace kinfer {

/// RotZ(theta) TransZ(d) TransX(a) RotX(alpha) RotY(beta) row after row; `variable` names the joint whose angle is
/// added to theta.
std::string format_chain_dh_csv(const std::vector<DhRowEstimate>& rows);

}  // namespace kinfer

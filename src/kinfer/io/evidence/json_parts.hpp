// SPDX-License-Identifier: Apache-2.0
// JSON of the parts that several evidence files share.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "kinfer/evidence/fact.hpp"
#include "kinfer/evidence/provenance.hpp"
#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

/// [x, y, z]
nlohmann::ordered_json json_of(const Vec3& v);

/// null where not finite
nlohmann::ordered_json finite_json(double value);

/// The values of a fact by their names.
nlohmann::ordered_json values_json(const FactValues& values);

/// Version, seed, options and inputs.
nlohmann::ordered_json provenance_json(const Provenance& provenance);

}  // namespace kinfer

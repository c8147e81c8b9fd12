// What several JSON files of ours say alike.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "kinfer/evidence/provenance.hpp"
#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

/// [x, y, z]
nlohmann::ordered_json json_of(const Vec3& v);

/// null where not finite
nlohmann::ordered_json finite_json(double value);

/// Version, seed, options and inputs.
nlohmann::ordered_json provenance_json(const Provenance& provenance);

}  // namespace kinfer

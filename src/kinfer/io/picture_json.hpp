// What a report draws, as JSON: chains that any program can move in twenty lines, pictures, films, advice.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "kinfer/evidence/advice.hpp"
#include "kinfer/evidence/picture.hpp"
#include "kinfer/evidence/traces.hpp"

namespace kinfer {

/// Every convention in one form: parent_T_joint = before · (turn about or shift along `axis` by the joint's variable) ·
/// after, variable = gain · q[reading] + sum of factor · q[k]. Lengths in m, quaternions w x y z. What compliance adds
/// is left out.
nlohmann::ordered_json chain_json(const Chain& chain);

/// Lengths to a tenth of a micrometre, angles to a tenth of a microradian: enough for a drawing, and short.
nlohmann::ordered_json picture_json(const CalibrationPicture& picture, const Chain& calibrated);
nlohmann::ordered_json motion_json(const MotionEvidence& motion);

nlohmann::ordered_json advice_json(const std::vector<Advice>& list);

}  // namespace kinfer

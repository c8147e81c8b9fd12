// SPDX-License-Identifier: Apache-2.0
// The data that a report draws, as JSON: chains that a viewer can animate in twenty lines, plots, joint trajectories,
// advice.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "kinfer/evidence/advice.hpp"
#include "kinfer/evidence/calibration_plot.hpp"
#include "kinfer/evidence/traces.hpp"

namespace kinfer {

/// Every convention in one form: parent_T_joint = before · (rotation about or translation along `axis` by the joint's
/// variable) · after, variable = gain · q[reading] + sum of factor · q[k]. Lengths in m, quaternions w x y z. Without
/// compliance.
nlohmann::ordered_json chain_json(const Chain& chain);

/// Lengths to 0.1 µm, angles to 0.1 µrad: enough for a drawing, and compact.
nlohmann::ordered_json picture_json(const CalibrationPlotData& plot_data, const Chain& calibrated);
nlohmann::ordered_json motion_json(const MotionEvidence& motion);

nlohmann::ordered_json advice_json(const std::vector<Advice>& list);

}  // namespace kinfer

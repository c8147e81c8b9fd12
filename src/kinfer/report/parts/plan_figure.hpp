// SPDX-License-Identifier: Apache-2.0
// Stand-alone figure of a pose plan: expected error of the tool against the number of poses.
#pragma once

#include <string>

#include "kinfer/evidence/deployment/pose_plan.hpp"

namespace kinfer::report {

/// An SVG file: rms and worst expected error over the workspace, planned and random poses.
std::string plan_figure(const PosePlan& plan);

}  // namespace kinfer::report

// What a pose plan is worth as a figure that stands alone: expected error of the tool by the number of poses.
#pragma once

#include <string>

#include "kinfer/evidence/plan.hpp"

namespace kinfer {

/// An SVG file: rms and worst expected error over the workspace, planned and random poses.
std::string plan_figure(const PosePlan& plan);

}  // namespace kinfer

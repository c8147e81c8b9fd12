// SPDX-License-Identifier: Apache-2.0
// Rounding of numbers that are only drawn, which keeps evidence.json compact.
#pragma once

#include <vector>

#include "kinfer/evidence/calibration/calibration_plot.hpp"
#include "kinfer/evidence/identification/traces.hpp"

namespace kinfer {

/// To seven decimals: lengths to 0.1 µm, angles to 0.1 µrad.
double rounded(double value);
Vec3 rounded(const Vec3& value);
MatrixXd rounded(const MatrixXd& values);

/// To a power of ten below 1/4000 of the largest value: a plot on a screen resolves no more.
std::vector<double> rounded_for_plot(std::vector<double> values);

MotionEvidence rounded(MotionEvidence motion);

/// Rows and workspace of the drawing.
std::vector<PlotRow> rounded(std::vector<PlotRow> rows);
std::vector<WorkspacePoint> rounded(std::vector<WorkspacePoint> points);

}  // namespace kinfer

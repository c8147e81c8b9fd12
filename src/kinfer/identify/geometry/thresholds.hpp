// SPDX-License-Identifier: Apache-2.0
// Thresholds of the joint geometry.
#pragma once

#include <cstddef>

namespace kinfer::identify {

/// [rad] Angle by which pins that are meant to be parallel deviate on machines as they are built, each of two
/// directions; larger calls more axes parallel. A judgement: welded booms deviate by a few mrad, and no machine's axes
/// are meant to include less than a few degrees.
inline constexpr double built_misalignment = 10e-3;

/// Probabilities of a real angle between two axes below which their shortest distance is that of parallel lines, and
/// above which it is that of skew lines; between them the standard deviation holds the difference of both. Larger makes
/// more lines parallel. The usual 5 % on either side; not set on data.
inline constexpr double parallel_probability = 0.05, skew_probability = 0.95;

/// Sine of the angle between two lines below which Hayati's angle beta replaces d. Data not recorded.
inline constexpr double max_hayati_sine = 0.1;

/// [rad] Angle between an axis known from an earlier identification and the one that its two sensors show alone, from
/// which a fit begins at the latter: a sensor was remounted. Larger begins more fits at what is known. A judgement:
/// pairs of sensors show an axis to a few degrees, and a fit converges from three times as far.
inline constexpr double max_known_axis_error = 0.2;

/// [m] A lever direction of the searched geometry with a larger standard deviation is unobservable. Data not recorded.
inline constexpr double max_lever_sd = 0.5;

}  // namespace kinfer::identify

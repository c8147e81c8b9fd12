// SPDX-License-Identifier: Apache-2.0
// The position error before compensation, and what tables 4 and 5 leave against table 3: both hang on where the poses
// are, which the paper does not say for its simulation. So they are shown for three ways to draw them.
#pragma once

#include "output.hpp"

namespace kinfer::paper2 {

/// For each way to draw poses and for d6 as printed and with the target: mean and rms [mm] over 20 000 poses, how much
/// both scatter between sets of 50 poses, and what the two tables leave [µm].
TextTable error_before_table();

}  // namespace kinfer::paper2

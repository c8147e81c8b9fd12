// SPDX-License-Identifier: Apache-2.0
// Results with every member set. Names hold what HTML and JSON must escape.
#pragma once

#include "support/rich_calibration.hpp"
#include "support/rich_identification.hpp"

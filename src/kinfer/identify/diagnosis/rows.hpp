// SPDX-License-Identifier: Apache-2.0
// Rows that repeat the one before or lie on the line between others: they were never measured.
#pragma once

#include "kinfer/identify/diagnosis/mended_log.hpp"

namespace kinfer::identify {

/// Such rows become missing samples.
void mend_rows(MendedLog& log, int threads);

}  // namespace kinfer::identify

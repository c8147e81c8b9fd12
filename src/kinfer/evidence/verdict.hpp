// SPDX-License-Identifier: Apache-2.0
// How far a result may be used.
#pragma once

#include <string_view>

namespace kinfer {

enum class Usability { use, use_with_care, do_not_use };

/// "use", "use_with_care", "do_not_use"
std::string_view name(Usability usability);

}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
// How far a result may be used.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kinfer {

enum class Usability { use, use_with_care, do_not_use };

/// "use", "use_with_care", "do_not_use"
std::string_view name(Usability usability);

/// The sentence of a verdict in its parts: "Use it: 2 joints found; no chain of up to 3 leaves fits better".
struct VerdictText {
  std::string recommendation{};        ///< "Use it"
  std::string statement{};             ///< "2 joints found"
  std::vector<std::string> remarks{};  ///< "no chain of up to 3 leaves fits better"
};
/// The parts joined, without a final stop.
std::string sentence(const VerdictText& verdict);

}  // namespace kinfer

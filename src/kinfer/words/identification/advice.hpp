// SPDX-License-Identifier: Apache-2.0
// Recommendations after an identification, in words.
#pragma once

#include <vector>

#include "kinfer/evidence/facts/advice.hpp"
#include "kinfer/evidence/identification/identification_facts.hpp"

namespace kinfer::words {

Advice advice_text(const IdentificationAdvice& advice);
std::vector<Advice> advice_texts(const std::vector<IdentificationAdvice>& list);

}  // namespace kinfer::words

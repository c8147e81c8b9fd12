// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/selection/weighed_terms.hpp"

#include <algorithm>

namespace kinfer::calibrate {

bool WeighedTerms::has(Term term) const {
  return std::ranges::any_of(relevant.model.terms, [&](const CandidateParameter& c) { return c.term == term; });
}

bool WeighedTerms::is_refused(Term term) const {
  return std::ranges::any_of(refused, [&](const TermProof& proof) { return proof.term == term; });
}

std::vector<double> WeighedTerms::factors() const {
  std::vector<double> list;
  for (const GroupRelevance& group : relevance) list.push_back(group.factor);
  return list;
}

}  // namespace kinfer::calibrate

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/status.hpp"

#include <gtest/gtest.h>

#include <set>

namespace kinfer {
namespace {

/// The number of different sentences of the enumerators up to `last`.
template <class Enum>
std::size_t different_sentences(Enum last) {
  std::set<std::string> sentences;
  for (int i = 0; i <= static_cast<int>(last); ++i) sentences.insert(words::sentence(static_cast<Enum>(i)));
  return sentences.size() - sentences.count("");
}

TEST(StatusWords, EveryStopAndEveryInverseStatusHasASentenceOfItsOwn) {
  EXPECT_EQ(different_sentences(Stop::cancelled), 8u);
  EXPECT_EQ(different_sentences(InverseStatus::iteration_limit), 5u);
  EXPECT_EQ(words::sentence(Stop::converged_cost), "converged: the cost no longer falls");
}

}  // namespace
}  // namespace kinfer

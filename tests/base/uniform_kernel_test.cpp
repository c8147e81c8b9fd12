// SPDX-License-Identifier: Apache-2.0
#include "kinfer/base/uniform_kernel.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "kinfer/base/instruction_set.hpp"
#include "kinfer/base/rng.hpp"

namespace kinfer {
namespace {

std::vector<base::UniformKernel> runnable() {
  std::vector<base::UniformKernel> list{base::fill_uniform};
#if defined(__x86_64__)
  if (instruction_set() >= InstructionSet::avx2) list.push_back(base::uniform_avx2);
  if (instruction_set() >= InstructionSet::avx512) list.push_back(base::uniform_avx512);
#endif
  return list;
}

TEST(UniformKernel, EveryInstructionSetGivesTheUpper53BitsOfEachDraw) {
  constexpr std::size_t count = 1003;  // not a multiple of any number of lanes
  const std::uint64_t first = 0x0123456789abcdefULL;
  for (const base::UniformKernel fill : runnable()) {
    std::vector<double> found(count);
    fill(first, count, found.data());
    for (std::size_t k = 0; k < count; ++k)
      EXPECT_EQ(found[k], static_cast<double>(base::mix(first + (k + 1) * base::golden) >> 11) * 0x1.0p-53);
  }
}

TEST(UniformKernel, ManyDrawsAtOnceAreThoseDrawnOneByOne) {
  Rng one = Rng(5).stream(3), many = one;
  std::vector<double> list(47);
  many.uniform(list);
  for (const double value : list) EXPECT_EQ(value, one.uniform());
  EXPECT_EQ(many.bits(), one.bits());
}

}  // namespace
}  // namespace kinfer

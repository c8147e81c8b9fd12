// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <numeric>
#include <thread>
#include <vector>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/expect.hpp"
#include "kinfer/base/parallel.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/base/sha256.hpp"
#include "kinfer/base/stop.hpp"

namespace kinfer {
namespace {

TEST(Angle, HalfATurnIs180DegreesAndPiRadians) {
  EXPECT_DOUBLE_EQ((180_deg).rad(), std::numbers::pi);
  EXPECT_DOUBLE_EQ(Angle::rad(std::numbers::pi).deg(), 180.0);
  EXPECT_DOUBLE_EQ((90_deg - 30.0_deg).deg(), 60.0);
}

TEST(Expect, ABrokenExpectationNamesTheConditionAndTheValues) {
  const int rows = 3;
  EXPECT_DEATH(KINFER_EXPECT(rows == 4, "{} rows", rows), "expected rows == 4: 3 rows");
}

TEST(Rng, EqualPathsGiveEqualNumbersAndDifferentPathsDoNot) {
  EXPECT_EQ(Rng(7).stream(3).stream(4).bits(), Rng(7).stream(3).stream(4).bits());
  EXPECT_NE(Rng(7).stream(3).stream(4).bits(), Rng(7).stream(4).stream(3).bits());
  EXPECT_NE(Rng(7).bits(), Rng(8).bits());
}

TEST(Rng, FirstDrawNeverChangesBetweenVersions) {
  // SplitMix64 of the key mix(seed + golden), computed independently of this code: a change here changes every result.
  EXPECT_EQ(Rng(1).bits(), 0x5e41ab087439611eULL);
}

TEST(Rng, MomentsOfNormalAndUniformAreRight) {
  Rng rng(42);
  constexpr int n = 200000;
  double sum = 0, squares = 0, fourth = 0, uniform = 0;
  for (int i = 0; i < n; ++i) {
    const double x = rng.normal();
    sum += x, squares += x * x, fourth += x * x * x * x, uniform += rng.uniform();
  }
  const double sd_of_mean = 1 / std::sqrt(double(n));
  EXPECT_NEAR(sum / n, 0.0, 4 * sd_of_mean);
  EXPECT_NEAR(squares / n, 1.0, 4 * std::sqrt(2.0) * sd_of_mean);
  EXPECT_NEAR(fourth / n, 3.0, 4 * std::sqrt(96.0) * sd_of_mean);
  EXPECT_NEAR(uniform / n, 0.5, 4 * std::sqrt(1.0 / 12) * sd_of_mean);
}

TEST(Rng, IndexReachesEachValueEquallyOften) {
  Rng rng(5);
  std::array<int, 7> count{};
  for (int i = 0; i < 70000; ++i) ++count[rng.index(7)];
  for (const int c : count) EXPECT_NEAR(c, 10000, 400);  // 4 sd of a binomial count
}

TEST(ParallelFor, EveryItemRunsOnceForAnyNumberOfThreads) {
  for (const int threads : {1, 2, 7}) {
    std::vector<int> visits(1000, 0);
    parallel_for(visits.size(), threads, [&](std::size_t i) { ++visits[i]; });
    EXPECT_EQ(visits, std::vector<int>(1000, 1)) << threads << " threads";
  }
}

TEST(ParallelFor, ANestedLoopRunsAllItsItems) {
  std::vector<std::vector<int>> visits(20, std::vector<int>(30, 0));
  parallel_for(20, 3, [&](std::size_t i) { parallel_for(30, 3, [&](std::size_t j) { ++visits[i][j]; }); });
  for (const auto& row : visits) EXPECT_EQ(std::accumulate(row.begin(), row.end(), 0), 30);
}

TEST(ParallelFor, AnExceptionReachesTheCallerAndEndsTheLoop) {
  struct Cancelled {};
  for (const int threads : {1, 2, 7}) {
    std::atomic<int> begun = 0;
    const auto cancel_at_ten = [&](std::size_t i) {
      ++begun;
      if (i == 10) throw Cancelled{};
      if (i > 10) std::this_thread::sleep_for(std::chrono::microseconds(100));  // all of them would take seconds
    };
    EXPECT_THROW(parallel_for(100000, threads, cancel_at_ten), Cancelled);
    EXPECT_LT(begun, 100000) << threads << " threads";
    int visits = 0;
    parallel_for(1, threads, [&](std::size_t) { ++visits; });
    EXPECT_EQ(visits, 1) << "the next loop runs";
  }
}

TEST(ParallelFor, NoItemsIsNoWork) {
  parallel_for(0, 4, [](std::size_t) { FAIL(); });
}

TEST(Sha256, AgreesWithTheStandardsExample) {
  // FIPS 180-2, appendix B.1
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

}  // namespace
}  // namespace kinfer

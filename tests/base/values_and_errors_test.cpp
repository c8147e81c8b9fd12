// SPDX-License-Identifier: Apache-2.0
// Small value types that every room uses: angles, results, observers, buffers, digests, endings.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "kinfer/base/aligned_buffer.hpp"
#include "kinfer/base/angle.hpp"
#include "kinfer/base/instruction_set.hpp"
#include "kinfer/base/observer.hpp"
#include "kinfer/base/parallel.hpp"
#include "kinfer/base/result.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/base/sha256.hpp"
#include "kinfer/base/square.hpp"
#include "kinfer/base/stop.hpp"

namespace kinfer {
namespace {

TEST(Angle, AddsNegatesScalesAndCompares) {
  EXPECT_DOUBLE_EQ((30_deg + 60_deg).rad(), std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ((-(45_deg)).deg(), -45.0);
  EXPECT_DOUBLE_EQ((20_deg * 4.5).deg(), 90.0);
  EXPECT_DOUBLE_EQ((0.5_rad).rad(), 0.5);
  EXPECT_EQ(Angle{}.rad(), 0.0);
  EXPECT_LT(89_deg, 90_deg);
  EXPECT_EQ(Angle::deg(180), Angle::rad(std::numbers::pi));
  EXPECT_DOUBLE_EQ(180 * degree, std::numbers::pi);
}

TEST(Square, IsThatOfTheWholeExpression) {
  static_assert(square(1.0 + 2.0) == 9.0);
  EXPECT_EQ(square(-1.5), 2.25);
}

Result<int> half_of(int number) {
  if (number % 2 != 0) return error("numbers.csv:{}: expected an even number, found {}", 3, number);
  return number / 2;
}

Result<std::string> quarter_in_words(int number) {
  KINFER_TRY(half, half_of(number));
  KINFER_TRY(quarter, half_of(half));
  return "a quarter is " + std::to_string(quarter);
}

TEST(Result, ASentenceIsBoundedWhateverAFileHasInIt) {
  const std::string cell(3000000, '1');
  EXPECT_EQ(error("a.csv:2: expected a number, found \"{}\"; \"t\" is a time", cell).value().what,
            "a.csv:2: expected a number, found \"" + std::string(59, '1') + "... (3000003 bytes) \"t\" is a time");
  std::string umlauts;
  for (int i = 0; i < 2000; ++i) umlauts += "\xc3\xa4";
  EXPECT_EQ(bounded_sentence("x" + umlauts).substr(0, 64), "x" + umlauts.substr(0, 58) + "... (");
  std::string words;
  for (int i = 0; i < 100000; ++i) words += "word ";
  EXPECT_LT(bounded_sentence(words).size(), 2010U);
  const std::string short_one = "x.csv: " + std::string(1900, 'c');
  EXPECT_EQ(bounded_sentence(short_one), short_one) << "a path may be as long";
}

TEST(Result, HoldsTheValueOrTheSentence) {
  EXPECT_EQ(half_of(8).value(), 4);
  ASSERT_FALSE(half_of(7));
  EXPECT_EQ(half_of(7).error().what, "numbers.csv:3: expected an even number, found 7");
}

TEST(Result, TheFirstErrorIsHandedOnToTheCaller) {
  EXPECT_EQ(quarter_in_words(12).value(), "a quarter is 3");
  EXPECT_EQ(quarter_in_words(5).error().what, half_of(5).error().what);
  EXPECT_EQ(quarter_in_words(6).error().what, half_of(3).error().what);  // by another type of Result
  EXPECT_EQ(Result<double>(forward_error({"no such file"})).error().what, "no such file");
}

TEST(Observer, IsToldAndDecidesAndIsNotNeeded) {
  std::vector<double> fractions;
  const Observer observer = [&](const Progress& now) {
    fractions.push_back(now.fraction);
    return now.fraction < 0.5 ? ObserverDecision::proceed : ObserverDecision::stop;
  };
  Progress progress;
  for (const auto& [fraction, decision] :
       {std::pair{0.25, ObserverDecision::proceed}, {0.75, ObserverDecision::stop}}) {
    progress.fraction = fraction;
    EXPECT_EQ(notify(observer, progress), decision);
  }
  EXPECT_EQ(fractions, (std::vector<double>{0.25, 0.75}));
  EXPECT_EQ(notify({}, progress), ObserverDecision::proceed);
}

template <class T>
void expect_aligned() {
  for (std::size_t size = 1; size < 70; size += 3) {
    batch::AlignedBuffer<T> buffer(size);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(buffer.data()) % 64, 0u) << size;
    std::fill_n(buffer.data(), size, T(3));  // the sanitizers see an overrun
    EXPECT_EQ(buffer.data()[size - 1], T(3));
  }
}

TEST(AlignedBuffer, BeginsAtACacheLineWhateverItsSize) {
  expect_aligned<double>();
  expect_aligned<float>();
}

TEST(AlignedBuffer, GrowsAndNeverShrinks) {
  batch::AlignedBuffer<double> buffer;
  EXPECT_EQ(buffer.size(), 0u);
  buffer.reserve(10);
  double* const memory = buffer.data();
  buffer.reserve(5);
  EXPECT_EQ(buffer.size(), 10u);
  EXPECT_EQ(buffer.data(), memory);
  buffer.reserve(11);
  EXPECT_EQ(buffer.size(), 11u);
}

TEST(Sha256, OfNothingAndOfTwoBlocksAgreesWithTheStandard) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  // FIPS 180-2, appendix B.2
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST(Sha256, OfAFileIsThatOfItsBytesAndOfNoFileNothing) {
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "kinfer_sha256_test.bin";
  std::string bytes;
  for (int i = 0; i < 100000; ++i) bytes.push_back(static_cast<char>(i * 7));  // longer than any block
  std::ofstream(path, std::ios::binary) << bytes;
  EXPECT_EQ(sha256_of_file(path), sha256(bytes));
  std::filesystem::remove(path);
  EXPECT_FALSE(sha256_of_file(path));
}

TEST(Stop, NamesDifferAndOnlySuccessCountsAsConverged) {
  std::set<std::string_view> names;
  int successes = 0;
  for (int i = 0; i <= static_cast<int>(Stop::cancelled); ++i) {
    const auto stop = static_cast<Stop>(i);
    names.insert(name(stop));
    successes += converged(stop);
  }
  EXPECT_EQ(names.size(), 8u);
  EXPECT_EQ(successes, 4);
  for (const Stop stop : {Stop::budget_spent, Stop::stalled, Stop::not_finite, Stop::cancelled})
    EXPECT_FALSE(converged(stop)) << name(stop);
  EXPECT_EQ(name(Stop::converged_cost), "converged_cost");
}

TEST(Rng, NumbersLieInTheHalfOpenRange) {
  Rng rng(9);
  double lowest = 1e9, highest = -1e9, sum = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const double x = rng.uniform(-3.0, 5.0);
    lowest = std::min(lowest, x), highest = std::max(highest, x), sum += x;
  }
  EXPECT_GE(lowest, -3.0);
  EXPECT_LT(highest, 5.0);
  EXPECT_LT(lowest, -2.99);
  EXPECT_GT(highest, 4.99);
  EXPECT_NEAR(sum / 20000, 1.0, 4 * 8 / std::sqrt(12.0 * 20000));
}

TEST(Rng, AnIndexOfOneIsZeroAndOfALargeCountInRange) {
  Rng rng(9);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(rng.index(1), 0u);
    EXPECT_LT(rng.index(0xffffffffffffULL), 0xffffffffffffULL);
  }
}

TEST(Rng, AStreamDoesNotChangeItsParentAndIsUncorrelatedWithItsNeighbour) {
  Rng parent(4), untouched(4);
  Rng first = parent.stream(0), second = parent.stream(1);
  EXPECT_EQ(parent.bits(), untouched.bits());
  double product = 0.0;
  constexpr int n = 20000;
  for (int i = 0; i < n; ++i) product += first.normal() * second.normal();
  EXPECT_NEAR(product / n, 0.0, 4 / std::sqrt(double{n}));
}

TEST(ParallelFor, ThreadsAreCountedAndZeroMeansAllOfThem) {
  EXPECT_GE(hardware_threads(), 1);
  std::vector<int> visits(257, 0);
  parallel_for(visits.size(), 0, [&](std::size_t i) { ++visits[i]; });
  EXPECT_EQ(visits, std::vector<int>(257, 1));
}

TEST(InstructionSet, IsTheSameAtEveryCall) {
  EXPECT_EQ(instruction_set(), instruction_set());
  EXPECT_LT(InstructionSet::portable, InstructionSet::avx2);
  EXPECT_LT(InstructionSet::avx2, InstructionSet::avx512);
}

}  // namespace
}  // namespace kinfer

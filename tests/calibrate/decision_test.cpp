// SPDX-License-Identifier: Apache-2.0
// Each decision of model selection, from made-up held-out errors.
#include "kinfer/calibrate/terms/decision.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "kinfer/calibrate/terms/model_terms.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

constexpr ErrorChange clear_gain{
    .mean_before = 1e-3, .mean_after = 0.8e-3, .worst_before = 2e-3, .worst_after = 2e-3, .t = 5.0};
constexpr ErrorChange untested{};

TEST(Decision, AClearGainIsAcceptedAndSoIsNoChange) {
  EXPECT_EQ(decide(clear_gain, untested), Decision::accepted);
  EXPECT_EQ(decide({.mean_before = 1e-3, .mean_after = 1e-3}, untested), Decision::accepted);
}

TEST(Decision, AMeanThatRisesByMoreThanChanceIsNoImprovement) {
  EXPECT_EQ(decide({.mean_before = 1e-3, .mean_after = 1.01e-3, .t = -3.0}, untested), Decision::no_improvement);
  EXPECT_EQ(decide({.mean_before = 1e-3, .mean_after = 1.01e-3, .t = -1.0}, untested), Decision::accepted);
}

TEST(Decision, SinglePosesDecideNothing) {
  ErrorChange change = clear_gain;
  change.worst_after = 20e-3;
  EXPECT_EQ(decide(change, untested), Decision::accepted);
}

TEST(Decision, ATailThatCertainlyRisesIsRefused) {
  ErrorChange change = clear_gain;
  change.p99 = {2e-3, 3e-3, 0.9};
  EXPECT_EQ(decide(change, untested), Decision::accepted);
  change.p99.rise_probability = 0.99;
  EXPECT_EQ(decide(change, untested), Decision::tail_rises);
}

TEST(Decision, TermsThatOnlyInterpolateAreRejected) {
  // Among the poses 0.2 ± 0.04 mm less; one pose in four is expected beyond them, so 1 ± 0.1 mm more there outweigh it.
  EXPECT_EQ(decide(clear_gain, {.mean_before = 1e-3, .mean_after = 2.0e-3, .t = -10.0}), Decision::extrapolation_worse);
  EXPECT_EQ(decide(clear_gain, {.mean_before = 1e-3, .mean_after = 1.5e-3, .t = -4.0}), Decision::accepted);
}

TEST(Decision, ALossBeyondThePosesThatMayBeChanceIsNoReason) {
  // As expected 0.15 ± 0.03 mm are gained, and 0.25 ± 0.25, 0.3 ± 0.06 mm lost: 0.4 and 2.2 standard errors.
  EXPECT_EQ(decide(clear_gain, {.mean_before = 1e-3, .mean_after = 2.0e-3, .t = -1.0}), Decision::accepted);
  EXPECT_EQ(decide(clear_gain, {.mean_before = 1e-3, .mean_after = 2.2e-3, .t = -5.0}), Decision::extrapolation_worse);
  EXPECT_EQ(decide(clear_gain, {.mean_before = 1e-3, .mean_after = 1.7e-3, .t = -4.0}), Decision::accepted);
}

TEST(CompareErrors, TheTailIsComparedByTheBootstrap) {
  std::vector<double> before, after;
  for (int i = 0; i < 400; ++i) before.push_back(1.0 + 0.001 * i), after.push_back(i % 8 ? 0.5 : 3.0);
  const ErrorChange change = compare_errors(before, after);
  EXPECT_LT(change.mean_after, change.mean_before);
  EXPECT_DOUBLE_EQ(change.p95.after, 3.0);
  EXPECT_GT(change.p95.rise_probability, 0.99);
  EXPECT_EQ(compare_errors(after, before).p95.rise_probability, 0.0);
  after = before;
  after.front() = 100.0;
  EXPECT_LT(compare_errors(before, after).p99.rise_probability, 0.5) << "one pose of 400";
}

TEST(CompareErrors, TIsTheMeanReductionOverItsStandardError) {
  const std::vector<double> before{4.0, 5.0, 6.0, 7.0}, after{3.0, 3.0, 3.0, 3.0};  // reductions 1 2 3 4
  const ErrorChange change = compare_errors(before, after);
  EXPECT_DOUBLE_EQ(change.mean_before, 5.5);
  EXPECT_DOUBLE_EQ(change.mean_after, 3.0);
  EXPECT_DOUBLE_EQ(change.worst_before, 7.0);
  EXPECT_DOUBLE_EQ(change.worst_after, 3.0);
  EXPECT_NEAR(change.t, 2.5 / (std::sqrt(5.0 / 3.0) / 2.0), 1e-12);
}

TEST(CompareErrors, OneErrorIsNoComparison) {
  const std::vector<double> one{1.0};
  EXPECT_EQ(compare_errors(one, one).mean_before, 0.0);
}

TEST(ModelTerms, EachTermHasExactlyOneMakerAndName) {
  std::vector<Term> made;
  for (const TermMaker& maker : term_makers()) {
    made.push_back(maker.term);
    EXPECT_EQ(term_named(name(maker.term)), maker.term);
  }
  EXPECT_EQ(std::ranges::count(made, Term::displacement_field), 0);  // it has no numbers of its own
  EXPECT_EQ(made.size() + 1, static_cast<std::size_t>(term_count));
  EXPECT_EQ(term_names().size(), static_cast<std::size_t>(term_count));
  EXPECT_FALSE(term_named("gravitation").has_value());
}

TEST(ModelSelection, TheModelsNameListsItsTerms) {
  ModelSelection selection;
  EXPECT_EQ(selected_model(selection), "");
  selection.steps = {{.decision = Decision::start},
                     {.term = Term::gain, .decision = Decision::no_evidence},
                     {.term = Term::gravity_compliance, .decision = Decision::accepted},
                     {.term = Term::backlash, .decision = Decision::data_missing},
                     {.term = Term::gear_harmonics, .decision = Decision::requested}};
  EXPECT_EQ(selected_model(selection), "geometry + gravity + gear");
  EXPECT_FALSE(was_tested(selection.steps[3]));
  EXPECT_TRUE(was_tested(selection.steps[1]));
}

}  // namespace
}  // namespace kinfer

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

TEST(Decision, AClearGainIsAccepted) {
  EXPECT_EQ(decide(clear_gain, untested, 0.0), Decision::accepted);
}

TEST(Decision, LessThanAHundredthIsNoImprovement) {
  ErrorChange change = clear_gain;
  change.mean_after = 0.991e-3;
  EXPECT_EQ(decide(change, untested, 0.0), Decision::no_improvement);
  change.mean_after = 0.989e-3;
  EXPECT_EQ(decide(change, untested, 0.0), Decision::accepted);
}

TEST(Decision, AGainByChanceIsNotSignificant) {
  ErrorChange change = clear_gain;
  change.t = 2.4;
  EXPECT_EQ(decide(change, untested, 0.0), Decision::not_significant);
}

TEST(Decision, NoPoseMayPayForTheOthers) {
  ErrorChange change = clear_gain;
  change.worst_after = 2.1e-3;
  EXPECT_EQ(decide(change, untested, 0.0), Decision::worst_error_rises);
  EXPECT_EQ(decide(change, untested, 2.2e-3), Decision::accepted) << "the geometric model had a larger one";
}

TEST(Decision, TermsThatOnlyInterpolateAreRejected) {
  const ErrorChange worse{.mean_before = 1e-3, .mean_after = 1.03e-3},
      equal{.mean_before = 1e-3, .mean_after = 1.01e-3};
  EXPECT_EQ(decide(clear_gain, worse, 0.0), Decision::extrapolation_worse);
  EXPECT_EQ(decide(clear_gain, equal, 0.0), Decision::accepted);
}

TEST(Decision, InterpolationIsDecidedFirst) {
  ErrorChange change = clear_gain;
  change.mean_after = change.mean_before;
  EXPECT_EQ(decide(change, {.mean_before = 1.0, .mean_after = 2.0}, 0.0), Decision::no_improvement);
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
  EXPECT_EQ(made.size(), static_cast<std::size_t>(term_count));
  EXPECT_EQ(term_names().size(), static_cast<std::size_t>(term_count));
  EXPECT_FALSE(term_named("gravitation").has_value());
}

TEST(ModelSelection, TheModelsNameListsItsTerms) {
  ModelSelection selection;
  EXPECT_EQ(selected_model(selection), "");
  selection.steps = {{.decision = Decision::start},
                     {.term = Term::gain, .decision = Decision::not_significant},
                     {.term = Term::gravity_compliance, .decision = Decision::accepted},
                     {.term = Term::backlash, .decision = Decision::data_missing},
                     {.term = Term::gear_harmonics, .decision = Decision::requested}};
  EXPECT_EQ(selected_model(selection), "geometry + gravity + gear");
  EXPECT_FALSE(was_tested(selection.steps[3]));
  EXPECT_TRUE(was_tested(selection.steps[1]));
}

}  // namespace
}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/identifiability.hpp"

#include <gmock/gmock.h>

#include "support/random.hpp"

namespace kinfer {
namespace {

ParameterSet named_set(const std::vector<std::string>& names, double prior_sd) {
  ParameterSet set;
  for (const std::string& name : names) {
    Parameter p;
    p.name = name, p.prior_sd = prior_sd;
    set.parameters.push_back(p);
  }
  return set;
}

TEST(IdentifiabilityOf, RankCountsDirectionsKnownBetterThanThePrior) {
  const MatrixXd jacobian = Vec3(1000.0, 10.0, 0.5).asDiagonal().toDenseMatrix();
  for (const auto& [prior_sd, rank] : {std::pair{1.0, 2}, {0.01, 1}, {10.0, 3}, {1e-4, 0}}) {
    const Identifiability found = identifiability(jacobian, named_set({"p", "q", "r"}, prior_sd));
    EXPECT_EQ(found.rank, rank) << prior_sd;
    EXPECT_EQ(found.undetermined.size(), static_cast<std::size_t>(3 - rank));
    EXPECT_LT((found.singular_values - prior_sd * Vec3(1000.0, 10.0, 0.5)).norm(), 1e-9 * prior_sd);
  }
}

TEST(IdentifiabilityOf, ParametersThatActAlikeAreNamedTogetherAndThoseWithoutEffectAlone) {
  MatrixXd jacobian = test::random_matrix(30, 4, 8);
  jacobian.col(2) = -2.0 * jacobian.col(0);
  jacobian.col(3).setZero();
  const Identifiability found =
      identifiability(100.0 * jacobian, named_set({"first", "second", "third", "fourth"}, 1.0));
  EXPECT_EQ(found.rank, 2);
  ASSERT_EQ(found.undetermined.size(), 2u);
  int together = 0, alone = 0;
  for (const UndeterminedGroup& group : found.undetermined) {
    EXPECT_THAT(group.parameters, ::testing::Not(::testing::Contains("second")));
    together += group.parameters == std::vector<std::string>{"first", "third"};
    alone += group.parameters == std::vector<std::string>{"fourth"} && group.reason == Undetermined::no_effect;
  }
  EXPECT_EQ(together, 1);
  EXPECT_EQ(alone, 1);
  EXPECT_EQ(identifiability(MatrixXd(5, 0), {}).rank, 0);
}

}  // namespace
}  // namespace kinfer

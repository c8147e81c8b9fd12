// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/files/identification_files.hpp"

#include <gtest/gtest.h>

#include "kinfer/io/evidence/files/chain_dh_csv.hpp"
#include "support/robots.hpp"

namespace kinfer {
namespace {

TEST(IdentificationFiles, AreNoneWhereNoJointMoves) {
  Identification found;
  found.chain = test::nominal_robot();
  const auto files = identification_files(found);
  ASSERT_EQ(files.size(), 4u);
  EXPECT_EQ(files[0].name, "chain.toml");
  for (Joint& joint : found.chain.joints) joint.type = JointType::fixed;
  EXPECT_TRUE(identification_files(found).empty());
}

TEST(IdentificationFiles, NamesInTheDhTableAreCells) {
  DhRowEstimate row;
  row.segment = "p,q", row.theta_variable = "=1+1";
  EXPECT_EQ(format_chain_dh_csv({row}).find(",=1+1"), std::string::npos) << format_chain_dh_csv({row});
}

}  // namespace
}  // namespace kinfer

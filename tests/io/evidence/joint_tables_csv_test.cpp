// SPDX-License-Identifier: Apache-2.0
// Tables for robot controllers: read back with an independent formula they are the same machine.
#include "kinfer/io/evidence/files/joint_tables_csv.hpp"

#include <gtest/gtest.h>

#include "kinfer/base/angle.hpp"
#include "kinfer/io/motion/path_csv.hpp"
#include "kinfer/io/text/csv.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "laws/example_chains.hpp"
#include "laws/slow_chain.hpp"
#include "support/random.hpp"

namespace kinfer {
namespace {

double number_in(const CsvTable& table, std::size_t row, const std::string& column) {
  for (std::size_t k = 0; k < table.header.columns.size(); ++k)
    if (table.header.columns[k] == column) return *parse_number(table.cell(row, k));
  ADD_FAILURE() << "no column " << column;
  return 0.0;
}

TEST(DhTableCsv, GivesThePosesOfTheChainByThePrintedMatrices) {
  for (const Chain& chain : {laws::dh_6r(), laws::scara(), laws::er20_with_errors(), laws::dh_with_prismatic()}) {
    const std::string text = format_dh_table_csv(chain);
    const auto table = split_csv(text, "dh.csv");
    ASSERT_TRUE(table && table->rows() == chain.joints.size());
    const VectorXd q = laws::random_q(chain, Rng(3));
    laws::Mat4 product = laws::slow_frame(chain.base);
    for (std::size_t j = 0; j < chain.joints.size(); ++j) {
      const auto angle = [&](const char* column) { return number_in(*table, j, column) * degree; };
      const auto length = [&](const char* column) { return 1e-3 * number_in(*table, j, column); };
      DhNumbers numbers{.a = length("a[mm]"),
                        .alpha = angle("alpha[deg]"),
                        .d = length("d[mm]"),
                        .theta = angle("theta[deg]"),
                        .beta = angle("beta[deg]")};
      const double moved = number_in(*table, j, "gain") * q[static_cast<Eigen::Index>(j)];
      const JointType type = chain.joints[j].type;
      product *= std::holds_alternative<DhLink>(chain.joints[j].link) ? laws::slow_link(DhLink{numbers}, type, moved)
                                                                      : laws::slow_link(MdhLink{numbers}, type, moved);
    }
    product *= laws::slow_frame(chain.tool);
    const Pose expected = forward(chain, q);
    EXPECT_LT((product.topLeftCorner<3, 3>() - expected.rotation).norm(), 1e-11) << chain.name;
    EXPECT_LT((product.topRightCorner<3, 1>() - expected.position).norm(), 1e-11) << chain.name;
  }
}

/// Product of exponentials: exp(ξ₁ q₁) … exp(ξₙ qₙ) · (the tool at zero) is the tool at q.
TEST(JointTwistsCsv, GiveThePosesOfTheChainAsAProductOfExponentials) {
  for (const Chain& chain : {laws::dh_6r(), laws::scara(), laws::dh_with_prismatic(), laws::seven_r()}) {
    const std::string text = format_joint_twists_csv(chain);
    const auto table = split_csv(text, "twists.csv");
    ASSERT_TRUE(table && table->rows() == chain.joints.size());
    const VectorXd q = laws::random_q(chain, Rng(4));
    Pose product;
    for (std::size_t j = 0; j < chain.joints.size(); ++j) {
      const Vec3 w(number_in(*table, j, "wx"), number_in(*table, j, "wy"), number_in(*table, j, "wz")),
          v = 1e-3 *
              Vec3(number_in(*table, j, "vx[mm]"), number_in(*table, j, "vy[mm]"), number_in(*table, j, "vz[mm]"));
      const double moved = chain.joints[j].gain * q[static_cast<Eigen::Index>(j)];
      if (translates(chain.joints[j].type)) {
        EXPECT_EQ(w.norm(), 0.0);
        product = product * Pose{Mat3::Identity(), 1e3 * moved * v};
        continue;
      }
      EXPECT_NEAR(w.norm(), 1.0, 1e-9);
      EXPECT_NEAR(w.dot(v), 0.0, 1e-9) << "a hinge has no pitch";
      const Mat3 turn = exp_so3(moved * w);
      product = product * Pose{turn, (Mat3::Identity() - turn) * w.cross(v)};
    }
    const Pose found = product * forward(chain, VectorXd::Zero(q.size())), expected = forward(chain, q);
    EXPECT_LT((found.rotation - expected.rotation).norm(), 1e-8) << chain.name;
    EXPECT_LT((found.position - expected.position).norm(), 1e-8) << chain.name;
  }
}

TEST(CovarianceCsv, HoldsTheMatrixWithTheNamesOfItsParameters) {
  Estimate estimate;
  for (const char* name : {"a2", "theta3", "tool_x"}) estimate.values.push_back({.name = name});
  const MatrixXd root = test::random_matrix(3, 3, 5);
  estimate.covariance = root * root.transpose();
  const std::string text = format_covariance_csv(estimate);
  const auto table = split_csv(text, "covariance.csv");
  ASSERT_TRUE(table) << table.error().what;
  ASSERT_EQ(table->rows(), 3u);
  ASSERT_EQ(table->header.columns.size(), 4u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(table->cell(i, 0), estimate.values[i].name);
    EXPECT_EQ(table->header.columns[i + 1], estimate.values[i].name);
    for (std::size_t j = 0; j < 3; ++j)
      EXPECT_NEAR(*parse_number(table->cell(i, j + 1)),
                  estimate.covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)), 1e-12);
  }
}

TEST(PathCsv, HasPositionVelocityAndAccelerationInUsersUnits) {
  TimedPath path;
  path.time = {0.0, 0.5};
  path.position = (MatrixXd(2, 2) << 0.5, 1.0, 0.1, 0.2).finished();
  path.velocity = 2.0 * path.position;
  path.acceleration = -4.0 * path.position;
  const std::string text = format_path_csv(path, {true, false});
  const auto table = split_csv(text, "path.csv");
  ASSERT_TRUE(table && table->rows() == 2u && table->header.columns.size() == 7u);
  EXPECT_EQ(table->header.columns[0], "t[s]");
  EXPECT_EQ(*parse_number(table->cell(1, 0)), 0.5);
  double sum_of_angles = 0.0, sum_of_lengths = 0.0;
  for (std::size_t k = 1; k < 7; ++k) {
    const bool is_angle = table->header.columns[k].find("deg") != std::string::npos;
    EXPECT_NE(is_angle, table->header.columns[k].find("mm") != std::string::npos) << table->header.columns[k];
    (is_angle ? sum_of_angles : sum_of_lengths) += *parse_number(table->cell(1, k));
  }
  EXPECT_NEAR(sum_of_angles, 1.0 * (1 + 2 - 4) / degree, 1e-6);
  EXPECT_NEAR(sum_of_lengths, 200.0 * (1 + 2 - 4), 1e-6);
}

}  // namespace
}  // namespace kinfer

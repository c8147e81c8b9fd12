// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/tracking/tracking_model_toml.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "kinfer/evidence/tracking/body_poses.hpp"
#include "support/example_tracking_model.hpp"

namespace kinfer {
namespace {

using ::testing::HasSubstr;

std::string with_text_replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(TrackingModelToml, IsReadBackAsItWasWritten) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const TrackingModel model = test::example_tracking_model(seed);
    const std::string text = format_tracking_model(model);
    const auto read = parse_tracking_model(text, "track.toml");
    ASSERT_TRUE(read) << read.error().what;
    const auto head = [](const std::string& all) { return all.substr(0, all.find("root = [")); };
    EXPECT_EQ(head(format_tracking_model(*read)), head(text)) << "all but the covariance to the last bit";
    EXPECT_EQ(read->parameters, model.parameters);
    const VectorXd sd = model.covariance.diagonal().cwiseSqrt();
    const MatrixXd error = (read->covariance - model.covariance).cwiseQuotient(sd * sd.transpose());
    EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-7);
    VectorXd q(model.positions());
    for (Eigen::Index k = 0; k < q.size(); ++k) q[k] = 0.1 * static_cast<double>(k + 1);
    const auto before = body_poses(model, q), after = body_poses(*read, q);
    for (std::size_t b = 0; b < before.size(); ++b) EXPECT_EQ(before[b].position, after[b].position);
    EXPECT_EQ(position_names(*read), position_names(model));
  }
}

TEST(TrackingModelToml, ACovarianceWithCertainDirectionsStaysOne) {
  TrackingModel model = test::example_tracking_model(4);
  model.covariance.row(2).setZero();
  model.covariance.col(2).setZero();
  model.covariance.row(4) = model.covariance.row(3);
  model.covariance.col(4) = model.covariance.col(3);
  const auto read = parse_tracking_model(format_tracking_model(model), "track.toml");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->covariance(2, 2), 0.0);
  const double difference = read->covariance(3, 3) + read->covariance(4, 4) - 2.0 * read->covariance(3, 4);
  EXPECT_LT(std::abs(difference), 1e-10 * read->covariance(3, 3));
}

TEST(TrackingModelToml, WhatIsUnknownIsWrittenAsUnknownAndReadBack) {
  TrackingModel model = test::example_tracking_model(6);
  constexpr Eigen::Index row = 3;
  model.parameters[row] = {TrackingParameterKind::child_rotation, 1, 2};
  const double factor = 204.0 / std::sqrt(model.covariance(row, row));  // [rad] is many turns
  model.covariance.row(row) *= factor;
  model.covariance.col(row) *= factor;
  EXPECT_FALSE(parse_tracking_model(format_tracking_model(model), "track.toml"));
  const TrackingModel limited = with_limited_deviations(model);
  EXPECT_NEAR(std::sqrt(limited.covariance(row, row)), 10.0, 1e-9);
  for (Eigen::Index k = 0; k < model.covariance.rows(); ++k)
    if (k != row) EXPECT_EQ(limited.covariance(k, k), model.covariance(k, k));
  const auto read = parse_tracking_model(format_tracking_model(limited), "track.toml");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_NEAR(std::sqrt(read->covariance(row, row)), 10.0, 1e-6);
}

TEST(TrackingModelToml, HiddenDirectionsAreThoseWithThePriorsVariance) {
  TrackingModel model;
  model.sensors.push_back({});
  model.bodies.push_back({.sensor = 0});
  model.bodies.push_back({.parent = 0, .joint = 0});
  model.joints.push_back({});
  for (int i = 0; i < 3; ++i) model.parameters.push_back({TrackingParameterKind::point_in_child, 1, i});
  model.covariance = Vec3(1e-6, 9.0, 1e-4).asDiagonal();
  const MatrixXd hidden = hidden_directions(model);
  ASSERT_EQ(hidden.cols(), 1);
  EXPECT_NEAR(std::abs(hidden(1, 0)), 1.0, 1e-9);
}

TEST(TrackingModelToml, BadFilesAreOneSentenceWithTheLine) {
  const std::string good = format_tracking_model(test::example_tracking_model(5));
  const auto complaint = [](const std::string& text) {
    const auto read = parse_tracking_model(text, "track.toml");
    return read ? std::string("none") : read.error().what;
  };
  EXPECT_EQ(complaint(good), "none");
  EXPECT_THAT(complaint(with_text_replaced(good, "gravity = ", "graviti = ")), HasSubstr("track.toml:"));
  const std::size_t root = good.find("root = [\n  ") + 11;
  EXPECT_THAT(complaint(std::string(good).replace(root, good.find(',', root) - root, "2e6")),
              HasSubstr("is not possible for the standard deviation of a "));
  EXPECT_THAT(complaint(with_text_replaced(good, "motion = \"revolute\"", "motion = \"rotary\"")),
              HasSubstr("\"rotary\" is none of its values"));
  const auto with_value = [&](const std::string& key, const std::string& value) {
    const std::size_t at = good.find("\n" + key + " = ") + 1;
    return std::string(good).replace(at, good.find('\n', at) - at, key + " = " + value);
  };
  EXPECT_THAT(complaint(with_value("gravity", "1e9")), HasSubstr("not possible for a gravity"));
  EXPECT_THAT(complaint(with_value("sample_period", "-0.01")), HasSubstr("expected a number that is not negative"));
  EXPECT_THAT(complaint(with_value("noise", "[inf, 0.1]")), HasSubstr("\"noise\": inf is not possible"));
  EXPECT_THAT(complaint(with_value("gyroscope_bias", "[0, 1e9, 0]")), HasSubstr("not possible for an angular rate"));
  EXPECT_THAT(complaint(with_text_replaced(good, "parent = 0", "parent = 7")),
              HasSubstr("\"parent\": 7 is out of range"));
  EXPECT_THAT(complaint(with_text_replaced(good, "point_in_parent 1 0", "point_in_parent 99 0")),
              HasSubstr("expected texts"));
  EXPECT_THAT(complaint(with_text_replaced(good, "[base]", "[bass]")), HasSubstr("[base] is missing"));
  EXPECT_THAT(complaint(with_text_replaced(good, "parent_R_axis = [", "parent_R_axis = [3")),
              HasSubstr("is no rotation"));
}

}  // namespace
}  // namespace kinfer

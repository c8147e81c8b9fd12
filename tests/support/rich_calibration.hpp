// SPDX-License-Identifier: Apache-2.0
// A calibration with every member set, invented: what evidence.json and its report must carry.
#pragma once

#include "support/rich_parts.hpp"

namespace kinfer::test {

inline ModelSelection rich_model_selection() {
  const ErrorStatistics train{1e-4, 1.1e-4, 2e-5, 3e-4, 40}, holdout{1.2e-4, 1.3e-4, 2e-5, 4e-4, 10};
  return {.steps = {{.train = train, .holdout = holdout, .parameter_count = 24, .determined_count = 22},
                    {.term = Term::backlash,
                     .decision = Decision::no_improvement,
                     .interpolation = {1e-4, 1.1e-4, 3e-4, 3e-4, std::numeric_limits<double>::infinity()},
                     .train = train,
                     .holdout = holdout,
                     .parameter_count = 6},
                    {.term = Term::gravity_compliance,
                     .decision = Decision::data_missing,
                     .missing = MissingData::gravity,
                     .parameter_count = 6,
                     .undetermined_parameters = {"compliance1"}}}};
}

inline SearchSummary rich_search() {
  return {.method = SearchMethod::bpnn_pso,
          .iterations = 120,
          .evaluations = 9600,
          .stop = Stop::stalled,
          .cost = std::numeric_limits<double>::infinity(),
          .best = {3.0, 1.0, 0.1},
          .median = {5.0, 4.0, 0.5},
          .net = {},
          .swarm_comparison = {{InitialSwarm::uniform, -1, 9600, 2e-4}, {InitialSwarm::network, 40, 3200, 1e-4}}};
}

inline UnknownRobotEvidence rich_unknown_robot() {
  return {.starts = 12,
          .agreeing = 9,
          .median_error = 3e-5,
          .axes = {.pairs = {{"J<1>", "J2", AxisRelation::parallel, 1e-3, 0.4},
                             {"J2", "J3", AxisRelation::at_angle, 1.57, std::nullopt}},
                   .wrists = {{"J2", "J3", "J4"}}}};
}

inline CalibrationPlotData rich_plot_data(int rows) {
  CalibrationPlotData plot;
  plot.nominal = plot.before = rich_chain();
  plot.joints = MatrixXd::Constant(3, rows, 0.2);
  for (int row = 0; row < rows; ++row) {
    plot.joints(0, row) = 0.1 * row;
    plot.rows.push_back({Vec3(0.3, 0.1, 0.12345678912 * row), Vec3(1e-3, 0, 0), Vec3(1e-4, 0, 0), 5e-5 * row});
  }
  plot.rows.back() = {};  // a row without a measured point
  for (int k = 0; k < 5; ++k) plot.workspace.push_back({Vec3(1, 0.2 * k, 3), 1e-4 * (k + 1), {}});
  return plot;
}

inline Calibration rich_calibration() {
  constexpr int rows = 6;
  Calibration c;
  c.estimate.chain = rich_chain();
  c.estimate.values = {{"a2", Quantity::length, 0.3, 0.3001, 1e-5, true},
                       {"base_rz", Quantity::angle, 0.0, 0.01, 1e-3, true},
                       {"theta<1>", Quantity::angle, 0.0, 0.0, 1e-3, false},
                       {"compliance2", Quantity::compliance, 0.0, 1e-6, 1e-7, true}};
  c.estimate.covariance = 1e-8 * (MatrixXd::Identity(4, 4) + MatrixXd::Constant(4, 4, 0.5));
  c.estimate.identifiability = {VectorXd::LinSpaced(4, 10.0, 0.1), 3, {{Undetermined::confounded, {"a2", "d<3>"}}}};
  c.estimate.chi2_per_n = 1.2;
  c.estimate.sigma = 1e-5, c.estimate.sigma_angle = 2e-5;
  c.estimate.outliers = {
      {2, 4, {{kind_of<PointMeasurement>, 0.01, 200.0}, {kind_of<TiltMeasurement>, 0.1, 5.0}}, 200.0, true}};
  c.estimate.predicted_error = 3e-5;
  c.estimate.search = rich_search();
  c.nominal.position = {{5e-3, 6e-3, 1e-3, 9e-3, 5}, {5.1e-3, 6e-3, 1e-3, 9e-3, 5}, {}};
  c.before.position = {{1e-3, 1.1e-3, 1e-4, 2e-3, 5}, {1.2e-3, 1e-3, 1e-4, 2e-3, 5}, {1.3e-3, 1e-3, 1e-4, 2e-3, 6}};
  c.after.position = {{1e-4, 1.1e-4, 1e-5, 2e-4, 5}, {1.2e-4, 1e-4, 1e-5, 2e-4, 5}, {1.3e-4, 1e-4, 1e-5, 2e-4, 6}};
  c.before.orientation.train = {2e-3, 2e-3, 1e-4, 3e-3, 5};
  c.after.orientation.train = {2e-4, 2e-4, 1e-5, 3e-4, 5};
  c.model_selection = rich_model_selection();
  c.holdout = HoldoutFraction{0.2};
  c.expected_holdout_rms = 1.1e-4;
  c.predicted_holdout_rms = 1.3e-4;
  c.unobserved_lengths = {UnobservedLength::size, 2e-4};
  c.gross_error_rows = {2};
  for (int row = 0; row < rows; ++row) c.rows.push_back({row, 1e-3 + 1e-4 * row, 1e-4, 9e-5, row % 2 == 0});
  c.rows.back().before = c.rows.back().after = not_measured;
  c.accuracy = {{{0, 1}, 1e-3, 1e-4, 5e-5}, {{2}, 2e-3, 2e-4, std::nullopt}};
  c.plot_data = rich_plot_data(rows);
  c.recommendations = {
      {CalibrationAdviceKind::extend_joint_range, {{"joint", std::string("J<2>")}, {"range_rad", 0.2}}},
      {CalibrationAdviceKind::keep_verification_poses, {}}};
  c.findings = {rich_finding(FindingKind::joint_hardly_moves, Severity::warning, false),
                rich_finding(FindingKind::outside_limits, Severity::fault, true)};
  c.notes = {{CalibrationNoteKind::joint_offset_moved,
              {{"parameter", std::string("<b>bold & brave</b>")}, {"change_m", 1e-3}, {"sigmas", 7.0}}},
             {CalibrationNoteKind::many_gross_errors, {{"rows", 3}}}};
  c.unknown_robot = rich_unknown_robot();
  return c;
}

}  // namespace kinfer::test

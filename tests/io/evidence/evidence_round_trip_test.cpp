// SPDX-License-Identifier: Apache-2.0
// evidence.json is read as it was written: the same bytes again, and the same values.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "kinfer/io/evidence/calibration_json.hpp"
#include "kinfer/io/evidence/evidence_file.hpp"
#include "kinfer/io/evidence/findings_json.hpp"
#include "kinfer/io/evidence/frames_json.hpp"
#include "kinfer/io/evidence/identification_json.hpp"
#include "kinfer/io/evidence/plot_rounding.hpp"
#include "support/rich_evidence.hpp"

namespace kinfer::test {
namespace {

using nlohmann::ordered_json;

std::string written(const Calibration& c) {
  return format_calibration_evidence(calibration_evidence(c, rich_provenance()));
}

std::string written(const Identification& i) {
  return format_identification_evidence(identification_evidence(i, rich_provenance()));
}

TEST(EvidenceRoundTrip, ACalibrationIsWrittenAgainWithTheSameBytes) {
  for (const Calibration& c : {rich_calibration(), Calibration{}}) {
    const std::string text = written(c);
    const auto read = read_calibration_evidence(text);
    ASSERT_TRUE(read) << read.error().what;
    EXPECT_EQ(format_calibration_evidence(*read), text);
  }
}

TEST(EvidenceRoundTrip, AnIdentificationIsWrittenAgainWithTheSameBytes) {
  for (const Identification& i : {rich_identification(), Identification{}}) {
    const std::string text = written(i);
    const auto read = read_identification_evidence(text);
    ASSERT_TRUE(read) << read.error().what;
    EXPECT_EQ(format_identification_evidence(*read), text);
  }
}

TEST(EvidenceRoundTrip, FramesAreWrittenAgainWithTheSameBytes) {
  const std::string text = format_frames_evidence(frames_evidence(rich_frames()));
  const auto read = read_frames_evidence(text);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(format_frames_evidence(*read), text);
  EXPECT_TRUE(std::isnan(read->sweeps.front().axis_sd));
}

TEST(EvidenceRoundTrip, ValuesOfACalibrationComeBack) {
  const CalibrationEvidence e = read_calibration_evidence(written(rich_calibration())).value();
  const Calibration c = rich_calibration();
  EXPECT_EQ(e.robot, c.estimate.chain.name);
  EXPECT_EQ(e.verdict.sentence, sentence(e.verdict.parts.value()) + ".");
  EXPECT_EQ(e.verdict.usability, Usability::use);
  EXPECT_EQ(e.reason, CalibrationReason::improves_nominal);
  EXPECT_EQ(e.next[0].kind, CalibrationAdviceKind::extend_joint_range);
  EXPECT_EQ(e.next[0].values, c.recommendations[0].values);
  EXPECT_EQ(e.note_facts[0].values, c.notes[0].values);
  EXPECT_EQ(e.unknown_robot->axes.pairs[0].distance, 0.4);
  EXPECT_FALSE(e.unknown_robot->axes.pairs[1].distance);
  EXPECT_EQ(e.unknown_robot->axes.wrists, c.unknown_robot->axes.wrists);
  EXPECT_EQ(e.measurement, kind_of<PointMeasurement>);
  EXPECT_EQ(e.expected_holdout_rms, 1.1e-4);
  EXPECT_EQ(e.predicted_holdout_rms, 1.3e-4);
  EXPECT_EQ(e.unobserved_lengths->kind, UnobservedLength::size);
  EXPECT_EQ(e.unobserved_lengths->relative_sd, 2e-4);
  EXPECT_EQ(e.identifiability.undetermined[0].parameters, (std::vector<std::string>{"a2", "d<3>"}));
  EXPECT_EQ(e.outliers[0].outlier.reasons[1].kind, kind_of<TiltMeasurement>);
  EXPECT_TRUE(e.outliers[0].outlier.held_out);
  EXPECT_EQ(e.model.models[1].decision, Decision::no_improvement);
  EXPECT_EQ(e.model.models[1].interpolation->mean_after, 1.1e-4);
  EXPECT_EQ(e.model.models[2].missing, MissingData::gravity);
  EXPECT_FALSE(e.model.models[2].interpolation);
  EXPECT_EQ(e.findings.size(), 2u);
  EXPECT_EQ(e.findings[0].finding.kind, FindingKind::joint_hardly_moves);
  EXPECT_EQ(e.findings[1].finding.severity, Severity::fault);
  for (const char* key : {"stationary", "left_out"})
    EXPECT_EQ(e.findings[0].finding.values.texts(key), c.findings[0].values.texts(key));
  EXPECT_EQ(e.parameters[3].quantity, Quantity::compliance);
  EXPECT_EQ(e.after.orientation.train.mean, 2e-4);
  EXPECT_EQ(e.search.summary.stop, Stop::stalled);
  EXPECT_EQ(e.search.summary.swarm_comparison[0].iterations, -1);
  EXPECT_EQ(e.covariance, c.estimate.covariance);
  EXPECT_EQ(e.identifiability.singular_values, c.estimate.identifiability.singular_values);
  EXPECT_TRUE(std::isnan(e.rows.back().before));
  EXPECT_FALSE(e.picture.rows.back().measured);
  EXPECT_EQ(e.picture.joints.rows(), 3);
  EXPECT_EQ(e.picture.joints.cols(), 6);
  EXPECT_EQ(e.provenance.seed, 18446744073709551615U);
  EXPECT_EQ(e.provenance.options[2].second, "<map>");
}

TEST(EvidenceRoundTrip, ValuesOfAnIdentificationComeBack) {
  const IdentificationEvidence e = read_identification_evidence(written(rich_identification())).value();
  EXPECT_EQ(e.joints[1].estimate.type, EstimatedJointType::spherical);
  EXPECT_TRUE(e.joints[1].estimate.azimuth_unobservable);
  EXPECT_EQ(e.joints[0].unobservable.front().unobservable.kind, UnobservableKind::point_along);
  EXPECT_EQ(e.joints[0].unobservable.front().unobservable.directions[0], Vec3(Vec3::UnitX()));
  EXPECT_EQ(e.joints[0].unobservable.back().unobservable.other_joint, "s<1>-s2");
  EXPECT_EQ(e.joints[0].sentences.size(), 2u);
  EXPECT_EQ(e.search.method, LinkSearchMethod::enumeration);
  EXPECT_EQ(e.joints[0].estimate.sd.point_in_child[0], 0.9);
  EXPECT_EQ(e.dh[0].row.beta, 0.5);
  EXPECT_EQ(e.search.segments[0].found.size(), 2u);
  EXPECT_EQ(e.search.evaluations, 5000000000);
  EXPECT_EQ(e.forecast[0].azimuth_of, "s0");
  EXPECT_EQ(e.forecast[1].azimuth_of, "");
  EXPECT_EQ(e.search.segments[0].written_holdout->acceleration, 0.31);
  ASSERT_EQ(e.loops.size(), 1u);
  EXPECT_EQ(e.loops[0].joint.child, "s2");
  EXPECT_EQ(e.loops[0].joint.axis_in_parent, Vec3(Vec3::UnitY()));
  EXPECT_EQ(e.loops[0].segments.size(), 3u);
  EXPECT_EQ(e.loops[0].log_odds, 40.5);
  EXPECT_EQ(e.fit.holdout.front().second.acceleration, 0.3);
  EXPECT_DOUBLE_EQ(e.clocks[0].drift, 1.7);  // [ppm]
  EXPECT_EQ(e.motion.held_out[1].begin, 0.8);
  EXPECT_TRUE(std::isnan(e.motion.traces[0].measured[0].low[3]));
  EXPECT_EQ(e.order.phases[0].moves, (std::vector<bool>{true, false, true}));
}

TEST(EvidenceRoundTrip, WhatChangedSinceAnEarlierIdentificationComesBack) {
  Identification updated = rich_identification();
  updated.update = ChainUpdate{
      .changes = {{ChainChangeKind::sensor_moved, "s<1>", "s<1>", "s<1>-s2", ChangeSize{0.02, 1e-4}, {}, 12.5},
                  {ChainChangeKind::joint_moved, "s0-s<1>", "s0", "", {}, ChangeSize{0.03, 2e-3}, 4.0}},
      .parts = {{"s0-s<1>", "s0", ChainPartQuantity::point, 0.03, 1e-3, 900.0, 3}},
      .squared_distance = 12.0,
      .freedom = 20,
      .is_other_machine = true};
  const std::string text = written(updated);
  const auto read = read_identification_evidence(text);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(format_identification_evidence(*read), text);
  ASSERT_TRUE(read->update);
  const ChainChange &sensor = read->update->changes[0].change, &joint = read->update->changes[1].change;
  EXPECT_EQ(sensor.angle->value, 0.02);
  EXPECT_FALSE(sensor.distance);
  EXPECT_EQ(sensor.alternative, "s<1>-s2");
  EXPECT_EQ(joint.kind, ChainChangeKind::joint_moved);
  EXPECT_EQ(joint.distance->sd, 2e-3);
  EXPECT_EQ(read->update->parts[0].quantity, ChainPartQuantity::point);
  EXPECT_EQ(read->update->freedom, 20);
  EXPECT_TRUE(read->update->is_other_machine);
  EXPECT_FALSE(read_identification_evidence(written(rich_identification())).value().update);
}

TEST(EvidenceRoundTrip, ATreeWithoutAlternativeHasNoMargin) {
  Identification two_sensors = rich_identification();
  two_sensors.order.margin = std::nullopt;
  const std::string text = written(two_sensors);
  EXPECT_NE(text.find("\"margin\": null"), std::string::npos);
  EXPECT_FALSE(read_identification_evidence(text).value().order.margin);
}

TEST(EvidenceRoundTrip, TheKindDecidesWhatIsRead) {
  EXPECT_TRUE(std::holds_alternative<CalibrationEvidence>(read_evidence(written(rich_calibration())).value()));
  EXPECT_TRUE(std::holds_alternative<IdentificationEvidence>(read_evidence(written(rich_identification())).value()));
  EXPECT_TRUE(std::holds_alternative<FramesEvidence>(
      read_evidence(format_frames_evidence(frames_evidence(rich_frames()))).value()));
}

TEST(EvidenceRoundTrip, AnOlderFileWithoutLaterKeysReadsWithDefaults) {
  ordered_json json = ordered_json::parse(written(rich_calibration()));
  for (const char* key : {"format", "next", "findings", "wrong_rows", "measured", "iso9283", "use", "provenance",
                          "usability", "verdict_parts", "reason", "note_facts", "unknown_robot", "measurement",
                          "expected_holdout_rms", "predicted_holdout_rms", "unobserved_lengths", "undetermined"})
    json.erase(key);
  for (auto& outlier : json["outliers"])
    for (const char* key : {"measurements", "sigmas", "held_out"}) outlier.erase(key);
  for (auto& model : json["model"]["rungs"])
    for (const char* key : {"decision", "missing", "interpolation", "extrapolation"}) model.erase(key);
  const auto read = read_calibration_evidence(json.dump());
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->measured, "position");
  EXPECT_EQ(read->verdict.usability, Usability::use_with_care);
  EXPECT_FALSE(read->verdict.parts);
  EXPECT_TRUE(read->findings.empty());
  EXPECT_FALSE(read->model.models[1].decision);
}

TEST(EvidenceRoundTrip, OfOlderFilesUseAloneTellsTheUsability) {
  ordered_json json = ordered_json::parse(written(rich_identification()));
  json.erase("usability"), json.erase("verdict_parts");
  json["joints"][0].erase("unobservable");
  json["use"] = false;
  const IdentificationEvidence read = read_identification_evidence(json.dump()).value();
  EXPECT_EQ(read.verdict.usability, Usability::do_not_use);
  EXPECT_TRUE(read.joints[0].unobservable.empty());
  EXPECT_EQ(read.joints[0].sentences.size(), 2u);
}

TEST(EvidenceRoundTrip, KeysThatNoMemberHasAreIgnored) {
  ordered_json json = ordered_json::parse(written(rich_identification()));
  json["of_a_later_version"] = {1, 2, 3};
  json["joints"][0]["also"] = "this";
  EXPECT_TRUE(read_identification_evidence(json.dump()));
}

TEST(EvidenceRoundTrip, AFindingsListIsThatOfTheEvidence) {
  const auto list = ordered_json::parse(format_findings(rich_calibration().findings));
  EXPECT_EQ(list, ordered_json::parse(written(rich_calibration())).at("findings"));
}

TEST(Headline, OfACalibrationIsOneLineWithTheChosenModel) {
  const std::string line = format_calibration_headline(rich_calibration());
  EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1);
  const auto json = ordered_json::parse(line);
  EXPECT_EQ(json.at("model"), "geometry");
  EXPECT_EQ(json.at("outliers"), 1);
  EXPECT_EQ(json.at("after").at("train").at("mean"), 1e-4);
}

TEST(Headline, OfAnIdentificationHoldsJointsAndFit) {
  const auto json = ordered_json::parse(format_identification_headline(rich_identification()));
  EXPECT_EQ(json.at("joints").size(), 2u);
  EXPECT_EQ(json.at("fit").at("holdout").at("s<1>").at("acceleration"), 0.3);
  EXPECT_EQ(json.at("use"), true);
}

TEST(Records, WithoutModelSelectionTheFittedModelIsTheOnlyEntry) {
  Calibration c = rich_calibration();
  c.model_selection = {};
  const ModelSelectionRecord record = calibration_evidence(c, {}).model;
  EXPECT_EQ(record.selected, "geometry");
  ASSERT_EQ(record.models.size(), 1u);
  EXPECT_TRUE(record.models[0].selected);
  EXPECT_EQ(record.models[0].holdout.mean, c.after.position.holdout.mean);
}

TEST(Records, Iso9283CountsRepeatabilityOnlyWherePosesRepeat) {
  const AccuracyStatistics iso = calibration_evidence(rich_calibration(), {}).iso9283.value();
  EXPECT_EQ(iso.before.n, 2);
  EXPECT_DOUBLE_EQ(iso.before.mean, 1.5e-3);
  EXPECT_EQ(iso.repeatability.n, 1);
  EXPECT_DOUBLE_EQ(iso.repeatability.max, 5e-5);
}

TEST(Records, EffortOfAStructureSearchIsTheSumOverItsSegments) {
  Identification found = rich_identification();
  found.searches.push_back(found.searches.front());
  const StructureSearchRecord record = structure_search_record(found);
  EXPECT_EQ(record.evaluations, 10000000000);
  EXPECT_EQ(record.generations, 60);
  EXPECT_EQ(record.best.size(), 2u);
}

TEST(PlotRounding, KeepsAPartInFourThousandOfTheLargest) {
  const std::vector<double> values{0.123456, -1.9, 1e-7, 0.0};
  const std::vector<double> result = rounded_for_plot(values);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(result[i], values[i], 0.5 * 1.9 / 4000);
  EXPECT_EQ(result[2], 0.0);
  EXPECT_EQ(rounded_for_plot(result), result);
}

TEST(PlotRounding, LeavesWhatIsNotFinite) {
  EXPECT_TRUE(std::isnan(rounded(not_measured)));
  EXPECT_TRUE(std::isnan(rounded_for_plot({1.0, not_measured})[1]));
  EXPECT_EQ(rounded(0.12345678), 0.1234568);
  EXPECT_FALSE(std::signbit(rounded(-1e-9)));
}

}  // namespace
}  // namespace kinfer::test

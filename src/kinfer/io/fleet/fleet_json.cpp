// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/fleet/fleet_json.hpp"

#include <charconv>
#include <cmath>

#include "kinfer/io/evidence/json/shared_fields.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/words/fleet/fleet.hpp"

namespace kinfer {
namespace evidence_json {

template <class Archive>
void fields(Archive& a, Value<Archive, SummaryFigure>& figure) {
  a("name", figure.name);
  a("value", figure.value);
}

template <class Archive>
void fields(Archive& a, Value<Archive, SummaryParameter>& parameter) {
  a("name", parameter.name);
  a("unit", parameter.quantity);
  a("nominal", parameter.nominal);
  a("value", parameter.value);
  a("sd", parameter.sd);
  a.when(parameter.truth.has_value(), "truth", parameter.truth);
}

template <class Archive>
void fields(Archive& a, Value<Archive, ParameterInformation>& information) {
  a.constant("format", "kinfer-information/1");
  a("names", information.names);
  a("nominal", information.nominal);
  a("tolerance", information.tolerance);
  a("vector", information.vector);
  a.matrix_rows("information", information.information);
}

template <class Archive>
void fields(Archive& a, Value<Archive, TaskSummary>& summary) {
  a.constant("format", "kinfer-summary/1");
  a("verb", summary.verb);
  a.when(summary.usability.has_value(), "usability", summary.usability);
  a("reason", summary.reason);
  a("figures", summary.figures);
  a("findings", summary.findings);
  a("parameters", summary.parameters);
}

template <class Archive>
void fields(Archive& a, Value<Archive, FleetCounts>& counts) {
  a("use", counts.use);
  a("use_with_care", counts.use_with_care);
  a("do_not_use", counts.do_not_use);
  a("refused", counts.refused);
  a("failed", counts.failed);
  a("unfinished", counts.unfinished);
  a("unreadable", counts.unreadable);
}

template <class Archive>
void fields(Archive& a, Value<Archive, FleetSpread>& spread) {
  a("verb", spread.verb);
  a("name", spread.name);
  a("logarithmic", spread.logarithmic);
  a("median", spread.median);
  a("sd", spread.sd);
  a("count", spread.count);
}

template <class Archive>
void fields(Archive& a, Value<Archive, FleetDeviation>& deviation) {
  a("key", deviation.key);
  a("name", deviation.name);
  a("value", deviation.value);
  a("typical", deviation.typical);
  a("sigmas", deviation.sigmas);
}

template <class Archive>
void fields(Archive& a, Value<Archive, FleetAlarm>& alarm) {
  a("robot", alarm.robot);
  a("name", alarm.name);
  a("since", alarm.since);
  a("noticed", alarm.noticed);
  a("key", alarm.key);
  a("rises", alarm.rises);
  a("statistic", alarm.statistic);
}

template <class Archive>
void fields(Archive& a, Value<Archive, ControlChartSummary>& chart) {
  a("series", chart.series);
  a("checks", chart.checks);
  a("limit", chart.limit);
  a("run_length", chart.run_length);
  a("false_alarms", chart.false_alarms);
  a("alarms", chart.alarms);
}

template <class Archive>
void fields(Archive& a, Value<Archive, FailureGroup>& group) {
  a("sentence", group.sentence);
  a("keys", group.keys);
}

template <class Archive>
void fields(Archive& a, Value<Archive, CoverageCount>& count) {
  a("name", count.name);
  a("inside", count.inside);
  a("count", count.count);
}

template <class Archive>
void fields(Archive& a, Value<Archive, PopulationPrior>& population) {
  a.constant("format", "kinfer-prior/1");
  a("robots", population.robots);
  a("pseudo_robots", population.pseudo_robots);
  a("names", population.names);
  a("nominal", population.nominal);
  a("tolerance", population.tolerance);
  a("mean", population.mean);
  a.matrix_rows("covariance", population.covariance);
}

namespace {

double with_ten_digits(double value) {
  if (!std::isfinite(value)) return value;
  char text[40];
  const auto written = std::to_chars(text, text + sizeof text, value, std::chars_format::scientific, 9);
  double result = value;
  std::from_chars(text, written.ptr, result);
  return result;
}

void round_numbers(Json& json) {
  if (json.is_number_float()) json = with_ten_digits(json.get<double>());
  if (json.is_structured())
    for (Json& member : json) round_numbers(member);
}

template <class T>
Result<T> parse_file(std::string_view text, const std::string& name) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) return error("{}: not a JSON object", name);
  T value;
  ReadErrors errors;
  const JsonPath root;
  JsonReader(json, root, errors).read(json, root, value);
  if (errors.first()) return error("{}: {}", name, *errors.first());
  return value;
}

bool is_square(const MatrixXd& matrix, std::size_t n) {
  return matrix.rows() == static_cast<Eigen::Index>(n) && matrix.cols() == matrix.rows();
}

bool has_size(const VectorXd& vector, std::size_t n) {
  return vector.size() == static_cast<Eigen::Index>(n);
}

}  // namespace
}  // namespace evidence_json

std::string format_task_summary(const TaskSummary& summary) {
  auto json = evidence_json::JsonWriter::object_of(summary);
  evidence_json::round_numbers(json);
  return json.dump() + "\n";
}

Result<TaskSummary> parse_task_summary(std::string_view text) {
  return evidence_json::parse_file<TaskSummary>(text, "summary.json");
}

std::string format_information(const ParameterInformation& information) {
  auto json = evidence_json::JsonWriter::object_of(information);
  evidence_json::round_numbers(json);
  return json.dump() + "\n";
}

Result<ParameterInformation> parse_information(std::string_view text) {
  KINFER_TRY(data, evidence_json::parse_file<ParameterInformation>(text, "information.json"));
  const std::size_t n = data.names.size();
  if (!evidence_json::has_size(data.nominal, n) || !evidence_json::has_size(data.tolerance, n) ||
      !evidence_json::has_size(data.vector, n) || !evidence_json::is_square(data.information, n))
    return error("information.json: expected as many numbers as names");
  return data;
}

std::string format_fleet(const Fleet& fleet) {
  evidence_json::JsonWriter writer;
  writer.constant("format", "kinfer-fleet/1");
  writer("verdict", words::headline(fleet.counts));
  writer("counts", fleet.counts);
  writer("processor_classes", fleet.processor_classes);
  writer("deviations", fleet.deviations);
  writer("chart", fleet.chart);
  writer("failures", fleet.failures);
  writer("coverage", fleet.coverage);
  writer("spreads", fleet.spreads);
  std::vector<std::string> unfinished;
  for (const FleetRow& row : fleet.rows)
    if (row.state == TaskState::unfinished) unfinished.push_back(row.key);
  writer("unfinished", unfinished);
  auto json = writer.json();
  evidence_json::round_numbers(json);
  return json.dump(1) + "\n";
}

std::string format_population(const PopulationPrior& population) {
  auto json = evidence_json::JsonWriter::object_of(population);
  evidence_json::round_numbers(json);
  return json.dump(1) + "\n";
}

Result<PopulationPrior> parse_population(std::string_view text, const std::string& name_in_messages) {
  KINFER_TRY(prior, evidence_json::parse_file<PopulationPrior>(text, name_in_messages));
  const std::size_t n = prior.names.size();
  if (!evidence_json::has_size(prior.nominal, n) || !evidence_json::has_size(prior.tolerance, n) ||
      !evidence_json::has_size(prior.mean, n) || !evidence_json::is_square(prior.covariance, n))
    return error("{}: expected as many numbers as names", name_in_messages);
  if (n == 0 || !prior.mean.allFinite() || !(prior.tolerance.minCoeff() > 0.0) || !cholesky(prior.covariance))
    return error("{}: the covariance is not positive definite", name_in_messages);
  return prior;
}

Result<PopulationPrior> read_population(const std::filesystem::path& path) {
  KINFER_TRY(text, read_text_file(path));
  return parse_population(text, path.string());
}

}  // namespace kinfer

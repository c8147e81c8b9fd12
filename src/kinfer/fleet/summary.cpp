// SPDX-License-Identifier: Apache-2.0
#include "kinfer/fleet/summary.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "kinfer/estimate/poses/parameter_information.hpp"
#include "kinfer/kinematics/parameters.hpp"

namespace kinfer::fleet {
namespace {

std::vector<std::string> kinds_of(const std::vector<Finding>& findings) {
  std::vector<std::string> kinds;
  for (const Finding& finding : findings)
    if (const std::string kind(name(finding.kind)); std::ranges::find(kinds, kind) == kinds.end())
      kinds.push_back(kind);
  return kinds;
}

bool has_joints_of(const Chain& chain, const Chain& other) {
  return chain.joints.size() == other.joints.size();
}

/// The number that `truth` has by this name; what it has no terms for is zero in it.
std::optional<double> truth_of(const std::string& name, const JointNumber& at, const Chain& truth,
                               const std::map<std::string, ParameterAddress>& true_numbers) {
  if (const auto found = true_numbers.find(name); found != true_numbers.end()) return value_at(truth, found->second);
  const bool is_term = at.field == Field::sine || at.field == Field::cosine || at.field == Field::coupling;
  return is_term ? std::optional(0.0) : std::nullopt;
}

std::vector<SummaryParameter> joint_parameters_of(const Calibration& calibration, const Chain* truth) {
  const auto free = calibration.estimate.parameters.free();
  const bool has_truth = truth && has_joints_of(*truth, calibration.estimate.chain);
  const auto true_numbers = has_truth ? addresses_by_name(*truth) : std::map<std::string, ParameterAddress>{};
  std::vector<SummaryParameter> list;
  for (std::size_t k = 0; k < free.size(); ++k) {
    const JointNumber* number = joint_number(free[k]->at);
    if (!number) continue;
    const ParameterEstimate& value = calibration.estimate.values[k];
    SummaryParameter parameter{
        .name = value.name, .quantity = value.quantity, .nominal = value.nominal, .value = value.value, .sd = value.sd};
    if (has_truth) parameter.truth = truth_of(value.name, *number, *truth, true_numbers);
    list.push_back(std::move(parameter));
  }
  return list;
}

}  // namespace

TaskSummary summary_of(const Calibration& calibration, const Chain* truth) {
  const std::string unit_name = has_lengths(calibration) ? "_m" : "_rad";
  const ErrorStatistics before = reported_errors(calibration, calibration.before),
                        after = reported_errors(calibration, calibration.after);
  TaskSummary summary{.verb = "calibrate",
                      .usability = calibration.usability,
                      .reason = std::string(name(calibration.reason)),
                      .findings = kinds_of(calibration.findings)};
  summary.figures = {{"rms_before" + unit_name, before.rms},
                     {"rms_after" + unit_name, after.rms},
                     {"max_after" + unit_name, after.max},
                     {"sigma_m", calibration.estimate.sigma},
                     {"poses", static_cast<double>(calibration.rows.size())},
                     {"outliers", static_cast<double>(calibration.estimate.outliers.size())}};
  summary.parameters = joint_parameters_of(calibration, truth);
  summary.information = information_of(calibration.estimate, calibration.nominal_model);
  return summary;
}

std::string length_name(const std::string& segment, const std::string& from, const std::string& to) {
  return "length_" + segment + "_" + from + "_" + to;
}

TaskSummary summary_of(const Identification& identification, const std::map<std::string, double>& true_lengths) {
  TaskSummary summary{
      .verb = "identify", .usability = identification.usability, .findings = kinds_of(identification.findings)};
  summary.figures = {{"joints", static_cast<double>(identification.joints.size())},
                     {"worst_acceleration_m_s2", identification.prediction.worst_acceleration}};
  for (const LinkEstimate& link : identification.links) {
    const std::string name = length_name(link.segment, link.from, link.to);
    SummaryParameter length{.name = name, .nominal = link.length, .value = link.length, .sd = link.sd};
    if (const auto truth = true_lengths.find(name); truth != true_lengths.end()) length.truth = truth->second;
    summary.parameters.push_back(std::move(length));
  }
  return summary;
}

TaskSummary summary_of(const Verification& verification) {
  const bool is_valid = verification.result == VerificationResult::valid;
  return {.verb = "verify",
          .usability = is_valid ? Usability::use : Usability::do_not_use,
          .reason = std::string(name(verification.result)),
          .figures = {{"rms_m", verification.unmodified.rms},
                      {"max_m", verification.unmodified.max},
                      {"rms_frames_refitted_m", verification.frames_refitted.rms},
                      {"poses", static_cast<double>(verification.unmodified.n)}}};
}

}  // namespace kinfer::fleet

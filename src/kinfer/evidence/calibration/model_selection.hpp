// SPDX-License-Identifier: Apache-2.0
// Model selection: which non-geometric terms reduced the held-out errors.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/evidence/calibration/fit_errors.hpp"

namespace kinfer {

/// A non-geometric model term: a group of parameters that are accepted or rejected together.
enum class Term {
  gain,                ///< of each encoder
  coupling,            ///< of a joint to those before it
  gravity_compliance,  ///< joint compliance under gravity
  torque_compliance,   ///< joint compliance under the measured torques
  gear_harmonics,      ///< once and twice per revolution
  spectral_harmonics,  ///< lines in the spectrum of the residuals
  backlash,
  thermal_expansion,
  displacement_field,  ///< of the tool, over all joint positions
};
inline constexpr int term_count = 9;

/// As of --model: "gains", "coupling", "gravity", "torques", "gear", "spectrum", "backlash", "temperature", "field"
std::string_view name(Term term);
std::optional<Term> term_named(std::string_view name);
std::vector<std::string> term_names();  ///< of all terms

enum class Decision {
  start,                ///< the geometric model, which every selection starts from
  accepted,             ///< supported by the marginal likelihood, and no harm to held-out errors
  requested,            ///< part of a fixed model
  no_evidence,          ///< the marginal likelihood is not higher with it
  no_improvement,       ///< supported, but the mean held-out error is higher with it
  tail_rises,           ///< supported, but the 95 or 99 % point of the held-out errors is higher with it
  extrapolation_worse,  ///< supported, but the errors beyond the fitted poses are higher with it
  not_excited,          ///< not tested: the data determine none of its parameters
  data_missing,         ///< not tested: see MissingData
  superseded,           ///< not tested: series of harmonics hold the errors of the joints
};
std::string_view name(Decision decision);  ///< "start", "accepted", …

/// What a term needs and the data do not have.
enum class MissingData {
  none,
  gravity,            ///< gravity is zero in the robot file
  torques,            ///< no joint torques
  approach_order,     ///< the order in which the poses were approached is unknown
  temperature,        ///< no temperatures
  temperature_range,  ///< the temperature hardly changed
  spectral_line,      ///< no significant line in the residuals
  points,             ///< too few points of one tool
};
std::string_view name(MissingData missing);  ///< "none", "gravity", …

/// A point of the distribution of held-out errors for two models.
struct QuantileChange {
  double before = 0.0, after = 0.0;  ///< [m]
  double rise_probability = 0.0;     ///< that it is higher after, by the bootstrap; 0 where it is not higher
};

/// Paired comparison of the held-out errors of two models, without the rows that are outliers of both.
struct ErrorChange {
  double mean_before = 0.0, mean_after = 0.0;    ///< [m]
  double worst_before = 0.0, worst_after = 0.0;  ///< [m]
  double t = 0.0;                                ///< mean reduction of the error over its standard error
  QuantileChange p95{}, p99{};
};

/// One candidate. Its errors are those of the selected model with the terms up to this one; interpolation and
/// extrapolation compare the selected model without and with it.
struct SelectionStep {
  std::optional<Term> term{};  ///< none: the geometric model
  Decision decision = Decision::start;
  MissingData missing = MissingData::none;
  ErrorChange interpolation{};         ///< by random folds
  ErrorChange extrapolation{};         ///< by splits along the joint positions; zero where it was not tested
  ErrorStatistics train{}, holdout{};  ///< [m] by cross-validation over the fitted rows; n = 0 where it is not selected
  double log_evidence_gain = 0.0;      ///< log marginal likelihood of the data with all selected terms minus without it
  double contribution = 0.0;           ///< [m] rms over the poses of what it moves the tool by
  int parameter_count = 0,
      determined_count = 0;  ///< number of parameters it adds, and how many of them the data determine
  std::vector<std::string> undetermined_parameters{};  ///< its parameters that the data do not determine
  bool masses_approximate = false;                     ///< gravity: the robot file has no masses
};

/// "geometry", or the name of the term
std::string_view name(const SelectionStep& step);
bool is_selected(const SelectionStep& step);  ///< part of the selected model
bool was_tested(const SelectionStep& step);

struct ModelSelection {
  std::vector<SelectionStep> steps{};
};

std::vector<Term> selected_terms(const ModelSelection& selection);
/// "geometry", "geometry + gravity"; empty without steps
std::string selected_model(const ModelSelection& selection);

}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/toml/prediction_toml.hpp"
#include "kinfer/io/text/quoted_text.hpp"

#include <fmt/format.h>

namespace kinfer {
namespace {

using Eigen::Index;

/// Seven digits: far more than a standard deviation is known to.
template <class Numbers>
std::string prediction_numbers(const Numbers& numbers) {
  std::string text;
  for (Index i = 0; i < numbers.size(); ++i) text += fmt::format("{}{:.7g}", i == 0 ? "" : ", ", numbers[i]);
  return "[" + text + "]";
}

std::vector<std::string> prediction_texts(TableReader& reader, const TomlTable& table, std::string_view key) {
  reader.ignore(key);
  std::vector<std::string> texts;
  const TomlValue* value = table.find(key);
  const auto* list = value ? std::get_if<TomlArray>(&value->value) : nullptr;
  for (std::size_t i = 0; list && i < list->size(); ++i)
    if (const auto* text = std::get_if<std::string>(&(*list)[i].value)) texts.push_back(*text);
  if (!list || texts.size() != list->size())
    reader.report_error(reader.line_of(key), fmt::format("\"{}\": expected a list of names", key));
  return texts;
}

/// The columns of a matrix, one list after the other.
MatrixXd reshaped_numbers(TableReader& reader, std::string_view key, Index rows) {
  const std::vector<double> numbers = reader.number_list(key);
  const auto count = static_cast<Index>(numbers.size());
  if (rows <= 0 || count % rows != 0) {
    reader.report_error(reader.line_of(key), fmt::format("\"{}\": expected a multiple of {} numbers", key, rows));
    return MatrixXd(std::max<Index>(rows, 0), 0);
  }
  return Eigen::Map<const MatrixXd>(numbers.data(), rows, count / rows);
}

/// Of position and rotation, 6 x 6.
void read_covariance(TableReader& reader, const char* key, MatrixXd& covariance) {
  const std::vector<double> numbers = reader.numbers(key, 36);
  if (numbers.size() == 36) covariance = Eigen::Map<const MatrixXd>(numbers.data(), 6, 6);
}

/// Older files have a model error that grew with the squared distance, by a rate or a covariance: what it was at twice
/// the reach.
void read_outside_error(TableReader& reader, const TomlTable& table, PredictionModel& model) {
  constexpr double squared_distance = 4.0;
  if (table.find("rate")) {
    model.outside_error = squared_distance * reader.number_or("rate", 0.0) * model.model_error;
  } else if (table.find("growth")) {
    read_covariance(reader, "growth", model.outside_error);
    model.outside_error *= squared_distance;
  } else {
    read_covariance(reader, "outside_error", model.outside_error);
  }
}

}  // namespace

std::string format_prediction_toml(const PredictionModel& model) {
  std::string names, root;
  for (const std::string& parameter : model.parameters)
    names += fmt::format("{}{}", names.empty() ? "" : ", ", quoted_text(parameter));
  for (Index i = 0; i < model.root.rows(); ++i)
    root += fmt::format("{}  {}", i == 0 ? "" : ",\n", [&] {
      const std::string row = prediction_numbers(VectorXd(model.root.row(i).head(i + 1).transpose()));
      return row.substr(1, row.size() - 2);
    }());
  const std::string beyond =
      model.beyond.size() > 0 ? "beyond = " + prediction_numbers(model.beyond) + "\n" : std::string();
  const std::string noise = model.noise > 0.0 ? fmt::format("noise = {:.7g}\n", model.noise) : std::string();
  return fmt::format(
      "\n[prediction]\nparameters = [{}]\ncovariance_root = [\n{}\n]\nmodel_error = {}\noutside_error = {}\nspread = "
      "{}\nreach = {:.7g}\nedge = {:.7g}\n"
      "{}{}rows = {}\n",
      names, root, prediction_numbers(VectorXd(model.model_error.reshaped())),
      prediction_numbers(VectorXd(model.outside_error.reshaped())), prediction_numbers(model.spread), model.reach,
      model.edge, noise, beyond, prediction_numbers(VectorXd(model.rows.reshaped())));
}

std::optional<PredictionModel> read_prediction(TableReader& file, int dof, FirstError& first_error) {
  const TomlTable* table = file.table_or_none("prediction");
  if (!table) return std::nullopt;
  TableReader reader(*table, file.line_of("prediction"), "prediction: ", first_error);
  PredictionModel model;
  model.parameters = prediction_texts(reader, *table, "parameters");
  const auto count = static_cast<Index>(model.parameters.size());
  const std::vector<double> root = reader.numbers("covariance_root", static_cast<std::size_t>(count * (count + 1) / 2));
  model.root = MatrixXd::Zero(count, count);
  std::size_t next = 0;
  for (Index i = 0; i < count; ++i)
    for (Index j = 0; j <= i && next < root.size(); ++j) model.root(i, j) = root[next++];
  read_covariance(reader, "model_error", model.model_error);
  read_outside_error(reader, *table, model);
  const std::vector<double> spread = reader.numbers("spread", static_cast<std::size_t>(dof));
  model.spread = VectorXd::Ones(dof);
  if (static_cast<int>(spread.size()) == dof) model.spread = Eigen::Map<const VectorXd>(spread.data(), dof);
  model.reach = reader.positive_or("reach", 1.0);
  model.edge = reader.positive_or("edge", 1.0);
  if (table->find("noise")) model.noise = reader.positive_or("noise", 0.0);
  if (table->find("beyond")) {
    const std::vector<double> beyond = reader.numbers("beyond", static_cast<std::size_t>(count));
    if (static_cast<Index>(beyond.size()) == count) model.beyond = Eigen::Map<const VectorXd>(beyond.data(), count);
  }
  model.rows = reshaped_numbers(reader, "rows", dof);
  reader.expect_no_other_keys();
  return model;
}

}  // namespace kinfer

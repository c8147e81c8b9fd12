// SPDX-License-Identifier: Apache-2.0
// A network as text: a title with the three sizes, then one line for each bound and weight array, column-major.
#include <charconv>
#include <cmath>
#include <cstdint>
#include <iterator>

#include "kinfer/search/swarm/mlp.hpp"

namespace kinfer {
namespace {

constexpr std::string_view title = "kinfer-net/1";

template <class Net, class Visitor>
void for_each_line(Net& net, Visitor visit) {
  visit("input_lower", net.input_box.lower);
  visit("input_upper", net.input_box.upper);
  visit("output_lower", net.output_box.lower);
  visit("output_upper", net.output_box.upper);
  visit("hidden_weights", net.hidden_weights);
  visit("hidden_thresholds", net.hidden_thresholds);
  visit("output_weights", net.output_weights);
  visit("output_thresholds", net.output_thresholds);
}

/// Words separated by blanks or ends of lines.
class TokenReader {
 public:
  explicit TokenReader(std::string_view text) : rest_(text) {}

  std::string_view next() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \r\n"), rest_.size()));
    const std::string_view word = rest_.substr(0, rest_.find_first_of(" \r\n"));
    rest_.remove_prefix(word.size());
    return word;
  }

  template <class Number>
  bool next(Number& value) {
    const std::string_view word = next();
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    return code == std::errc{} && end == word.data() + word.size() && std::isfinite(static_cast<double>(value));
  }

 private:
  std::string_view rest_;
};

}  // namespace

std::string format_mlp(const Mlp& net) {
  std::string text =
      fmt::format("{} {} {} {}\n", title, net.hidden_weights.cols(), net.hidden_nodes(), net.output_thresholds.size());
  for_each_line(net, [&](std::string_view name, const auto& array) {
    text += name;
    for (const double value : array.reshaped()) fmt::format_to(std::back_inserter(text), " {}", value);
    text += '\n';
  });
  return text;
}

Result<Mlp> parse_mlp(std::string_view text, const std::string& name_in_messages) {
  TokenReader tokens(text);
  int inputs = 0, hidden = 0, outputs = 0;
  constexpr int largest = 100000;
  const bool has_header = tokens.next() == title && tokens.next(inputs) && tokens.next(hidden) && tokens.next(outputs);
  if (!has_header || std::min({inputs, hidden, outputs}) < 1 || std::max({inputs, hidden, outputs}) > largest)
    return error("{}: expected a network file written by kinfer: \"{}\" and three sizes", name_in_messages, title);
  // Each number takes a blank and a digit: a damaged header does not allocate more than the file could fill.
  const std::int64_t numbers = std::int64_t{hidden} * (inputs + outputs + 1) + 3 * std::int64_t{outputs} + 2 * inputs;
  if (2 * numbers > std::ssize(text))
    return error("{}: the header states {} inputs, {} hidden nodes and {} outputs, for which the file is too short",
                 name_in_messages, inputs, hidden, outputs);
  Mlp net{{VectorXd(inputs), VectorXd(inputs)},
          {VectorXd(outputs), VectorXd(outputs)},
          MatrixXd(hidden, inputs),
          VectorXd(hidden),
          MatrixXd(outputs, hidden),
          VectorXd(outputs)};
  std::string damaged;
  for_each_line(net, [&](std::string_view name, auto& array) {
    if (!damaged.empty()) return;
    bool good = tokens.next() == name;
    for (double& value : array.reshaped()) good = good && tokens.next(value);
    if (!good) damaged = name;
  });
  if (!damaged.empty()) return error("{}: expected the numbers of {}", name_in_messages, damaged);
  return net;
}

}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/poses/instruments/residual_kind.hpp"

#include <algorithm>

namespace kinfer {
namespace {

template <class M>
void keep_entries(PoseMeasurements& measured, const std::vector<bool>& kept) {
  std::vector<M>& list = list_of<M>(measured);
  std::size_t to = 0;
  for (std::size_t from = 0; from < list.size(); ++from)
    if (kept[from]) list[to++] = list[from];
  list.resize(to);
}

int axis_of(Field field) {
  return static_cast<int>(field) - static_cast<int>(Field::x);
}

/// Place of a parameter among the numbers of its fixture.
std::ptrdiff_t number_in_fixture(const Fixtures& fixtures, const FixtureNumber& at) {
  std::ptrdiff_t place = 0;
  for_each_fixture_list(fixtures, [&](const auto& row, const auto& list) {
    if (fixture_kind(row.kind) != at.kind) return;
    const std::span<const Field> fields = fields_of(list[at.index]);
    place = std::find(fields.begin(), fields.end(), at.field) - fields.begin();
  });
  return place;
}

template <class M>
ResidualKind make_kind() {
  return {.kind = kind_of<M>,
          .traits = M::traits,
          .model = residual_model<M>(),
          .size = M::traits.rows,
          .count = [](const PoseMeasurements& measured) { return list_of<M>(measured).size(); },
          .row = [](const PoseMeasurements& measured, std::size_t i) { return list_of<M>(measured)[i].row; },
          .keep = keep_entries<M>};
}

}  // namespace

std::span<const ResidualKind> residual_kinds() {
  static const auto kinds =
      std::apply([]<class... M>(std::vector<M> PoseMeasurements::*...) { return std::array{make_kind<M>()...}; },
                 measurement_lists);
  return kinds;
}

const ResidualKind& residual_kind(MeasurementKind kind) {
  return residual_kinds()[index(kind)];
}

FixtureColumns fixture_columns(const Chain& chain, const ParameterSet& set) {
  constexpr FixtureColumns::Xyz none{-1, -1, -1};
  FixtureColumns columns;
  columns.target.assign(chain.targets.size(), none);
  for_each_fixture_list(chain.fixtures, [&](const auto& row, const auto& list) {
    columns.fixture[index(fixture_kind(row.kind))].assign(list.size(), {-1, -1, -1, -1, -1, -1});
  });
  Eigen::Index column = 0;
  for (const Parameter* parameter : set.free()) {
    const ParameterAddress& at = parameter->at;
    if (const auto* target = std::get_if<TargetNumber>(&at))
      columns.target[target->target][axis_of(target->field)] = column;
    if (const auto* gravity = std::get_if<GravityNumber>(&at)) columns.gravity[axis_of(gravity->field)] = column;
    if (const auto* fixture = std::get_if<FixtureNumber>(&at))
      columns.fixture[index(fixture->kind)][fixture->index][number_in_fixture(chain.fixtures, *fixture)] = column;
    if (const auto* frame = std::get_if<FrameNumber>(&at); frame && frame->frame == SetupFrame::base)
      columns.base.push_back(column);
    ++column;
  }
  return columns;
}

}  // namespace kinfer

// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/measurements.hpp"

#include <algorithm>
#include <array>

namespace kinfer {
namespace {

constexpr std::array all_traits = std::apply(
    []<class... M>(std::vector<M> PoseMeasurements::*...) { return std::array{M::traits...}; }, measurement_lists);

}  // namespace

const MeasurementTraits& traits_of(MeasurementKind kind) {
  return all_traits[index(kind)];
}

std::string_view name(MeasurementKind kind) {
  return traits_of(kind).name;
}

std::optional<MeasurementKind> measurement_kind(std::string_view name) {
  const auto* const at = std::ranges::find(all_traits, name, &MeasurementTraits::name);
  if (at == all_traits.end()) return std::nullopt;
  return static_cast<MeasurementKind>(at - all_traits.begin());
}

std::vector<std::string>* find_fixture_names(FixtureNames& names, std::string_view kind) {
  for (const FixtureNameList& list : fixture_name_lists)
    if (list.kind == kind) return &(names.*list.names);
  return nullptr;
}

const std::vector<std::string>* find_fixture_names(const FixtureNames& names, std::string_view kind) {
  return find_fixture_names(const_cast<FixtureNames&>(names), kind);
}

double position_sd(const Instrument& instrument, const Vec3& position) {
  return instrument.sigma + 1e-6 * instrument.ppm * position.norm();
}

}  // namespace kinfer
